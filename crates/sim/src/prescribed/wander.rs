//! Random processes at evenly spaced nodes: how speeds, levels and phases wander.

use crate::ornstein_uhlenbeck::OrnsteinUhlenbeck;
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use std::f64::consts::{PI, TAU};

/// A random wander about 0, to be drawn at nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wander {
    /// Standard deviation.
    pub std: f64,
    /// Integral of the autocorrelation function over positive lags.
    pub time_constant_s: f64,
    /// Time between two nodes.
    pub step_s: f64,
    /// Number of nodes.
    pub count: usize,
}

impl Wander {
    /// An Ornstein-Uhlenbeck process: autocorrelation `e^(-t/τ)`, no derivative. Stationary from the first node.
    pub fn ornstein_uhlenbeck(&self, random: &mut impl Rng) -> Vec<f64> {
        let process = OrnsteinUhlenbeck::new(self.std, self.time_constant_s, self.step_s, random);
        self.values_of(process)
    }

    /// The same process, one step after it was 0.
    pub fn ornstein_uhlenbeck_from_zero(&self, random: &mut impl Rng) -> Vec<f64> {
        let mut process = OrnsteinUhlenbeck::from_zero(self.std, self.time_constant_s, self.step_s, random);
        process.step();
        self.values_of(process)
    }

    fn values_of<R: Rng>(&self, mut process: OrnsteinUhlenbeck<R>) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.count);
        while values.len() < self.count {
            if !values.is_empty() {
                process.step();
            }
            values.push(process.value());
        }
        values
    }

    /// An Ornstein-Uhlenbeck process smoothed by Hann weights over `half_width_nodes` to either side. `std` is the standard
    /// deviation after smoothing; the time constant is that of the process before smoothing.
    pub fn smoothed(&self, half_width_nodes: u32, random: &mut impl Rng) -> Vec<f64> {
        let half = i32::try_from(half_width_nodes).unwrap_or(i32::MAX - 1);
        let weights: Vec<f64> =
            (-half..=half).map(|node| 0.5 + 0.5 * (PI * f64::from(node) / f64::from(half + 1)).cos()).collect();
        let keep = (-self.step_s / self.time_constant_s).exp();
        let smoothed_variance: f64 = (0..)
            .zip(&weights)
            .flat_map(|(i, a)| (0..).zip(&weights).map(move |(j, b)| a * b * keep.powi(i32::abs(i - j))))
            .sum();
        // two values more than the windows need: part of what a seed means
        let raw_count = self.count + weights.len() + 1;
        let raw = Self { std: 1.0, count: raw_count, ..*self }.ornstein_uhlenbeck(random);
        raw.windows(weights.len())
            .take(self.count)
            .map(|window| window.iter().zip(&weights).map(|(value, weight)| value * weight).sum::<f64>())
            .map(|sum| self.std * sum / smoothed_variance.sqrt())
            .collect()
    }

    /// A critically damped second-order process, `y[n] = 2k y[n-1] - k² y[n-2] + e[n]` with `k = e^(-2 step/τ)`:
    /// autocorrelation `(1 + 2t/τ) e^(-2t/τ)`, smooth to the first derivative. Starts ten time constants before the first
    /// node, so that it is stationary there.
    pub fn critically_damped(&self, random: &mut impl Rng) -> Vec<f64> {
        let keep = (-2.0 / self.time_constant_s * self.step_s).exp();
        let settling = (10.0 * self.time_constant_s / self.step_s) as usize;
        let keep_square = keep * keep;
        let variance = (1.0 + keep_square) / (1.0 - keep_square).powi(3);
        let (mut last, mut one_before) = (0.0, 0.0);
        let mut values = Vec::with_capacity(self.count);
        for node in 0..settling + self.count {
            let kick: f64 = random.sample(StandardNormal);
            let value = 2.0 * keep * last - keep_square * one_before + kick;
            (one_before, last) = (last, value);
            if node >= settling {
                values.push(self.std * (value / variance.sqrt()));
            }
        }
        values
    }
}

