//! Signal → power spectra of overlapping frames, streamed (short-time Fourier transform).
//!
//! `X[m, k] = Σ_n x[n] w[n − mH] e^(−j2πkn/N)`, with the frame number m, the bin k, the hop H and the length N of the
//! transform. This is eq 5 of the paper, which uses the letter `k` for both the frame and the bin.
//!
//! The definition stands in `dft.rs`; the tests compare the fast transform with it.

mod band_limit;
mod decimator;
#[cfg(test)]
mod dft;
mod whitening;
mod window;

pub use band_limit::band_limit_hz;
pub use decimator::Decimator;
pub use whitening::whitened_db;
pub use window::Window;
pub use window::{hann_frequency_weight, hann_weights};

use hovertone_fft::TransformNumber;
use realfft::RealToComplex;
use realfft::num_complex::Complex;
use std::sync::Arc;

/// Lowest level, dB re a sine of full scale. It lies below the rounding noise of 24 bits, and keeps the level of silence
/// finite. *Numeric.*
const SILENCE_DB: f64 = -200.0;

/// Level of a power in dB, 10 log₁₀(power), at least −200 dB so that silence stays finite.
pub fn power_db(power: f64) -> f64 {
    (10.0 * power.log10()).max(SILENCE_DB)
}

/// Power spectrum of one frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Middle of the frame on the recording's clock, s.
    pub centre_s: f64,
    /// Power of each bin, one-sided: N/2 + 1 values from 0 Hz to half the sample rate. A sine of full scale at the middle of a
    /// bin gives 1 (0 dB).
    pub power: &'a [f64],
    /// Distance between bins, Hz: sample rate / N.
    pub bin_hz: f64,
}

/// Cuts a stream of samples into frames and transforms each. Holds the state of one stretch of sound without gaps.
///
/// The number type `T` is `f64`, or `f32` in half the time; with `f32`, rounding hides a line that is 130 dB weaker than the
/// loudest.
pub struct Stft<T = f64> {
    plan: Arc<dyn RealToComplex<T>>,
    window: Vec<T>,
    power_scale: f64,
    hop_samples: usize,
    sample_rate_hz: f64,
    pending: Vec<f32>,
    pending_start_s: f64,
    /// Samples left to skip, where the hop is longer than the window.
    skip_samples: usize,
    input: Vec<T>,
    output: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
    power: Vec<f64>,
}

impl<T: TransformNumber> Stft<T> {
    /// Frames of length `window_s` at steps of `hop_s`. The transform is at least `zero_pad_factor` windows long; its length has
    /// only the prime factors 2, 3 and 5.
    pub fn new(sample_rate_hz: f64, window: Window, window_s: f64, hop_s: f64, zero_pad_factor: u32) -> Self {
        let window_samples = ((window_s * sample_rate_hz).round() as usize).max(8);
        let transform_samples = smooth_at_least(window_samples * zero_pad_factor.max(1) as usize, 2);
        let plan = T::real_forward(transform_samples);
        let weights = window.values(window_samples);
        let window_sum: f64 = weights.iter().sum();
        Self {
            power_scale: (2.0 / window_sum).powi(2),
            hop_samples: hop_samples(hop_s, sample_rate_hz),
            sample_rate_hz,
            pending: Vec::new(),
            pending_start_s: 0.0,
            skip_samples: 0,
            input: plan.make_input_vec(),
            output: plan.make_output_vec(),
            scratch: plan.make_scratch_vec(),
            power: vec![0.0; transform_samples / 2 + 1],
            window: weights.into_iter().map(|weight| T::from_f64(weight).unwrap_or_else(T::zero)).collect(),
            plan,
        }
    }

    /// Distance between bins, Hz.
    pub fn bin_hz(&self) -> f64 {
        self.sample_rate_hz / self.input.len() as f64
    }

    /// Frequency resolution, Hz: 1 / window length. Bins at this distance are nearly independent in noise.
    pub fn resolution_hz(&self) -> f64 {
        self.sample_rate_hz / self.window.len() as f64
    }

    /// Sets the step between frames from the next frame on, s.
    pub fn set_hop(&mut self, hop_s: f64) {
        self.hop_samples = hop_samples(hop_s, self.sample_rate_hz);
    }

    /// Begins a new stretch of sound: the next pushed sample is at `start_s`, and earlier samples are dropped.
    pub fn restart(&mut self, start_s: f64) {
        self.pending.clear();
        self.pending_start_s = start_s;
        self.skip_samples = 0;
    }

