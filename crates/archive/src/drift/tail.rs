//! The chance of a deviation.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// Chance that a normal deviate is below two standard deviations.
const BELOW_TWO_STDS: f64 = 0.977_249_868;

/// Number of standard uncertainties that cover as much as two of a normal distribution: more, where few degrees of freedom tell the uncertainty.
pub(super) fn covering_stds(degrees_of_freedom: Option<f64>) -> f64 {
    let student = degrees_of_freedom.and_then(|freedom| StudentsT::new(0.0, 1.0, freedom).ok());
    student.map_or(2.0, |student| student.inverse_cdf(BELOW_TWO_STDS))
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_degrees_of_freedom_need_more_standard_uncertainties() {
        assert_eq!(covering_stds(None), 2.0);
        // tables of Student's t for 95.45 %
        for (freedom, expected) in [(1.0, 13.968), (4.0, 2.869), (1000.0, 2.003)] {
            let stds = covering_stds(Some(freedom));
            assert!((stds - expected).abs() < 2e-3, "{freedom}: {stds}");
        }
    }
}
