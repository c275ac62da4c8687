//! How much better a log is explained with a track in it than without.

use super::rows::HeardRows;
use statrs::function::erf::erfc;
use std::f64::consts::{PI, SQRT_2};

/// What a kind of log says of each assignment at one offset.
pub(super) trait Evidence {
    /// Logarithm of the likelihood ratio of each assignment to "nothing in common".
    fn log_ratios(&self, heard: &HeardRows, assignments: &[Vec<usize>]) -> Vec<f64>;
}

/// One regression, as far as an assignment decides it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Regression {
    /// ⟨x, y⟩, ⟨x, x⟩ and ⟨y, y⟩ of white series.
    pub(super) xy: f64,
    pub(super) xx: f64,
    pub(super) yy: f64,
    /// Independent values.
    pub(super) degrees: f64,
}

impl Regression {
    /// Logarithm of the Bayes factor of `y = g x + noise` with g > 0 against `y = noise`: unit-information g-prior (Zellner 1986;
    /// Liang et al., J. Am. Stat. Assoc. 103, 2008, eq 6), halved to the positive gains.
    pub(super) fn log_factor_of_positive(&self) -> f64 {
        self.log_factor() + log_twice_normal(self.t())
    }

    /// The same for a gain of either sign.
    pub(super) fn log_factor(&self) -> f64 {
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

/// ln 2 Φ(t).
fn log_twice_normal(t: f64) -> f64 {
    // erfc underflows further out: its asymptote there
    if t > -30.0 { erfc(-t / SQRT_2).ln() } else { -t * t / 2.0 - (-t * (PI / 2.0).sqrt()).ln() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gain_of_the_wrong_sign_is_worth_less_than_none() {
        let of = |xy: f64| Regression { xy, xx: 1.0, yy: 1.0, degrees: 100.0 };
        assert!(of(0.6).log_factor_of_positive() > 15.0);
        assert!(of(-0.6).log_factor_of_positive() < 0.0);
        // no correlation costs the prior's width, √(1 + n)
        assert!((of(0.0).log_factor() + 101f64.ln() / 2.0).abs() < 1e-12);
        assert!((of(0.0).log_factor_of_positive() - of(0.0).log_factor()).abs() < 1e-12);
        let nothing = Regression { xy: 0.0, xx: 0.0, yy: 1.0, degrees: 100.0 };
        assert!(nothing.log_factor_of_positive() < 0.0);
    }

    #[test]
    fn the_normal_tail_is_continuous() {
        let (inside, outside) = (log_twice_normal(-29.999_999), log_twice_normal(-30.000_001));
        assert!((inside - outside).abs() < 2e-3, "{inside} {outside}");
        assert!((log_twice_normal(0.0)).abs() < 1e-12);
    }
}
