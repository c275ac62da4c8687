//! Bayes factor of a regression with one gain, against no gain.

use statrs::function::erf::erfc;
use std::f64::consts::{PI, SQRT_2};

/// Argument t of `ln 2Φ(t)` above which the complementary error function is used, and at and below which the asymptote: the function
/// underflows near t = −38, and the asymptote of Φ is accurate to 1/t², 0.1 %. *Numeric.*
const ERFC_T_MIN: f64 = -30.0;
/// Fewest values of a regression after its nuisance series are projected out: a gain and one degree of freedom. *Numeric.*
pub(super) const VALUES_MIN: usize = 2;

/// The sums of a regression `y = g x + noise` of white series.
#[derive(Clone, Copy, Debug)]
pub(super) struct Regression {
    /// ⟨x, y⟩.
    pub(super) xy: f64,
    /// ⟨x, x⟩.
    pub(super) xx: f64,
    /// ⟨y, y⟩.
    pub(super) yy: f64,
    /// Number of independent values.
    pub(super) degrees: f64,
}

impl Regression {
    /// Logarithm of the Bayes factor of `y = g x + noise` with g > 0, against `y = noise`: the prior of
    /// [`ln_bayes_factor`](Self::ln_bayes_factor), restricted to positive gains, multiplies the factor by `2 Φ(t)`.
    pub(super) fn ln_bayes_factor_of_positive(&self) -> f64 {
        self.ln_bayes_factor() + ln_twice_normal(self.t())
    }

    /// Logarithm of the Bayes factor of `y = g x + noise` with a gain of either sign, against `y = noise`: `(1 + n)^((n−1)/2) /
    /// (1 + n (1 − R²))^(n/2)`, from the unit-information g-prior (Zellner 1986; Liang et al., J. Am. Stat. Assoc. 103, 2008, eq 6).
    pub(super) fn ln_bayes_factor(&self) -> f64 {
        let (n, unexplained) = (self.degrees, 1.0 - self.r_squared());
        ((n - 1.0) * n.ln_1p() - n * (n * unexplained).ln_1p()) / 2.0
    }

    fn r_squared(&self) -> f64 {
        let product = self.xx * self.yy;
        if product > 0.0 { (self.xy * self.xy / product).min(1.0) } else { 0.0 }
    }

    /// Gain over its standard uncertainty.
    fn t(&self) -> f64 {
        let explained = self.r_squared();
        let t = (explained * (self.degrees - 1.0) / (1.0 - explained).max(f64::EPSILON)).sqrt();
        t.copysign(self.xy)
    }
}

/// `ln 2 Φ(t)`, Φ the standard normal distribution function.
fn ln_twice_normal(t: f64) -> f64 {
    if t > ERFC_T_MIN { erfc(-t / SQRT_2).ln() } else { -t * t / 2.0 - (-t * (PI / 2.0).sqrt()).ln() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gain_of_the_wrong_sign_counts_against_the_model() {
        let regression = |xy: f64| Regression { xy, xx: 1.0, yy: 1.0, degrees: 100.0 };
        assert!(regression(0.6).ln_bayes_factor_of_positive() > 15.0);
        assert!(regression(-0.6).ln_bayes_factor_of_positive() < 0.0);
        // no correlation costs the prior's width, √(1 + n)
        assert!((regression(0.0).ln_bayes_factor() + 101f64.ln() / 2.0).abs() < 1e-12);
        assert!((regression(0.0).ln_bayes_factor_of_positive() - regression(0.0).ln_bayes_factor()).abs() < 1e-12);
        let no_input = Regression { xy: 0.0, xx: 0.0, yy: 1.0, degrees: 100.0 };
        assert!(no_input.ln_bayes_factor_of_positive() < 0.0);
    }

    #[test]
    fn the_normal_tail_is_continuous() {
        let (inside, outside) = (ln_twice_normal(-29.999_999), ln_twice_normal(-30.000_001));
        assert!((inside - outside).abs() < 2e-3, "{inside} {outside}");
        assert!((ln_twice_normal(0.0)).abs() < 1e-12);
    }
}
