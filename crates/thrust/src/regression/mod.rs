//! Lines through points whose both coordinates are uncertain, and which of several laws the points speak for. Knows no
//! rotors: x, y and their standard uncertainties.
//!
//! York, Evensen, Martínez and De Basabe Delgado, "Unified equations for the slope, intercept, and standard errors of the
//! best straight line", American Journal of Physics 72, 367 (2004); the line through the origin is the same minimum,
//! Σ (y − b x)² / (u_y² + b² u_x²), without an intercept.

mod evidence;
mod line;
mod proportional;
#[cfg(test)]
mod tests;

pub use evidence::{ParameterPrior, log_evidence_ratio};
pub use line::{LineFit, line_fit};
pub use proportional::{ProportionalFit, proportional_fit};

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Iterations after which a slope that still moves is given up: sound data need five to ten.
const ITERATIONS_MAX: usize = 200;
/// Relative change of the slope that counts as none: a few roundings.
const SETTLED_SHARE: f64 = 4.0 * f64::EPSILON;
/// Relative change that is accepted after the last iteration, where roundings keep the slope trembling.
const TREMBLING_SHARE: f64 = 1e-10;

/// A point whose coordinates are uncertain, independently of each other and of the other points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitPoint {
    /// Abscissa.
    pub x: f64,
    /// Its standard uncertainty; 0 where it is exact.
    pub x_std: f64,
    /// Ordinate.
    pub y: f64,
    /// Its standard uncertainty; 0 where it is exact.
    pub y_std: f64,
}

impl FitPoint {
    /// A point of which only the ordinate is uncertain.
    pub fn with_y_std(x: f64, y: f64, y_std: f64) -> Self {
        Self { x, x_std: 0.0, y, y_std }
    }

    /// Weight of the residual y − b x: its inverse variance.
    fn weight(&self, slope: f64) -> f64 {
        1.0 / (self.y_std.powi(2) + (slope * self.x_std).powi(2))
    }

    fn is_usable(&self) -> bool {
        [self.x, self.x_std, self.y, self.y_std].iter().all(|number| number.is_finite())
            && self.x_std >= 0.0
            && self.y_std >= 0.0
            && (self.x_std > 0.0 || self.y_std > 0.0)
    }
}

/// Why there is no line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// Not enough points.
    #[error("{given} points, this law needs at least {needed}")]
    TooFewPoints {
        /// Points that were given.
        given: usize,
        /// Points that it takes.
        needed: usize,
    },
    /// A coordinate that is no number, or a point without any uncertainty among others.
    #[error("point number {number} has a coordinate that is no number, or no uncertainty at all")]
    UnusablePoint {
        /// Which, counted from 1.
        number: usize,
    },
    /// All points at the same place along x.
    #[error("all points have the same x: they leave the slope open")]
    NoSpread,
    /// The iteration did not settle.
    #[error("the points fit no line well enough for its slope to settle")]
    NotSettled,
}

/// How well points agree with a law: the sum of squared residuals in units of their uncertainties.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// Σ (y − law)² / u².
    pub chi_square: f64,
    /// Points less parameters.
    pub degrees_of_freedom: usize,
}

impl Agreement {
    /// Chance of a chi-square at least so large if law and uncertainties are right; `None` without degrees of freedom.
    pub fn p_value(&self) -> Option<f64> {
        let distribution = ChiSquared::new(self.degrees_of_freedom as f64).ok()?;
        Some(distribution.sf(self.chi_square))
    }

    /// Factor by which the stated uncertainties would have to grow for chi-square to be as expected (Birge's ratio); with
    /// uncertainties of 1 it is the standard deviation of the residuals.
    pub fn scatter_factor(&self) -> Option<f64> {
        (self.degrees_of_freedom > 0).then(|| (self.chi_square / self.degrees_of_freedom as f64).sqrt())
    }
}

fn check(points: &[FitPoint], needed: usize) -> Result<(), FitError> {
    if points.len() < needed {
        return Err(FitError::TooFewPoints { given: points.len(), needed });
    }
    match points.iter().position(|point| !point.is_usable()) {
        Some(index) => Err(FitError::UnusablePoint { number: index + 1 }),
        None => Ok(()),
    }
}

/// Repeats a step of a slope until it stands still.
fn settled(start: f64, mut step: impl FnMut(f64) -> f64) -> Result<f64, FitError> {
    let mut slope = start;
    let mut change_share = f64::INFINITY;
    for _ in 0..ITERATIONS_MAX {
        let next = step(slope);
        if !next.is_finite() {
            return Err(FitError::NotSettled);
        }
        change_share = (next - slope).abs() / next.abs().max(f64::MIN_POSITIVE);
        slope = next;
        if change_share <= SETTLED_SHARE {
            return Ok(slope);
        }
    }
    if change_share <= TREMBLING_SHARE { Ok(slope) } else { Err(FitError::NotSettled) }
}
