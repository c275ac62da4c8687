//! The complex spectrum of a frame of one channel, under a Hann window (Harris, Proc. IEEE 66, 1978).

use hovertone_signal::fft::ComplexPlanner;
use hovertone_signal::spectrogram::hann_weights;
use realfft::num_complex::Complex;
use rustfft::Fft;
use std::sync::Arc;

/// Fourier transform of frames of one length.
pub(crate) struct FrameTransform {
    plan: Arc<dyn Fft<f32>>,
    window: Vec<f32>,
    /// Σ w² of the window.
    pub(crate) energy: f64,
    frame: Vec<Complex<f32>>,
    scratch: Vec<Complex<f32>>,
}

impl FrameTransform {
    /// Frames of `length` samples, padded with zeros to `zero_pad_factor` times the length.
    pub(crate) fn new(length: usize, zero_pad_factor: usize, planner: &mut ComplexPlanner) -> Self {
        let plan = planner.forward(zero_pad_factor * length);
        let window: Vec<f32> = hann_weights(length).map(|weight| weight as f32).collect();
        Self {
            energy: window.iter().map(|&w| f64::from(w).powi(2)).sum(),
            window,
            frame: vec![Complex::default(); zero_pad_factor * length],
            scratch: vec![Complex::default(); plan.get_inplace_scratch_len()],
            plan,
        }
    }

    /// Samples of a frame, without padding.
    pub(crate) fn length(&self) -> usize {
        self.window.len()
    }

    /// Spectrum of the first frame of `series`: frequency 0 first, then rising, then the negative frequencies.
    pub(crate) fn spectrum(&mut self, series: &[Complex<f32>]) -> &[Complex<f32>] {
        for ((into, z), weight) in self.frame.iter_mut().zip(series).zip(&self.window) {
            *into = z * weight;
        }
        self.frame[self.window.len()..].fill(Complex::default());
        self.plan.process_with_scratch(&mut self.frame, &mut self.scratch);
        &self.frame
    }
}
