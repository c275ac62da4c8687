//! All settings of the chain.

/// Settings of [`crate::motor_from_series`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorConfig {
    /// Longest interval between rows that can show a time constant. *Physics*: motors of multirotors reach 95 % within 0.3 s, and three rows must
    /// lie in that.
    pub interval_s_max: f64,
    /// Fewest rows within the rise to 95 %, which takes 3 τ. *Numeric*: a curve with start and τ needs three.
    pub rise_rows_min: f64,
    /// Shortest time for which a level must be held on both sides of a step. *Decision.*
    pub hold_s_min: f64,
    /// Longest dead time between a command and its effect. *Physics*: filters and ESCs delay by less than 0.1 s.
    pub dead_time_s_max: f64,
    /// Smallest step as a share of the largest speed. *Decision*: smaller ones are wander.
    pub step_share_min: f64,
    /// Smallest change of the speed within `change_s`, as a share of the largest speed, that belongs to a step. *Decision*: plateaus
    /// wander by less.
    pub change_share_min: f64,
    /// Smallest step over the scatter of the rows. *Numeric.*
    pub step_over_scatter_min: f64,
    /// Half of the width of the windows in which a change of the speed is sought. *Physics*: the time constant of a fast motor.
    pub change_s: f64,
    /// Length of the fitted window on both sides of the start, in time constants. *Numeric*: e⁻¹⁰ of the step is left.
    pub window_time_constants: f64,
    /// Length of the first window, while no time constant is known. *Physics*: ten times a slow one.
    pub window_s_first: f64,
    /// Largest rms of the residuals as a share of the step. *Decision*: what differs more is no curve of first order.
    pub residual_share_max: f64,
    /// A plateau is saturated where the gain from the one below is less than this share of the gain before. *Decision*: maps of ESCs bend by less.
    pub saturated_gain_share: f64,
    /// Smallest correlation of commands and speeds in flight that makes a static map. *Decision.*
    pub correlation_min: f64,
    /// Length of the Hann frames of sound in which the speeds were measured, along a path near the true one; 0 for speeds of an instant, as in
    /// logs. *Physics.*
    pub frame_s: f64,
}

impl Default for MotorConfig {
    fn default() -> Self {
        Self {
            interval_s_max: 0.1,
            rise_rows_min: 3.0,
            hold_s_min: 0.15,
            dead_time_s_max: 0.3,
            step_share_min: 0.04,
            change_share_min: 0.015,
            step_over_scatter_min: 8.0,
            change_s: 0.04,
            window_time_constants: 10.0,
            window_s_first: 1.5,
            residual_share_max: 0.05,
            saturated_gain_share: 0.6,
            correlation_min: 0.7,
            frame_s: 0.0,
        }
    }
}
