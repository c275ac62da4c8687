//! The Ornstein-Uhlenbeck process: a random wander about a mean.

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;

/// A stationary Gaussian process with autocovariance `std² exp(-|t| / time_constant_s)`, sampled every `step_s`.
///
/// The update is exact for any step, `x ← x e^(-dt/τ) + std √(1 - e^(-2dt/τ)) n`, and the first value is drawn from the
/// stationary distribution, so no settling time is needed.
#[derive(Clone, Debug)]
pub(crate) struct OrnsteinUhlenbeck<R = Pcg64> {
    value: f64,
    keep: f64,
    kick_std: f64,
    random: R,
}

impl<R: Rng> OrnsteinUhlenbeck<R> {
    pub(crate) fn new(std: f64, time_constant_s: f64, step_s: f64, mut random: R) -> Self {
        let first: f64 = random.sample(StandardNormal);
        Self { value: std * first, ..Self::from_zero(std, time_constant_s, step_s, random) }
    }

    /// The process after it was 0: stationary after some time constants.
    pub(crate) fn from_zero(std: f64, time_constant_s: f64, step_s: f64, random: R) -> Self {
        let keep = (-step_s / time_constant_s).exp();
        // expm1 keeps the digits that 1 - keep² loses when the step is short.
        let kick_std = std * (-(-2.0 * step_s / time_constant_s).exp_m1()).sqrt();
        Self { value: 0.0, keep, kick_std, random }
    }

    pub(crate) fn value(&self) -> f64 {
        self.value
    }

    pub(crate) fn step(&mut self) -> f64 {
        let normal: f64 = self.random.sample(StandardNormal);
        self.value = self.keep * self.value + self.kick_std * normal;
        self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Part, stream};

    /// Over `T ≫ τ` the variance estimate of this process has relative standard error √(2τ/T), its mean std √(2τ/T),
    /// and the one-step regression coefficient `a` has √((1 - a²)/N), which through τ = -dt/ln a is √(2τ/T) of τ.
    #[test]
    fn std_mean_and_time_constant_are_the_set_ones() {
        let (std, time_constant_s, step_s, count) = (0.012, 0.3, 0.001, 2_000_000_u32);
        let relative_error = (2.0 * time_constant_s / (step_s * f64::from(count))).sqrt();
        for seed in 0..4 {
            let mut wander = OrnsteinUhlenbeck::new(std, time_constant_s, step_s, stream(seed, Part::Wander, 0));
            let (mut sum, mut square, mut lagged, mut before) = (0.0, 0.0, 0.0, wander.value());
            for _ in 0..count {
                let value = wander.step();
                sum += value;
                square += value * value;
                lagged += value * before;
                before = value;
            }
            let n = f64::from(count);
            assert!((sum / n).abs() < 5.0 * std * relative_error, "mean {}", sum / n);
            let variance = square / n;
            assert!((variance / std.powi(2) - 1.0).abs() < 5.0 * relative_error, "variance {variance}");
            let found_s = -step_s / (lagged / square).ln();
            assert!((found_s / time_constant_s - 1.0).abs() < 5.0 * relative_error, "time constant {found_s}");
        }
    }

    #[test]
    fn the_first_value_is_already_stationary() {
        let count = 4000;
        let square: f64 = (0..count)
            .map(|seed| OrnsteinUhlenbeck::new(2.0, 0.3, 0.001, stream(seed, Part::Wander, 0)).value().powi(2))
            .sum();
        let relative_error = (2.0 / count as f64).sqrt();
        assert!((square / count as f64 / 4.0 - 1.0).abs() < 5.0 * relative_error);
    }
}
