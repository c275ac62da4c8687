//! Mean, spread and median of a few numbers, and the probability of a deviation.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// Arithmetic mean; `None` without values.
pub(crate) fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Standard deviation of a sample (n − 1 in the denominator); `None` below two values. Eq 8 of the paper lacks the square.
pub(crate) fn std(values: &[f64]) -> Option<f64> {
    let centre = mean(values).filter(|_| values.len() >= 2)?;
    let squares: f64 = values.iter().map(|value| (value - centre).powi(2)).sum();
    Some((squares / (values.len() - 1) as f64).sqrt())
}

/// Median; of an even number of values the upper of the two in the middle. `None` without values.
pub(crate) fn median(values: &[f64]) -> Option<f64> {
    let mut values = values.to_vec();
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Probability of a deviation of at least `stds` standard uncertainties to either side: from the normal distribution, or from
/// Student's t where the uncertainty has degrees of freedom. `None` where there are no degrees of freedom.
pub(crate) fn two_sided_chance(stds: f64, degrees_of_freedom: Option<f64>) -> Option<f64> {
    let tail = match degrees_of_freedom {
        // the library refuses infinite arguments
        _ if stds.is_infinite() => 0.0,
        None => Normal::new(0.0, 1.0).ok()?.sf(stds.abs()),
        Some(freedom) => StudentsT::new(0.0, 1.0, freedom).ok()?.sf(stds.abs()),
    };
    Some((2.0 * tail).min(1.0)).filter(|chance| chance.is_finite())
}
