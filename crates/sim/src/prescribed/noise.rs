//! Broadband noise whose power density has a formula.

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use std::f64::consts::TAU;

/// Lowest and number of the corners of [`Noise::pink`], three to a decade.
const PINK_CORNER_HZ: f64 = 50.0;
const PINK_CORNERS: u32 = 10;

/// Gaussian noise: a sum of independent first-order processes.
#[derive(Clone, Debug, PartialEq)]
pub struct Noise {
    processes: Vec<FirstOrder>,
}

/// `x[n] = pole · x[n-1] + kick · w[n]`, heard as `x[n] + direct · w[n]`, with white noise w of variance 1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FirstOrder {
    pole: f64,
    kick_std: f64,
    /// Standard deviation of the first x.
    first_std: f64,
    direct_std: f64,
}

impl Noise {
    /// White noise of a standard deviation.
    pub fn white(std: f64) -> Self {
        Self { processes: vec![FirstOrder { pole: 0.0, kick_std: std, first_std: std, direct_std: 0.0 }] }
    }

    /// Noise of a standard deviation, flat below a corner, falling by 6 dB per octave above it. Stationary from the first
    /// sample.
    pub fn falling(std: f64, corner_hz: f64, sample_rate_hz: f64) -> Self {
        let pole = pole_of(corner_hz, sample_rate_hz);
        let kick_std = (std * std * (1.0 - pole * pole)).sqrt();
        Self { processes: vec![FirstOrder { pole, kick_std, first_std: std, direct_std: 0.0 }] }
    }

    /// White noise of the standard deviation `in_std` through a low-pass `x[n] = pole · x[n-1] + (1 - pole) · in[n]`, plus
    /// a share of the same white noise: it falls to a floor. Starts from rest.
    pub fn low_passed(in_std: f64, pole: f64, direct_share: f64) -> Self {
        let kick_std = in_std * (1.0 - pole);
        Self { processes: vec![FirstOrder { pole, kick_std, first_std: kick_std, direct_std: in_std * direct_share }] }
    }

    /// Noise that falls by 3 dB per octave, of a given power density at one frequency. At 48 kHz the slope is straight to
    /// half a decibel from 200 Hz to 12 kHz. Starts from rest.
    ///
    /// Ten first-order processes, three corners to a decade. Each has the density `p / (1 + (f/c)²)`; with `p = 1/c` they
    /// add up to nearly `1/f`.
    pub fn pink(density: f64, at_hz: f64, sample_rate_hz: f64) -> Self {
        let corners_hz = || (0..PINK_CORNERS).map(|index| PINK_CORNER_HZ * 10_f64.powf(f64::from(index) / 3.0));
        let shape: f64 = corners_hz().map(|corner_hz| 1.0 / corner_hz / (1.0 + (at_hz / corner_hz).powi(2))).sum();
        let scale = density / shape;
        let process = |corner_hz: f64| {
            let pole = pole_of(corner_hz, sample_rate_hz);
            // density at 0 is 2 kick² / (rate (1 - pole)²)
            let kick_std = (scale / corner_hz * sample_rate_hz / 2.0).sqrt() * (1.0 - pole);
            FirstOrder { pole, kick_std, first_std: kick_std, direct_std: 0.0 }
        };
        Self { processes: corners_hz().map(process).collect() }
    }

    /// One-sided power density at a frequency, exactly:
    /// `2/rate · Σ |kick / (1 - pole e^(-iω)) + direct|²`.
    pub fn density(&self, hz: f64, sample_rate_hz: f64) -> f64 {
        let cosine = (TAU * hz / sample_rate_hz).cos();
        let distance_square = |far: f64, near: f64| far * far - 2.0 * far * near * cosine + near * near;
        let gain = |process: &FirstOrder| {
            let FirstOrder { pole, kick_std, direct_std, .. } = *process;
            distance_square(kick_std + direct_std, direct_std * pole) / distance_square(1.0, pole)
        };
        2.0 / sample_rate_hz * self.processes.iter().map(gain).sum::<f64>()
    }

