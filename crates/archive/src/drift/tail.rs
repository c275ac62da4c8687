//! The chance of a deviation.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// Chance of a deviation of at least this many standard uncertainties to either side: of Student's t where the uncertainty has degrees of
/// freedom, else of the normal distribution.
pub(super) fn two_sided(stds: f64, degrees_of_freedom: Option<f64>) -> f64 {
    let tail = match degrees_of_freedom {
        // the library refuses infinite arguments
        _ if stds.is_infinite() => Some(0.0),
        None => Normal::new(0.0, 1.0).ok().map(|normal| normal.sf(stds.abs())),
        Some(freedom) => StudentsT::new(0.0, 1.0, freedom).ok().map(|student| student.sf(stds.abs())),
    };
    tail.map(|tail| (2.0 * tail).min(1.0)).filter(|chance| chance.is_finite()).unwrap_or(1.0)
}
