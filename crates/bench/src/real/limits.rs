//! Confidence limits of counts.

use statrs::distribution::{Beta, ChiSquared, ContinuousCDF};

/// Confidence of all intervals.
const CONFIDENCE: f64 = 0.95;

/// A share between its limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    pub(super) low: f64,
    pub(super) high: f64,
}

/// The 95 % interval of a share (Clopper and Pearson 1934); everything where nothing was counted.
pub(super) fn binomial_interval(count: usize, of: usize) -> Interval {
    let quantile =
        |below: f64, a: usize, b: usize| Beta::new(a as f64, b as f64).map_or(f64::NAN, |beta| beta.inverse_cdf(below));
    let tail = (1.0 - CONFIDENCE) / 2.0;
    Interval {
        low: if count == 0 { 0.0 } else { quantile(tail, count, of - count + 1) },
        high: if count == of { 1.0 } else { quantile(1.0 - tail, count + 1, of - count) },
    }
}

/// The upper 95 % limit of the mean of a Poisson count (Garwood 1936).
pub(super) fn poisson_upper_limit(count: usize) -> f64 {
    ChiSquared::new(2.0 * (count + 1) as f64).map_or(f64::NAN, |chi2| chi2.inverse_cdf(CONFIDENCE) / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_those_of_the_tables() {
        // of no event in n: 1 − 0.025^(1/n)
        let none = binomial_interval(0, 10);
        assert!(none.low == 0.0 && (none.high - 0.308_497).abs() < 1e-5, "{none:?}");
        let some = binomial_interval(8, 10);
        assert!((some.low - 0.443_905).abs() < 1e-5 && (some.high - 0.974_789).abs() < 1e-5, "{some:?}");
        assert_eq!(binomial_interval(10, 10).high, 1.0);
        assert_eq!(binomial_interval(0, 0), Interval { low: 0.0, high: 1.0 });
        // −ln 0.05, and the table of Garwood
        assert!((poisson_upper_limit(0) - 2.995_732).abs() < 1e-5);
        assert!((poisson_upper_limit(3) - 7.753_66).abs() < 1e-4);
    }
}
