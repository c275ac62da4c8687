//! Speeds that were observed: at an instant of a log, or over a window of sound.

use super::prediction::SpeedPrediction;
use nalgebra::{Matrix4, Vector4};
use std::f64::consts::{PI, TAU};

/// The speeds of the rotors over a window.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedObservation {
    /// Middle of the window.
    pub time_s: f64,
    /// Length of the window; 0 for an instant. A window of sound is one of Hann.
    pub window_s: f64,
    /// Speed of each rotor, rad/s.
    pub speed_rad_s: Vector4<f64>,
    /// Information about the speeds, s²/rad²: the inverse of their covariance. It is singular where rotors cannot be separated.
    pub information: Matrix4<f64>,
    /// By how much the speeds would move if the amplitudes of lines that overlap were independent from window to window, rad/s; 0 without sound.
    pub overlap_rad_s: Vector4<f64>,
}

/// Observations of logged speeds: `speed_rad_s[rotor][row]`, each with this standard uncertainty. Rows with a gap are left out.
pub fn observations_of_rows(time_s: &[f64], speed_rad_s: [&[f64]; 4], std_rad_s: f64) -> Vec<SpeedObservation> {
    let observation = |row: usize| SpeedObservation {
        time_s: time_s[row],
        window_s: 0.0,
        speed_rad_s: Vector4::from_fn(|rotor, _| speed_rad_s[rotor][row]),
        information: Matrix4::identity() / (std_rad_s * std_rad_s),
        overlap_rad_s: Vector4::zeros(),
    };
    let is_finite = |row: &usize| speed_rad_s.iter().all(|speeds| speeds[*row].is_finite());
    (0..time_s.len()).filter(is_finite).map(observation).collect()
}

impl SpeedObservation {
    /// The same quantity of the prediction: the slope of the angle that least squares finds under the window.
    pub fn of_prediction(&self, prediction: &SpeedPrediction) -> Vector4<f64> {
        if self.window_s <= 0.0 {
            return Vector4::from(prediction.at(self.time_s));
        }
        let half_s = self.window_s / 2.0;
        let points = (self.window_s / prediction.step_s).ceil().max(2.0) as usize;
        let (mut sum, mut weights) = (Vector4::zeros(), 0.0);
        for point in 0..points {
            let place = (2.0 * point as f64 + 1.0) / points as f64 - 1.0;
            let weight = slope_weight(place);
            sum += weight * Vector4::from(prediction.at(self.time_s + place * half_s));
            weights += weight;
        }
        sum / weights
    }
}

/// Weight of the speed at a place, −1 to 1, in the slope of the angle under a Hann window: `∫ₓ¹ s (1 + cos πs)/2 ds`.
fn slope_weight(place: f64) -> f64 {
    let rest = place * (PI * place).sin() / TAU + (PI * place).cos() / (2.0 * PI * PI);
    0.25 - 1.0 / (2.0 * PI * PI) - place * place / 4.0 - rest
}
