//! How far the observed speeds are from the model, and how much of that the model cannot explain.
//!
//! The difference of one observation has two parts: the error of the observation, whose information is known, and the wander of the rotors about the
//! model (turbulence, motors, motion to the microphone). Wander is taken as independent in the four columns of the mixer, because what disturbs the
//! common speed (distance to the microphone, battery) does not disturb the differences. Its four variances are found by expectation and
//! maximisation (Dempster, Laird, Rubin 1977).

use super::observation::SpeedObservation;
use nalgebra::{Matrix4, SymmetricEigen, Vector4};

/// Rounds of expectation and maximisation for each fit. *Numeric.*
const ROUNDS: usize = 8;
/// Smallest standard deviation of the wander as a share of the speed. *Numeric*: no rotor is steadier.
const WANDER_SHARE_MIN: f64 = 1e-5;
/// Distance from the model, in standard deviations of all four speeds together, from which an observation loses weight (Huber 1964). *Decision.*
const HUBER: f64 = 4.0;

/// Variances of the wander in the columns of the mixer, rad²/s².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wander {
    /// The columns of the mixer with length 1.
    modes: Matrix4<f64>,
    variances: Vector4<f64>,
}

impl Wander {
    /// Of this share of the speed in all columns.
    pub(super) fn of_share(mixer: &[[f64; 4]; 4], share: f64, speed_rad_s: f64) -> Self {
        let mut modes = Matrix4::from_fn(|rotor, axis| mixer[rotor][axis]);
        for mut column in modes.column_iter_mut() {
            column.normalize_mut();
        }
        Self { modes, variances: Vector4::repeat((share * speed_rad_s).powi(2)) }
    }

    /// The same with the variances that the differences from the model show.
    pub(super) fn updated(&self, observations: &[SpeedObservation], differences: &[Vector4<f64>], speed: f64) -> Self {
        let mut wander = *self;
        let floor = (WANDER_SHARE_MIN * speed).powi(2);
        for _ in 0..ROUNDS {
            let (mut sums, mut count) = (Vector4::zeros(), 0.0);
            let precision =
                wander.modes * Matrix4::from_diagonal(&wander.variances.map(f64::recip)) * wander.modes.transpose();
            for (observation, difference) in observations.iter().zip(differences) {
                let Some(covariance) = (observation.information + precision).try_inverse() else { continue };
                let weight = self.huber_weight(observation, difference);
                let mean = covariance * (observation.information * difference);
                let second = wander.modes.transpose() * (covariance + mean * mean.transpose()) * wander.modes;
                sums += weight * second.diagonal();
                count += weight;
            }
            if count > 0.0 {
                wander.variances = (sums / count).map(|variance| variance.max(floor));
            }
        }
        wander
    }

    /// Information of an observation about the speeds of the model: the inverse of its covariance and that of the wander together.
    pub(super) fn information(&self, observation: &SpeedObservation) -> Matrix4<f64> {
        let covariance = self.modes * Matrix4::from_diagonal(&self.variances) * self.modes.transpose();
        let information = &observation.information;
        match (Matrix4::identity() + covariance * information).try_inverse() {
            Some(inverse) => {
                let shared = information * inverse;
                (shared + shared.transpose()) / 2.0
            }
            None => Matrix4::zeros(),
        }
    }

    /// 1 near the model, less far from it.
    pub(super) fn huber_weight(&self, observation: &SpeedObservation, difference: &Vector4<f64>) -> f64 {
        let distance = (difference.transpose() * self.information(observation) * difference)[(0, 0)].max(0.0).sqrt();
        if distance > HUBER { HUBER / distance } else { 1.0 }
    }

    /// Standard deviation of the wander of a rotor.
    pub(super) fn std_rad_s(&self) -> f64 {
        (self.variances.sum() / 4.0).sqrt()
    }

    /// Precision of the wander, s²/rad².
    pub(super) fn precision(&self) -> Matrix4<f64> {
        self.modes * Matrix4::from_diagonal(&self.variances.map(f64::recip)) * self.modes.transpose()
    }
}

/// The symmetric square root of a matrix without negative eigenvalues.
pub(super) fn square_root(matrix: &Matrix4<f64>) -> Matrix4<f64> {
    let eigen = SymmetricEigen::new(*matrix);
    let roots = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    eigen.eigenvectors * Matrix4::from_diagonal(&roots) * eigen.eigenvectors.transpose()
}
