//! Unsteadiness of the commands.

use super::sections::JitterSection;
use crate::control::Command;
use crate::ornstein_uhlenbeck::OrnsteinUhlenbeck;
use crate::seed::{Part, stream};
use rand::RngExt;
use rand_distr::StandardNormal;

/// Four independent smooth processes, one for each command.
#[derive(Clone)]
pub(super) struct Jitter {
    axes: [Smooth; 4],
}

impl Jitter {
    pub(super) fn new(section: &JitterSection, period_s: f64, seed: u64) -> Self {
        let stds = [section.roll_std, section.pitch_std, section.yaw_rate_std, section.climb_std];
        let axis = |k: usize| Smooth::new(stds[k], section.time_constant_s, period_s, seed, k as u64);
        Self { axes: std::array::from_fn(axis) }
    }

    /// The present addition to a command.
    pub(super) fn now(&self) -> Command {
        Command::from_array(self.axes.each_ref().map(|axis| axis.value))
    }

    /// The command with the next addition. Call it once per controller period.
    pub(super) fn shaken(&mut self, command: Command) -> Command {
        let mut parts = command.to_array();
        for (part, axis) in parts.iter_mut().zip(&mut self.axes) {
            *part += axis.step();
        }
        Command::from_array(parts)
    }
}

/// An Ornstein-Uhlenbeck process behind a lag of its own time constant τ: critically damped, second order, with
/// autocovariance std² (1 + t/τ) e^(-t/τ) and a derivative of std/τ. Neither a thumb nor a filtered measurement jumps; the
/// jumps of a first-order process would shake the rotors, for any time constant.
#[derive(Clone)]
struct Smooth {
    input: OrnsteinUhlenbeck,
    keep: f64,
    value: f64,
}

impl Smooth {
    fn new(std: f64, time_constant_s: f64, period_s: f64, seed: u64, axis: u64) -> Self {
        // Stationary: var y = cov(x, y) = var x / 2.
        let input_std = std * std::f64::consts::SQRT_2;
        let input = OrnsteinUhlenbeck::new(input_std, time_constant_s, period_s, stream(seed, Part::Jitter, 2 * axis));
        let own: f64 = stream(seed, Part::Jitter, 2 * axis + 1).sample(StandardNormal);
        let value = 0.5 * (input.value() + input_std * own);
        Self { input, keep: (-period_s / time_constant_s).exp(), value }
    }

    fn step(&mut self) -> f64 {
        let before = self.input.value();
        // the lag's input goes straight from before to after, to first order in the period
        let between = 0.5 * (before + self.input.step());
        self.value = self.keep * self.value + (1.0 - self.keep) * between;
        self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The variance estimate over T has relative standard error √(5 τ/T) (∫ of the squared autocorrelation is 5τ/4 on
    /// either side, twice that, twice over T); five of them.
    #[test]
    fn it_is_as_strong_and_as_slow_as_set() {
        let (std, time_constant_s, period_s, count) = (0.07, 0.3, 0.005, 400_000_u32);
        let relative_error = (5.0 * time_constant_s / (period_s * f64::from(count))).sqrt();
        for axis in 0..4 {
            let mut process = Smooth::new(std, time_constant_s, period_s, 5, axis);
            let (mut squares, mut changes, mut before) = (0.0, 0.0, process.value);
            for _ in 0..count {
                let value = process.step();
                squares += value * value;
                changes += ((value - before) / period_s).powi(2);
                before = value;
            }
            let variance = squares / f64::from(count) / (std * std);
            assert!((variance - 1.0).abs() < 5.0 * relative_error, "{variance}");
            // a difference over h of the smooth process falls short of its derivative by 2h/3τ
            let slope = changes / f64::from(count) / (std / time_constant_s).powi(2);
            assert!((slope - 1.0).abs() < 5.0 * relative_error + period_s / time_constant_s, "{slope}");
        }
    }

    #[test]
    fn the_first_value_is_already_stationary() {
        let count = 4000_u32;
        let square: f64 = (0..count).map(|seed| Smooth::new(1.0, 0.3, 0.005, seed.into(), 3).value.powi(2)).sum();
        assert!((square / f64::from(count) - 1.0).abs() < 5.0 * (2.0 / f64::from(count)).sqrt());
    }
}