    /// Adds the noise to samples, process by process: each draws one normal number for each sample.
    pub(super) fn add_to(&self, samples: &mut [f64], random: &mut impl Rng) {
        for process in &self.processes {
            let mut state = None;
            for sample in &mut *samples {
                let white: f64 = random.sample(StandardNormal);
                let value = match state {
                    None => process.first_std * white,
                    Some(before) => process.pole * before + process.kick_std * white,
                };
                *sample += value + process.direct_std * white;
                state = Some(value);
            }
        }
    }
}

fn pole_of(corner_hz: f64, sample_rate_hz: f64) -> f64 {
    (-TAU * corner_hz / sample_rate_hz).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64;

    const RATE_HZ: f64 = 48_000.0;

    fn samples_of(noise: &Noise, count: usize) -> Vec<f64> {
        let mut samples = vec![0.0; count];
        noise.add_to(&mut samples, &mut Pcg64::seed_from_u64(6));
        samples
    }

    /// The mean of M periodograms has the relative standard error 1/√M.
    #[test]
    fn every_colour_has_its_density() {
        let (length, count) = (4800_usize, 400_usize);
        let colours = [
            Noise::white(1.4),
            Noise::falling(1.4, 20.0, RATE_HZ),
            Noise::low_passed(0.3, 0.9, 0.1),
            Noise::pink(1e-5, 4000.0, RATE_HZ),
        ];
        for noise in colours {
            let samples = samples_of(&noise, length * count);
            for hz in [120.0, 1000.0, 4150.0, 12_450.0, 20_000.0] {
                let periodogram = |frame: &[f64]| {
                    let (mut re, mut im, mut weights) = (0.0, 0.0, 0.0);
                    for (n, value) in frame.iter().enumerate() {
                        let weight = 0.5 - 0.5 * (TAU * (n as f64 + 0.5) / length as f64).cos();
                        let (sine, cosine) = (TAU * hz * n as f64 / RATE_HZ).sin_cos();
                        re += weight * value * cosine;
                        im += weight * value * sine;
                        weights += weight * weight;
                    }
                    2.0 * (re * re + im * im) / (RATE_HZ * weights)
                };
                let mean = samples.chunks(length).map(periodogram).sum::<f64>() / count as f64;
                let ratio = mean / noise.density(hz, RATE_HZ);
                assert!((ratio - 1.0).abs() < 5.0 / (count as f64).sqrt() + 0.03, "{hz} Hz: {ratio}");
            }
        }
    }

    #[test]
    fn the_slopes_are_the_set_ones() {
        let db = |noise: &Noise, hz: f64| 10.0 * noise.density(hz, RATE_HZ).log10();
        let falling = Noise::falling(1.0, 20.0, RATE_HZ);
        assert!((db(&falling, 400.0) - db(&falling, 200.0) + 6.0).abs() < 0.05);
        let pink = Noise::pink(1e-5, 4000.0, RATE_HZ);
        for hz in [200.0, 300.0, 1000.0, 4000.0, 12_000.0] {
            let off = db(&pink, hz) + 50.0 + 10.0 * (hz / 4000.0).log10();
            assert!(off.abs() < 0.5, "{hz} Hz: {off} dB");
        }
    }

    /// Noise of correlation time 1/(2π 20 Hz): the variance over T has the relative standard error √(1/(2π 20 Hz T)).
    #[test]
    fn the_standard_deviation_is_the_set_one() {
        for (noise, tolerance) in [(Noise::white(0.3), 0.005), (Noise::falling(0.3, 20.0, RATE_HZ), 0.1)] {
            let samples = samples_of(&noise, 2_000_000);
            let std = (samples.iter().map(|value| value * value).sum::<f64>() / samples.len() as f64).sqrt();
            assert!((std / 0.3 - 1.0).abs() < tolerance, "{std}");
        }
    }
}
