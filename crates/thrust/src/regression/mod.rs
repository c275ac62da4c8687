//! Straight lines through points with uncertainty in both coordinates, and the evidence for an additional parameter. The input is x, y
//! and their standard uncertainties; nothing here knows of rotors.
//!
//! York, Evensen, Martínez and De Basabe Delgado, "Unified equations for the slope, intercept, and standard errors of the
//! best straight line", American Journal of Physics 72, 367 (2004). The line through the origin minimises the same sum,
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

/// Most iterations of the slope. Normal data need five to ten. *Numeric.*
const ITERATIONS_MAX: usize = 200;
/// Relative change of the slope at which the iteration has converged: a few rounding errors. *Numeric.*
const SETTLED_SHARE: f64 = 4.0 * f64::EPSILON;
/// Relative change that is accepted after the last iteration, when rounding errors make the slope alternate. *Numeric.*
const TREMBLING_SHARE: f64 = 1e-10;

/// A point. The errors of its coordinates are independent of each other and of the other points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitPoint {
    /// Abscissa.
    pub x: f64,
    /// Standard uncertainty of the abscissa; 0 where it is exact.
    pub x_std: f64,
    /// Ordinate.
    pub y: f64,
    /// Standard uncertainty of the ordinate; 0 where it is exact.
    pub y_std: f64,
}

impl FitPoint {
    /// A point with an exact abscissa.
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

/// Reason for a missing line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// Not enough points.
    #[error("there are {given} points, and this law needs {needed} or more")]
    TooFewPoints {
        /// Number of given points.
        given: usize,
        /// Number of points that the law needs.
        needed: usize,
    },
    /// A coordinate that is not a number, or a point without any uncertainty.
    #[error("point number {number} has a coordinate that is no number, or no uncertainty at all")]
    UnusablePoint {
        /// Number of the point, counted from 1.
        number: usize,
    },
    /// All points have the same x.
    #[error("all points have the same x, so the slope cannot be found")]
    NoSpread,
    /// The iteration did not converge.
    #[error("the points fit no straight line: the fit finds no slope")]
    NotSettled,
}

/// How well points agree with a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// Σ (y − law)² / u².
    pub chi_square: f64,
    /// Number of points minus number of parameters.
    pub degrees_of_freedom: usize,
}

impl Agreement {
    /// Probability of a chi-square at least this large if law and uncertainties are right; `None` without degrees of freedom.
    pub fn p_value(&self) -> Option<f64> {
        let distribution = ChiSquared::new(self.degrees_of_freedom as f64).ok()?;
        Some(distribution.sf(self.chi_square))
    }

    /// Birge's ratio √(χ²/ν) (Birge 1932): the factor on all uncertainties that makes chi-square equal to the degrees of freedom ν. With
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

/// Iterates the slope until it converges.
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
