//! Mean, spread and median of a few numbers, the probability of a deviation, and Student's factor.

use hovertone_vehicle::COVERAGE_FACTOR;
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// Smallest p-value that is printed as a number. *Decision.*
const P_VALUE_SHOWN_MIN: f64 = 1e-4;

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

/// Factor on a standard uncertainty with few degrees of freedom that makes twice its value cover as often as two standard deviations of
/// a normal distribution: the quantile of Student's t for 95.45 %, over 2 (JCGM 100:2008, table G.2). 6.98 for one degree of freedom,
/// 1.43 for four, 1 for many.
pub(crate) fn student_factor(degrees_of_freedom: f64) -> f64 {
    let covered = Normal::new(0.0, 1.0).map(|normal| normal.cdf(COVERAGE_FACTOR));
    let student = StudentsT::new(0.0, 1.0, degrees_of_freedom);
    match (covered, student) {
        (Ok(covered), Ok(student)) => student.inverse_cdf(covered) / COVERAGE_FACTOR,
        _ => f64::INFINITY,
    }
}

/// "p = 0.012", or "p < 0.0001" where the number would be printed as zero.
pub fn p_value_text(p_value: f64) -> String {
    if p_value < P_VALUE_SHOWN_MIN {
        return format!("p < {P_VALUE_SHOWN_MIN}");
    }
    // two digits
    let decimals = (1.0 - p_value.log10().floor()).clamp(2.0, 5.0) as usize;
    format!("p = {p_value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::student_factor;

    /// Table G.2 of JCGM 100:2008, column 95.45 %.
    #[test]
    fn students_factor_is_half_the_table_of_the_gum() {
        for (freedom, t) in
            [(1.0, 13.97), (2.0, 4.53), (3.0, 3.31), (4.0, 2.87), (10.0, 2.28), (20.0, 2.13), (1e4, 2.0)]
        {
            assert!((2.0 * student_factor(freedom) - t).abs() < 0.0051, "{freedom}: {}", student_factor(freedom));
        }
    }
}
