//! Spectra of short frames, to be read at any frequency, and the power of the noise between the lines.

use hovertone_signal::fft::TransformNumber;
use hovertone_signal::spectrogram::{hann_weights, smooth_at_least};
use hovertone_signal::statistics::median;
use realfft::RealToComplex;
use realfft::num_complex::Complex;
use std::f64::consts::PI;
use std::sync::Arc;

/// Length of a frame, in s: separates lines two resolution cells, 5 Hz, apart, and is about as long as a motor's run-up. *Decision.*
pub(super) const FRAME_S: f64 = 0.4;
/// Time between the middles of two frames, in s: a Hann window overlaps by three quarters. *Numeric.*
pub(super) const HOP_S: f64 = 0.1;
/// Zero padding: the spectrum has at least this number of bins per resolution cell; linear interpolation between them is off by 0.3 % at
/// most. *Numeric.*
const BINS_PER_CELL: usize = 8;
/// Width of the bands in which the noise is taken as flat, in Hz. *Numeric.*
const NOISE_BAND_HZ: f64 = 250.0;
/// Lower quartile of the noise power in a bin over its mean: −ln 0.75, because the power is exponentially distributed. *Numeric.*
const QUARTILE_OVER_MEAN: f64 = 0.287_68;

type C = Complex<f64>;

/// Cuts sound into frames and keeps their spectra up to a frequency.
pub(super) struct FrameCollector {
    sample_rate_hz: f64,
    window: Vec<f64>,
    window_sum: f64,
    fft: Arc<dyn RealToComplex<f64>>,
    /// Audio samples from the start of the next frame on.
    pending: Vec<f32>,
    /// Audio samples from frame to frame.
    hop: usize,
    bin_hz: f64,
    /// Number of bins that are kept.
    bins: usize,
    start_s: f64,
    pub(super) frames: Vec<Frame>,
}

/// Spectrum of one frame: amplitudes of complex exponentials, half the amplitudes of sines, with the phases at the middle of the frame.
pub(super) struct Frame {
    pub(super) middle_s: f64,
    bin_hz: f64,
    spectrum: Vec<Complex<f32>>,
    /// Mean power of the noise in each band.
    noise: Vec<f64>,
}

impl FrameCollector {
    /// For frequencies up to `high_hz`; the first audio sample is at `start_s`.
    pub(super) fn new(sample_rate_hz: f64, start_s: f64, high_hz: f64) -> Self {
        let length = (FRAME_S * sample_rate_hz).round() as usize;
        let window: Vec<f64> = hann_weights(length).collect();
        let padded = smooth_at_least(BINS_PER_CELL * length, 2);
        let bin_hz = sample_rate_hz / padded as f64;
        Self {
            sample_rate_hz,
            window_sum: window.iter().sum(),
            window,
            fft: f64::real_forward(padded),
            pending: Vec::new(),
            hop: (HOP_S * sample_rate_hz).round() as usize,
            bin_hz,
            bins: ((high_hz / bin_hz) as usize + 2).min(padded / 2),
            start_s,
            frames: Vec::new(),
        }
    }

    pub(super) fn push(&mut self, samples: &[f32]) {
        self.pending.extend_from_slice(samples);
        let mut from = 0;
        while from + self.window.len() <= self.pending.len() {
            let frame = self.frame(from);
            self.frames.extend(frame);
            from += self.hop;
        }
        self.pending.drain(..from);
    }

    fn frame(&self, from: usize) -> Option<Frame> {
        let (length, padded) = (self.window.len(), self.fft.len());
        let mut input = self.fft.make_input_vec();
        // with the middle of the frame at 0 the phase changes slowly from bin to bin, which the interpolation needs
        for (n, weight) in self.window.iter().enumerate() {
            let place = (n + padded - length / 2) % padded;
            input[place] = weight / self.window_sum * f64::from(self.pending[from + n]);
        }
        let mut spectrum = self.fft.make_output_vec();
        self.fft.process(&mut input, &mut spectrum).ok()?;
        let spectrum: Vec<Complex<f32>> =
            spectrum[..self.bins].iter().map(|value| Complex::new(value.re as f32, value.im as f32)).collect();
        let per_band = ((NOISE_BAND_HZ / self.bin_hz) as usize).max(1);
        let noise = spectrum
            .chunks(per_band)
            .map(|band| {
                let mut power: Vec<f64> = band.iter().map(|value| f64::from(value.norm_sqr())).collect();
                let quarter = power.len() / 4;
                *power.select_nth_unstable_by(quarter, f64::total_cmp).1 / QUARTILE_OVER_MEAN
            })
            .collect();
        let count = self.frames.len() as f64;
        let middle_s = self.start_s + (count * self.hop as f64 + length as f64 / 2.0) / self.sample_rate_hz;
        Some(Frame { middle_s, bin_hz: self.bin_hz, spectrum, noise })
    }
}

