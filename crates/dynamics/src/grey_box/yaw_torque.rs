//! C_τ from yaw: the load torques of the rotors turn the body.
//!
//! ```text
//! I_zz r' = −Σ sᵢ (C_τ ωᵢ² + h ωᵢ')
//! ```
//!
//! with the yaw rate r, the direction of rotation sᵢ of each rotor and its angular momentum h per rad/s. Over windows of half a second
//! this is a linear regression for C_τ/I_zz: differences of the yaw rate on integrals of the speeds of the model. A constant torque is free.

use super::fit::GreyBoxFit;
use super::inputs::{ControlLog, LoopInputs};
use hovertone_signal::statistics::{mean, std_uncertainty_of_mean};
use hovertone_vehicle::{Ending, Estimate, FlightParameters};
use nalgebra::{Matrix2, Vector2};

/// Length of a window, s: longer than a motor's response, shorter than a turn. *Numeric.*
const WINDOW_S: f64 = 0.3;
/// Fewest windows. *Numeric.*
const WINDOWS_MIN: usize = 20;
/// Largest standard uncertainty, as a share of C_τ, that tells it. *Decision.*
const STD_SHARE_MAX: f64 = 0.1;

/// What is known of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct YawInertia {
    /// I_zz.
    pub inertia_zz_kg_m2: f64,
    /// Angular momentum of rotor and armature per rad/s of the rotor, kg m².
    pub momentum_kg_m2: f64,
    /// Direction of rotation of each rotor seen from above, +1 counter-clockwise.
    pub spins: [f64; 4],
}

impl YawInertia {
    /// By the numbers of a vehicle. A pair of gears turns the armature against the rotor, r times as fast.
    pub fn of(vehicle: &FlightParameters) -> Self {
        let motor = &vehicle.motor;
        let (r, rotor) = (motor.gear_ratio.value, motor.rotor_inertia_kg_m2.value);
        let armature = (motor.inertia_kg_m2.value - rotor / (r * r)).max(0.0);
        let direction = if r == 1.0 { 1.0 } else { -1.0 };
        Self {
            inertia_zz_kg_m2: vehicle.inertia_kg_m2.value[2],
            momentum_kg_m2: rotor + direction * r * armature,
            spins: vehicle.layout.value.spins(),
        }
    }
}

/// C_τ, or why it is not told.
#[derive(Clone, Debug, PartialEq)]
pub enum TorqueConstant {
    /// C_τ of one rotor, N m s², if I_zz is right: it has the relative error of I_zz besides.
    Told(Estimate),
    /// The log has no yaw rate.
    NoYawRate,
    /// The yaw rate hardly changes, or not by the rotors.
    NoManoeuvre {
        /// Standard uncertainty over the value that would result.
        std_share: f64,
    },
}

impl TorqueConstant {
    /// Why it is not told, and the manoeuvre that would tell it.
    pub fn reason(&self) -> Option<String> {
        match self {
            Self::Told(_) => None,
            Self::NoYawRate => Some("the log has no yaw rate".to_owned()),
            Self::NoManoeuvre { std_share } => Some(format!(
                "the yaw manoeuvres are too small: the standard uncertainty of C_τ would be {:.0} %; fly yaw doublets (stick \
                one way, then the other) of 0.5 s or longer",
                (100.0 * std_share).min(999.0)
            )),
        }
    }
}

/// C_τ from the yaw rate of the log and the speeds of the fitted model.
pub fn torque_constant(log: &ControlLog, inputs: &LoopInputs, fit: &GreyBoxFit, body: &YawInertia) -> TorqueConstant {
    let Some(yaw_rate) = &log.measured[2] else { return TorqueConstant::NoYawRate };
    let windows = windows_of(&log.time_s, yaw_rate, inputs, fit, body);
    let no_manoeuvre = |std_share| TorqueConstant::NoManoeuvre { std_share };
    if windows.len() < WINDOWS_MIN {
        return no_manoeuvre(f64::INFINITY);
    }
    let information: Matrix2<f64> =
        windows.iter().map(|w| Vector2::new(w.torque, w.length_s)).map(|x| x * x.transpose()).sum();
    let products: Vector2<f64> = windows.iter().map(|w| Vector2::new(w.torque, w.length_s) * w.turned).sum();
    let Some(inverse) = information.try_inverse() else { return no_manoeuvre(f64::INFINITY) };
    let solution = inverse * products;
    let score = |w: &Window| {
        let residual = w.turned - solution[0] * w.torque - solution[1] * w.length_s;
        (inverse * Vector2::new(w.torque, w.length_s))[0] * residual
    };
    let scores: Vec<f64> = windows.iter().map(score).collect();
    // the sum of correlated scores from the uncertainty of their mean
    let independent =
        (mean(&scores.iter().map(|s| s * s).collect::<Vec<f64>>()).unwrap_or(0.0) * scores.len() as f64).sqrt();
    let correlated = std_uncertainty_of_mean(&scores).unwrap_or(0.0) * scores.len() as f64;
    let std_uncertainty = independent.max(correlated);
    let std_share = std_uncertainty / solution[0].abs();
    if solution[0] <= 0.0 || std_share.is_nan() || std_share > STD_SHARE_MAX {
        return no_manoeuvre(std_share);
    }
    let scale = body.inertia_zz_kg_m2;
    TorqueConstant::Told(Estimate {
        value: scale * solution[0],
        std_uncertainty: Some(scale * std_uncertainty),
        ending: Ending::Solved,
    })
}

/// One window of the regression.
struct Window {
    /// Change of the yaw rate that the load torques explain, rad/s.
    turned: f64,
    /// −∫ Σ sᵢ ωᵢ² dt, rad²/s.
    torque: f64,
    length_s: f64,
}

fn windows_of(
    time_s: &[f64],
    yaw_rate: &[f64],
    inputs: &LoopInputs,
    fit: &GreyBoxFit,
    body: &YawInertia,
) -> Vec<Window> {
    let prediction = fit.prediction(inputs);
    let rate_at = |at_s: f64| {
        let next = time_s.partition_point(|row_s| *row_s < at_s).clamp(1, time_s.len() - 1);
        let share = (at_s - time_s[next - 1]) / (time_s[next] - time_s[next - 1]);
        yaw_rate[next - 1] + share * (yaw_rate[next] - yaw_rate[next - 1])
    };
    let signed = |of: &dyn Fn(f64) -> f64, at_s: f64| {
        let speeds = prediction.at(at_s);
        (0..4).map(|rotor| body.spins[rotor] * of(speeds[rotor])).sum::<f64>()
    };
    let count = ((inputs.end_s() - inputs.start_s) / WINDOW_S) as usize;
    let points = (WINDOW_S / inputs.step_s).ceil() as usize;
    let window = |index: usize| {
        // the delay lies between the log row and the speed: the body turns at the time of the speed
        let from_s = inputs.start_s + index as f64 * WINDOW_S;
        let to_s = from_s + WINDOW_S;
        if !inputs.knows(from_s, to_s) {
            return None;
        }
        let step_s = WINDOW_S / points as f64;
        let torque =
            (0..points).map(|k| signed(&|speed| speed * speed, from_s + (k as f64 + 0.5) * step_s)).sum::<f64>();
        let momentum = signed(&|speed| speed, to_s) - signed(&|speed| speed, from_s);
        Some(Window {
            turned: rate_at(to_s) - rate_at(from_s) + body.momentum_kg_m2 / body.inertia_zz_kg_m2 * momentum,
            torque: -torque * step_s,
            length_s: WINDOW_S,
        })
    };
    (0..count).filter_map(window).collect()
}