/// A random walk of a line's phase at nodes, rad: over a time t the line correlates with itself by `e^(-t/T)`, with the
/// coherence time `T`. The first node is one step after the start. An infinite coherence time gives a constant phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseWalk {
    /// Phase at the start.
    pub start_rad: f64,
    /// Coherence time.
    pub coherence_s: f64,
    /// Time between two nodes.
    pub step_s: f64,
    /// Number of nodes.
    pub count: usize,
}

impl PhaseWalk {
    /// Draws the phases.
    pub fn drawn_rad(&self, random: &mut impl Rng) -> Vec<f64> {
        let step_std = (2.0 * self.step_s / self.coherence_s).sqrt();
        let mut phase = self.start_rad;
        let mut step = || {
            let kick: f64 = random.sample(StandardNormal);
            phase += step_std * kick;
            phase
        };
        (0..self.count).map(|_| step()).collect()
    }
}

/// A wander about 0 as a sum of sines of one amplitude, with random frequencies and phases. It has a formula at every
/// instant, so its truth needs no nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct SineWander {
    amplitude: f64,
    sines: Vec<Sine>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Sine {
    rad_s: f64,
    phase_rad: f64,
}

impl SineWander {
    /// Draws `count` sines with frequencies from a range; `std` is the standard deviation of their sum over a long time.
    pub fn drawn(std: f64, count: usize, hz: std::ops::Range<f64>, random: &mut impl Rng) -> Self {
        let mut sine =
            || Sine { rad_s: TAU * random.random_range(hz.clone()), phase_rad: random.random_range(0.0..TAU) };
        Self { amplitude: std * (2.0 / count as f64).sqrt(), sines: (0..count).map(|_| sine()).collect() }
    }

    /// The value at an instant.
    pub fn at(&self, time_s: f64) -> f64 {
        self.amplitude * self.sines.iter().map(|sine| (sine.rad_s * time_s + sine.phase_rad).sin()).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64;

    const WANDER: Wander = Wander { std: 0.004, time_constant_s: 0.8, step_s: 0.05, count: 400_000 };

    fn std(values: &[f64]) -> f64 {
        (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
    }

    /// The variance estimate over T has the relative standard error √(2τ/T) or less, see `OrnsteinUhlenbeck`.
    #[test]
    fn every_process_has_its_standard_deviation() {
        let random = &mut Pcg64::seed_from_u64(8);
        let tolerance = 5.0 * (2.0 * WANDER.time_constant_s / (WANDER.count as f64 * WANDER.step_s)).sqrt();
        let drawn = [
            WANDER.ornstein_uhlenbeck(random),
            WANDER.ornstein_uhlenbeck_from_zero(random),
            WANDER.smoothed(4, random),
            WANDER.critically_damped(random),
        ];
        for (process, values) in drawn.iter().enumerate() {
            assert_eq!(values.len(), WANDER.count);
            let ratio = std(values) / WANDER.std;
            assert!((ratio - 1.0).abs() < tolerance, "process {process}: {ratio}");
        }
        let sines = SineWander::drawn(WANDER.std, 4, 0.05..1.2, random);
        let values: Vec<f64> = (0..WANDER.count).map(|node| sines.at(node as f64 * WANDER.step_s)).collect();
        assert!((std(&values) / WANDER.std - 1.0).abs() < 0.01, "{}", std(&values));
    }

    /// The mean of `cos(φ(t + s) - φ(t))` is `e^(-s/T)`.
    #[test]
    fn a_walking_phase_keeps_its_coherence_for_the_set_time() {
        let walk = PhaseWalk { start_rad: 0.4, coherence_s: 0.2, step_s: 0.001, count: 2_000_000 };
        let phases = walk.drawn_rad(&mut Pcg64::seed_from_u64(9));
        let lag = 200;
        let differences = phases.windows(lag + 1).map(|pair| pair[lag] - pair[0]);
        let mean = differences.map(f64::cos).sum::<f64>() / (walk.count - lag) as f64;
        let tolerance = 5.0 * (2.0 * walk.coherence_s / (walk.count as f64 * walk.step_s)).sqrt();
        assert!((mean - (-1.0_f64).exp()).abs() < tolerance, "{mean}");
        let steady = PhaseWalk { coherence_s: f64::INFINITY, count: 2, ..walk };
        assert_eq!(steady.drawn_rad(&mut Pcg64::seed_from_u64(9)), [0.4; 2]);
    }
}