impl Frame {
    /// The spectrum at any frequency, by linear interpolation.
    pub(super) fn at(&self, hz: f64) -> C {
        let place = (hz / self.bin_hz).max(0.0);
        let (bin, share) = (place as usize, place.fract());
        let value = |bin: usize| {
            self.spectrum.get(bin).map_or(C::default(), |value| C::new(f64::from(value.re), f64::from(value.im)))
        };
        value(bin) * (1.0 - share) + value(bin + 1) * share
    }

    /// Mean power of the noise at a frequency.
    pub(super) fn noise(&self, hz: f64) -> f64 {
        let per_band = ((NOISE_BAND_HZ / self.bin_hz) as usize).max(1);
        let band = (hz / self.bin_hz) as usize / per_band;
        self.noise.get(band).copied().unwrap_or(0.0)
    }
}

/// Median over frames of the power of the noise at a frequency.
pub(super) fn median_noise(frames: &[Frame], hz: f64) -> f64 {
    let all: Vec<f64> = frames.iter().map(|frame| frame.noise(hz)).collect();
    median(&all).unwrap_or(0.0).max(f64::MIN_POSITIVE)
}

/// Leakage of a line to a frequency `off_hz` away: the transform of a Hann window (Harris 1978), 1 at the line itself.
pub(super) fn leakage(off_hz: f64) -> f64 {
    let cells = off_hz * FRAME_S;
    let beside = 1.0 - cells * cells;
    if cells.abs() < 1e-6 {
        1.0
    } else if beside.abs() < 1e-6 {
        0.5
    } else {
        (PI * cells).sin() / (PI * cells) / beside
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A sine of amplitude 2 consists of exponentials of amplitude 1; beside its frequency the spectrum has the leakage.
    #[test]
    fn a_sine_has_its_amplitude_and_leakage_at_any_frequency() {
        let (rate_hz, hz) = (8000.0, 431.3);
        let mut frames = FrameCollector::new(rate_hz, 5.0, 1000.0);
        let sine = |n: usize| (2.0 * (TAU * hz * n as f64 / rate_hz).cos()) as f32;
        let samples: Vec<f32> = (0..8000).map(sine).collect();
        samples.chunks(700).for_each(|piece| frames.push(piece));
        assert_eq!(frames.frames.len(), 7);
        for (index, frame) in frames.frames.iter().enumerate() {
            let middle_s = HOP_S * index as f64 + FRAME_S / 2.0;
            assert!((frame.middle_s - 5.0 - middle_s).abs() < 1e-9);
            for off_hz in [-4.0, -2.5, 0.0, 1.1, 3.0] {
                // half a sample lies between the window's middle and the nearest sample
                let expected = C::from_polar(leakage(off_hz), TAU * hz * middle_s);
                assert!((frame.at(hz + off_hz) - expected).norm() < 0.01, "{index} {off_hz}");
            }
        }
    }

    #[test]
    fn the_noise_power_is_that_of_white_noise() {
        use rand::{RngExt, SeedableRng};
        let mut rng = rand_pcg::Pcg64::seed_from_u64(3);
        let mut frames = FrameCollector::new(8000.0, 0.0, 2000.0);
        let samples: Vec<f32> = (0..160_000).map(|_| rng.random_range(-1.0..1.0)).collect();
        frames.push(&samples);
        // σ² Σw² / (Σw)², with 1.5 cells for Hann
        let expected = 1.0 / 3.0 * 1.5 / (FRAME_S * 8000.0);
        let found = median_noise(&frames.frames, 700.0);
        assert!((found / expected - 1.0).abs() < 0.1, "{found} {expected}");
    }
}