    /// Takes in samples and calls `on_frame` with every frame that they complete.
    pub fn push(&mut self, samples: &[f32], mut on_frame: impl FnMut(Frame<'_>)) {
        let skipped = self.skip_samples.min(samples.len());
        self.skip_samples -= skipped;
        self.pending_start_s += skipped as f64 / self.sample_rate_hz;
        self.pending.extend_from_slice(&samples[skipped..]);
        let window_samples = self.window.len();
        let mut start = 0;
        while start + window_samples <= self.pending.len() {
            let centre_s = self.pending_start_s + (start as f64 + window_samples as f64 / 2.0) / self.sample_rate_hz;
            self.transform(start);
            on_frame(Frame { centre_s, power: &self.power, bin_hz: self.bin_hz() });
            start += self.hop_samples;
        }
        let used = start.min(self.pending.len());
        self.pending.drain(..used);
        self.skip_samples += start - used;
        self.pending_start_s += used as f64 / self.sample_rate_hz;
    }

    fn transform(&mut self, start: usize) {
        let frame = &self.pending[start..start + self.window.len()];
        for ((into, sample), weight) in self.input.iter_mut().zip(frame).zip(&self.window) {
            *into = T::from(*sample) * *weight;
        }
        self.input[self.window.len()..].fill(T::zero());
        // the plan made the three buffers, so that their lengths are right
        let is_done = self.plan.process_with_scratch(&mut self.input, &mut self.output, &mut self.scratch);
        debug_assert!(is_done.is_ok());
        for (into, bin) in self.power.iter_mut().zip(&self.output) {
            *into = bin.norm_sqr().into() * self.power_scale;
        }
    }
}

fn hop_samples(hop_s: f64, sample_rate_hz: f64) -> usize {
    ((hop_s * sample_rate_hz).round() as usize).max(1)
}

/// The smallest multiple of `step` that is at least `length` and has only the prime factors 2, 3 and 5: the FFT of such a length
/// is fast. `step` must have no other prime factor either: no multiple of it would qualify, and the search would not end.
pub fn smooth_at_least(length: usize, step: usize) -> usize {
    let is_smooth = |mut n: usize| {
        for factor in [2, 3, 5] {
            while n.is_multiple_of(factor) {
                n /= factor;
            }
        }
        n == 1
    };
    let first = length.max(step).next_multiple_of(step);
    (first..).step_by(step).find(|&n| is_smooth(n)).unwrap_or(first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn frames(signal: &[f32], stft: &mut Stft, block: usize) -> Vec<(f64, Vec<f64>)> {
        let mut frames = Vec::new();
        stft.restart(0.0);
        for block in signal.chunks(block) {
            stft.push(block, |frame| frames.push((frame.centre_s, frame.power.to_vec())));
        }
        frames
    }

    fn noise(count: usize) -> Vec<f32> {
        let mut state = 1u64;
        (0..count)
            .map(|_| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                ((state >> 40) as f32 / (1u64 << 23) as f32) - 1.0
            })
            .collect()
    }

    #[test]
    fn a_frame_is_the_definition_of_its_spectrum() {
        let signal = noise(1500);
        let mut stft = Stft::<f64>::new(1000.0, Window::Hann, 0.2, 0.07, 2);
        let got = frames(&signal, &mut stft, 1500);
        assert_eq!(got.len(), (1500 - 200) / 70 + 1);
        let window = Window::Hann.values(200);
        for (m, (centre_s, power)) in got.iter().enumerate() {
            assert!((centre_s - (m as f64 * 0.07 + 0.1)).abs() < 1e-12);
            let windowed: Vec<f64> =
                (0..400).map(|n| if n < 200 { f64::from(signal[m * 70 + n]) * window[n] } else { 0.0 }).collect();
            let oracle = dft::dft_power(&windowed);
            let scale = (2.0 / window.iter().sum::<f64>()).powi(2);
            for (k, (got, want)) in power.iter().zip(&oracle).enumerate() {
                assert!((got - want * scale).abs() < 1e-12, "frame {m}, bin {k}: {got} {want}");
            }
        }
    }

    #[test]
    fn blocks_of_any_size_give_the_same_frames() {
        let signal = noise(5000);
        let mut stft = Stft::<f64>::new(1000.0, Window::Hann, 0.2, 0.3, 1);
        let whole = frames(&signal, &mut stft, 5000);
        for block in [1, 7, 199, 200, 201, 1024] {
            let got = frames(&signal, &mut stft, block);
            assert_eq!(got.len(), whole.len(), "blocks of {block}");
            for (got, whole) in got.iter().zip(&whole) {
                assert!((got.0 - whole.0).abs() < 1e-9, "blocks of {block}");
                assert_eq!(got.1, whole.1, "blocks of {block}");
            }
        }
    }

    #[test]
    fn a_sine_of_full_scale_peaks_at_one() {
        let signal: Vec<f32> = (0..2000).map(|n| (TAU * 100.0 * n as f64 / 1000.0).sin() as f32).collect();
        for window in [Window::Hann, Window::Hamming, Window::Blackman, Window::Rectangular] {
            let mut stft = Stft::<f64>::new(1000.0, window, 0.5, 0.5, 1);
            let bin = (100.0 / stft.bin_hz()).round() as usize;
            for (_, power) in frames(&signal, &mut stft, 256) {
                assert!((power[bin] - 1.0).abs() < 1e-6, "{window:?}: {}", power[bin]);
            }
        }
    }

    #[test]
    fn lengths_of_transforms_are_smooth_and_even() {
        assert_eq!(smooth_at_least(8820, 2), 9000);
        assert_eq!(smooth_at_least(9600, 2), 9600);
        assert_eq!(smooth_at_least(0, 2), 2);
        assert_eq!(smooth_at_least(77, 2), 80);
        assert_eq!(smooth_at_least(33, 16), 48);
    }
}
