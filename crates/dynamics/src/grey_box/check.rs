//! Predicted against observed speeds, on a flight that was not used for the fit.

use super::observation::SpeedObservation;
use super::prediction::SpeedPrediction;
use nalgebra::Matrix4;

/// Largest standard uncertainty of an observed speed, as a share, that is compared: of rotors that cannot be separated nothing is known. *Decision.*
const STD_SHARE_MAX: f64 = 2e-3;

/// How far the predicted speeds are from the observed ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checked {
    /// Rms difference over the speed.
    pub rms_share: f64,
    /// Rms of the observed speeds about their means over the speed: what a model that predicts nothing would give.
    pub change_share: f64,
    /// Share of the observed speeds that were certain enough to compare.
    pub compared_share: f64,
    /// Number of speeds that were compared.
    pub compared: usize,
}

/// Compares; `None` where no speed is certain enough.
pub fn checked(observations: &[SpeedObservation], prediction: &SpeedPrediction) -> Option<Checked> {
    let (mut differences, mut speeds) = (Vec::new(), [Vec::new(), Vec::new(), Vec::new(), Vec::new()]);
    for observation in observations {
        let ridge = Matrix4::from_diagonal_element(1e-9 * observation.information.trace() + f64::MIN_POSITIVE);
        let Some(covariance) = (observation.information + ridge).try_inverse() else { continue };
        let predicted = observation.of_prediction(prediction);
        for rotor in 0..4 {
            let (speed, variance) = (observation.speed_rad_s[rotor], covariance[(rotor, rotor)]);
            if variance >= 0.0 && variance.sqrt() < STD_SHARE_MAX * predicted[rotor] {
                differences.push((speed - predicted[rotor]) / predicted[rotor]);
                speeds[rotor].push(speed);
            }
        }
    }
    let compared = differences.len();
    if compared == 0 {
        return None;
    }
    let change = |speeds: &Vec<f64>| {
        let mean = speeds.iter().sum::<f64>() / speeds.len().max(1) as f64;
        speeds.iter().map(|speed| (speed / mean - 1.0).powi(2)).sum::<f64>()
    };
    let rms = |squares: f64| (squares / compared as f64).sqrt();
    Some(Checked {
        rms_share: rms(differences.iter().map(|difference| difference * difference).sum()),
        change_share: rms(speeds.iter().map(change).sum()),
        compared_share: compared as f64 / (4 * observations.len()) as f64,
        compared,
    })
}
