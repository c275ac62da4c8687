//! Low-pass filter and decimation: samples of the low frequencies at a low rate, so that long frames of them cost little.

use super::window::BLACKMAN_TERMS;
use std::f64::consts::TAU;

/// Length of the filter in output samples. With a Blackman window the transition band is 0.46 of the output rate wide, so that
/// aliases below [`USABLE_SHARE`] of the output rate are at least 54 dB down. *Numeric.*
const FILTER_OUTPUT_SAMPLES: usize = 12;
/// Highest frequency without aliases, as a share of the output rate. *Numeric.*
const USABLE_SHARE: f64 = 0.3;

/// Low-pass filter that keeps one sample in `factor`. Holds the state of one stretch of sound without gaps.
///
/// The filter is a windowed sinc (finite impulse response, linear phase, gain 1 at 0 Hz) with a Blackman window (Harris,
/// Proc. IEEE 66, 1978). Aliases below [`Decimator::hz_max`] are at least 54 dB down.
pub struct Decimator {
    filter: Vec<f32>,
    factor: usize,
    pending: Vec<f32>,
    output: Vec<f32>,
    rate_hz: f64,
}

impl Decimator {
    /// The lowest output rate that keeps all frequencies below `hz_max` (Hz). Where `hz_max` is above 0.15 of the sample rate,
    /// the output is the input.
    pub fn new(sample_rate_hz: f64, hz_max: f64) -> Self {
        let factor = ((sample_rate_hz * USABLE_SHARE / hz_max) as usize).max(1);
        let length = if factor == 1 { 1 } else { FILTER_OUTPUT_SAMPLES * factor + 1 };
        let centre = (length - 1) as f64 / 2.0;
        let mut filter: Vec<f64> = (0..length)
            .map(|n| {
                let share = if length == 1 { 0.5 } else { n as f64 / (length - 1) as f64 };
                let [a0, a1, a2] = BLACKMAN_TERMS;
                let blackman = a0 + a1 * (TAU * share).cos() + a2 * (2.0 * TAU * share).cos();
                let turn = TAU / 2.0 * (n as f64 - centre) / factor as f64;
                blackman * if turn == 0.0 { 1.0 } else { turn.sin() / turn }
            })
            .collect();
        let sum: f64 = filter.iter().sum();
        filter.iter_mut().for_each(|weight| *weight /= sum);
        Self {
            filter: filter.into_iter().map(|weight| weight as f32).collect(),
            factor,
            pending: Vec::new(),
            output: Vec::new(),
            rate_hz: sample_rate_hz / factor as f64,
        }
    }

    /// Output rate, samples per s.
    pub fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// Highest frequency that passes unchanged, Hz.
    pub fn hz_max(&self) -> f64 {
        if self.factor == 1 { self.rate_hz / 2.0 } else { USABLE_SHARE * self.rate_hz }
    }

    /// Time from the first input sample to the first output sample, s: half the length of the filter.
    pub fn delay_s(&self) -> f64 {
        (self.filter.len() - 1) as f64 / 2.0 / (self.rate_hz * self.factor as f64)
    }

    /// Takes in samples and returns the output samples that they complete.
    pub fn push(&mut self, samples: &[f32]) -> &[f32] {
        self.pending.extend_from_slice(samples);
        self.output.clear();
        let mut start = 0;
        while start + self.filter.len() <= self.pending.len() {
            let window = &self.pending[start..start + self.filter.len()];
            self.output.push(dot(window, &self.filter));
            start += self.factor;
        }
        self.pending.drain(..start.min(self.pending.len()));
        &self.output
    }
}

/// Sum of products in eight lanes, which the compiler turns into vector instructions.
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut lanes = [0.0f32; 8];
    let (a_lanes, b_lanes) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f32 = a_lanes.remainder().iter().zip(b_lanes.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a_lanes.zip(b_lanes) {
        for lane in 0..8 {
            lanes[lane] += a[lane] * b[lane];
        }
    }
    lanes.iter().sum::<f32>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rms of a tone after decimation, as a share of what it was.
    fn gain(hz: f64, rate_hz: f64) -> f64 {
        let mut decimator = Decimator::new(rate_hz, 1200.0);
        let tone: Vec<f32> = (0..rate_hz as usize).map(|n| (TAU * hz * n as f64 / rate_hz).sin() as f32).collect();
        let mut out = Vec::new();
        tone.chunks(777).for_each(|block| out.extend_from_slice(decimator.push(block)));
        assert!(out.len() > 3000);
        (out.iter().map(|x| f64::from(x * x)).sum::<f64>() / out.len() as f64 * 2.0).sqrt()
    }

    #[test]
    fn low_tones_pass_and_high_ones_do_not_fold_back() {
        for rate_hz in [8000.0, 44100.0, 48000.0, 96000.0] {
            for hz in [20.0, 500.0, 1200.0] {
                assert!((gain(hz, rate_hz) - 1.0).abs() < 0.01, "{hz} Hz at {rate_hz}: {}", gain(hz, rate_hz));
            }
            let decimator = Decimator::new(rate_hz, 1200.0);
            let folds_onto_the_highest = decimator.rate_hz() - decimator.hz_max();
            for hz in [folds_onto_the_highest, decimator.rate_hz(), decimator.rate_hz() + 50.0] {
                assert!(gain(hz, rate_hz) < 2e-3, "{hz} Hz at {rate_hz}: {}", gain(hz, rate_hz));
            }
        }
    }

    #[test]
    fn a_slow_source_passes_as_it_is() {
        let mut decimator = Decimator::new(2000.0, 1200.0);
        assert_eq!(decimator.push(&[1.0, 2.0, 3.0]), [1.0, 2.0, 3.0]);
        assert_eq!((decimator.rate_hz(), decimator.hz_max(), decimator.delay_s()), (2000.0, 1000.0, 0.0));
    }
}
