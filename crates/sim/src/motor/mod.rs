//! Second subsystem, eq 2: from voltage to rotor speed.
//!
//! A DC motor (the paper's model of the brushless one) drives a rotor through a gear of ratio r, ω_m = r ω. For the
//! rotor's speed, with k = k_m = k_b (in SI units) and the load τ_l = C_τ ω² (eq 4) at the rotor:
//!
//! ```text
//! c ω' + a ω + b ω² = g v,   a = r (R B/k + k),   b = R C_τ/(r k),   c = r R J/k
//! ```
//!
//! a Riccati equation with constant coefficients; [`Motor::speed_after`] solves it exactly. g is 1, or a motor's own gain
//! when motors differ. The rotor's speed is relative to the body; the rates of the body are neglected.

use hovertone_vehicle::MotorParameters;

/// A motor, its gear and the load of its rotor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// a, V s/rad.
    pub linear_v_s_rad: f64,
    /// b, V s²/rad².
    pub load_v_s2_rad2: f64,
    /// c, V s²/rad.
    pub inertia_v_s2_rad: f64,
    /// g.
    pub gain: f64,
    /// r k, back-EMF per rotor speed.
    back_emf_v_s_rad: f64,
    resistance_ohm: f64,
}

/// A linear first-order response to a small step of the voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstOrder {
    /// Time to 63 % of the step.
    pub time_constant_s: f64,
    /// Speed per voltage, (rad/s)/V.
    pub gain_rad_s_v: f64,
}

impl Motor {
    /// The motor with a rotor of this C_τ in N m s², and a gain g.
    pub fn new(parameters: &MotorParameters, torque_constant_n_m_s2: f64, gain: f64) -> Self {
        let (r, k) = (parameters.gear_ratio.value, parameters.constant_v_s_rad.value);
        let resistance_ohm = parameters.resistance_ohm.value;
        Self {
            linear_v_s_rad: r * (resistance_ohm * parameters.viscous_n_m_s.value / k + k),
            load_v_s2_rad2: resistance_ohm * torque_constant_n_m_s2 / (r * k),
            inertia_v_s2_rad: r * resistance_ohm * parameters.inertia_kg_m2.value / k,
            gain,
            back_emf_v_s_rad: r * k,
            resistance_ohm,
        }
    }

    /// ω' in rad/s² at a speed in rad/s, 0 or above, and a voltage.
    pub fn acceleration_rad_s2(&self, speed_rad_s: f64, voltage_v: f64) -> f64 {
        let drop_v = (self.linear_v_s_rad + self.load_v_s2_rad2 * speed_rad_s) * speed_rad_s;
        (self.gain * voltage_v - drop_v) / self.inertia_v_s2_rad
    }

    /// The voltage that holds a speed.
    pub fn steady_voltage_v(&self, speed_rad_s: f64) -> f64 {
        (self.linear_v_s_rad + self.load_v_s2_rad2 * speed_rad_s) * speed_rad_s / self.gain
    }

    /// The final speed at a constant voltage.
    pub fn steady_speed_rad_s(&self, voltage_v: f64) -> f64 {
        let volts = self.gain * voltage_v;
        2.0 * volts / (self.linear_v_s_rad + self.discriminant_v_s_rad(volts))
    }

    /// Exact solution of eq 2 at constant voltage: the speed `time_s` after the speed was `start_rad_s`.
    ///
    /// With ω₊ and ω₋ the roots of b ω² + a ω = g v and D = √(a² + 4 b g v), (ω - ω₊)/(ω - ω₋) falls as exp(-D t/c). This is
    /// the tanh solution of the Riccati equation for a start below the final speed, the coth solution above it, and the
    /// exponential for b = 0.
    pub fn speed_after(&self, start_rad_s: f64, voltage_v: f64, time_s: f64) -> f64 {
        let d = self.discriminant_v_s_rad(self.gain * voltage_v);
        let end_rad_s = self.steady_speed_rad_s(voltage_v);
        let fall = (-d * time_s / self.inertia_v_s2_rad).exp();
        // ω₋ = -(a + D)/2b is written with b in the numerator, so that b = 0 is no special case.
        let other = 0.5 * (self.linear_v_s_rad + d);
        let share = (start_rad_s - end_rad_s) / (self.load_v_s2_rad2 * start_rad_s + other) * fall;
        (end_rad_s + other * share) / (1.0 - self.load_v_s2_rad2 * share)
    }

    /// The response to small steps about a speed: time constant c/(a + 2 b ω), gain g/(a + 2 b ω).
    pub fn linearised(&self, speed_rad_s: f64) -> FirstOrder {
        let slope = self.linear_v_s_rad + 2.0 * self.load_v_s2_rad2 * speed_rad_s;
        FirstOrder { time_constant_s: self.inertia_v_s2_rad / slope, gain_rad_s_v: self.gain / slope }
    }

    /// Current through the winding, A: (g v - k r ω)/R.
    pub fn current_a(&self, speed_rad_s: f64, voltage_v: f64) -> f64 {
        (self.gain * voltage_v - self.back_emf_v_s_rad * speed_rad_s) / self.resistance_ohm
    }

    /// r k ω, V.
    pub fn back_emf_v(&self, speed_rad_s: f64) -> f64 {
        self.back_emf_v_s_rad * speed_rad_s
    }

    fn discriminant_v_s_rad(&self, volts: f64) -> f64 {
        (self.linear_v_s_rad.powi(2) + 4.0 * self.load_v_s2_rad2 * volts).sqrt()
    }
}

#[cfg(test)]
mod tests;
