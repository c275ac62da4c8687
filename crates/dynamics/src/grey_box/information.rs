//! How well the flight tells the parameters, and which it cannot tell from each other.

use super::parameters::Parameter;
use nalgebra::{DMatrix, SymmetricEigen};

/// Two parameters count as hardly told from each other from this correlation of their estimates on. *Decision*: the uncertainty of either is
/// then three times as large as with the other known.
const CORRELATION_MIN: f64 = 0.95;
/// Smallest eigenvalue, over the largest, of the information with a diagonal of 1 that counts towards the rank. *Numeric.*
const EIGENVALUE_SHARE_MIN: f64 = 1e-7;

/// Two parameters whose estimates go together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// The first.
    pub first: Parameter,
    /// The second.
    pub second: Parameter,
    /// Correlation of the two estimates, −1 to 1.
    pub correlation: f64,
}

/// What the information matrix tells.
#[derive(Clone, Debug, PartialEq)]
pub struct Information {
    /// Number of parameters that were sought.
    pub parameters: usize,
    /// Number of combinations of parameters that the flight tells.
    pub rank: usize,
    /// Largest over smallest eigenvalue of the information, with a diagonal of 1.
    pub condition: f64,
    /// Pairs with a strong correlation, strongest first.
    pub correlations: Vec<Correlation>,
}

/// From `Jᵀ W J` of the data alone, and the covariance of the estimates.
pub(super) fn information_of(matrix: &DMatrix<f64>, covariance: &DMatrix<f64>, free: &[Parameter]) -> Information {
    let scale = |at: usize| if matrix[(at, at)] > 0.0 { matrix[(at, at)].sqrt() } else { 1.0 };
    let scaled =
        DMatrix::from_fn(free.len(), free.len(), |row, column| matrix[(row, column)] / (scale(row) * scale(column)));
    let eigenvalues = SymmetricEigen::new(scaled).eigenvalues;
    let largest = eigenvalues.iter().copied().fold(0.0, f64::max);
    let smallest = eigenvalues.iter().copied().fold(f64::INFINITY, f64::min);
    let rank = eigenvalues.iter().filter(|value| **value > EIGENVALUE_SHARE_MIN * largest).count();
    let mut correlations = Vec::new();
    for first in 0..free.len() {
        for second in first + 1..free.len() {
            let variances = covariance[(first, first)] * covariance[(second, second)];
            let correlation = covariance[(first, second)] / variances.sqrt();
            if correlation.abs() >= CORRELATION_MIN {
                correlations.push(Correlation { first: free[first], second: free[second], correlation });
            }
        }
    }
    correlations.sort_by(|a, b| b.correlation.abs().total_cmp(&a.correlation.abs()));
    Information { parameters: free.len(), rank, condition: largest / smallest.max(f64::MIN_POSITIVE), correlations }
}
