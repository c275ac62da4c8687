//! Sound → one complex signal at a low rate for each spectral line: the input of the harmonic likelihood.
//!
//! A bank of band-pass filters in the frequency domain, by overlap-add (Allen, IEEE Trans. ASSP 25, 1977). Frames of 0.17 s
//! under a Hann window (Harris, Proc. IEEE 66, 1978), overlapping by half, are transformed. The bins around a line alone are
//! transformed back, and the results of overlapping frames are added. The windows add up to one, so that inside its band
//! a channel is the sound itself, shifted in frequency and decimated:
//!
//! `z_o(t) = A_o exp(j (o θ(t) + φ_o) − j 2π f_o t)`,
//!
//! where A_o and φ_o are amplitude and phase of the line of order o, θ is the angle of the shaft, and f_o is the centre
//! frequency of the channel.
//!
//! The side lobes of the window suppress a line outside the band by more than 70 dB.
//!
//! A gain that changes with frequency makes the noise of a channel white, where the noise of the sound falls or rises within the band. The gain is 1
//! at f_o.

use crate::spectrogram::{Window, smooth_at_least};
use hovertone_fft::{ComplexPlanner, TransformNumber};
use realfft::RealToComplex;
use realfft::num_complex::Complex;
use rustfft::Fft;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Length of a frame, s. It gives bins of 6 Hz, which resolve the lowest line, and is short against a hover. *Numeric.*
const FRAME_S: f64 = 0.17;
/// Bins beyond the wanted band on either side, for the main lobe of the window. *Numeric.*
const GUARD_BINS: usize = 4;
/// Smallest number of bins of a channel. *Numeric.*
const WIDTH_BINS_MIN: usize = 16;
/// Time over which a stretch of sound fades in and out, s: an abrupt edge would spread each line into the other channels.
/// *Numeric.*
const FADE_S: f64 = 0.03;

/// Number of ticks in a hop, where a hop is half a frame. A tick is a whole number of samples in every channel. *Numeric.*
pub const TICKS_PER_HOP: usize = 8;

/// The frequency band of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelBand {
    /// Order of the line: its frequency over the rotation rate of the shaft.
    pub order: f64,
    /// Whether the line is the first of its family: the blade pass or the gear mesh itself, and no multiple of it.
    pub is_first: bool,
    /// Lower edge of the band, Hz.
    pub band_hz_low: f64,
    /// Upper edge of the band, Hz.
    pub band_hz_high: f64,
    /// Fall of the noise from the lower edge of the band to the upper one, dB. The channel makes up for it.
    pub noise_fall_db: f64,
}

/// One channel of the bank.
pub struct Channel {
    /// Order of the line: its frequency over the rotation rate of the shaft.
    pub order: f64,
    /// Whether the line is the first of its family.
    pub is_first: bool,
    /// Centre frequency f_o, which becomes 0 Hz in the channel, Hz.
    pub centre_hz: f64,
    /// Complex samples per second.
    pub rate_hz: f64,
    /// Complex samples of one hop.
    pub hop_samples: usize,
    first_bin: i64,
    centre_bin: i64,
    /// Gain of each bin.
    gains: Vec<f32>,
    inverse: Arc<dyn Fft<f32>>,
    frame: Vec<Complex<f32>>,
    tail: Vec<Complex<f32>>,
}

/// Splits a stream of samples into channels. Holds the state of one stretch of sound without gaps.
pub struct ChannelBank {
    /// One channel for each band, in the order of the bands.
    pub channels: Vec<Channel>,
    sample_rate_hz: f64,
    window: Vec<f32>,
    plan: Arc<dyn RealToComplex<f32>>,
    pending: Vec<f32>,
    /// Samples of this stretch so far.
    taken_samples: u64,
    /// Number of the next frame of this stretch; −1 is the frame before the first full one.
    frame_index: i64,
    input: Vec<f32>,
    output: Vec<Complex<f32>>,
    scratch: Vec<Complex<f32>>,
    inverse_scratch: Vec<Complex<f32>>,
}

impl ChannelBank {
    /// A bank with one channel for each band.
    pub fn new(sample_rate_hz: f64, bands: &[ChannelBand]) -> Self {
        let frame_samples = smooth_at_least((FRAME_S * sample_rate_hz).round() as usize, 4);
        let plan = f32::real_forward(frame_samples);
        let bin_hz = sample_rate_hz / frame_samples as f64;
        let mut planner = ComplexPlanner::new();
        let channels: Vec<Channel> = bands.iter().map(|band| Channel::new(band, bin_hz, &mut planner)).collect();
        let scratch_len = channels.iter().map(|channel| channel.inverse.get_inplace_scratch_len()).max().unwrap_or(0);
        Self {
            channels,
            sample_rate_hz,
            window: Window::Hann.values(frame_samples).into_iter().map(|weight| weight as f32).collect(),
            pending: Vec::new(),
            taken_samples: 0,
            frame_index: 0,
            input: plan.make_input_vec(),
            output: plan.make_output_vec(),
            scratch: plan.make_scratch_vec(),
            inverse_scratch: vec![Complex::default(); scratch_len],
            plan,
        }
    }

    /// Length of a hop, half a frame, s.
    pub fn hop_s(&self) -> f64 {
        (self.window.len() / 2) as f64 / self.sample_rate_hz
    }

    /// Begins a new stretch of sound.
    pub fn restart(&mut self) {
        self.pending.clear();
        // half a frame of zeros before the first sample, so that the windows add up to one from there on
        self.pending.resize(self.window.len() / 2, 0.0);
        self.taken_samples = 0;
        self.frame_index = -1;
        for channel in &mut self.channels {
            channel.tail.fill(Complex::default());
        }
    }

    /// Takes in samples and appends the channel samples of every hop that they complete to `series`, one vector for each channel.
    pub fn push(&mut self, samples: &[f32], series: &mut [Vec<Complex<f32>>]) {
        let fade_samples = self.fade_samples();
        let faded_samples = usize::try_from(self.taken_samples).map_or(fade_samples, |taken| taken.min(fade_samples));
        let (fading, whole) = samples.split_at(samples.len().min(fade_samples - faded_samples));
        self.pending.extend(fading.iter().zip(faded_samples..).map(|(sample, n)| sample * fade(n, fade_samples)));
        self.pending.extend_from_slice(whole);
        self.taken_samples += samples.len() as u64;
        // the last samples wait: they fade out if the stretch ends here
        self.take_frames(fade_samples, series);
    }

    /// Ends the stretch: fades out its last samples and appends the rest of each channel to `series`.
    pub fn finish(&mut self, series: &mut [Vec<Complex<f32>>]) {
        if self.taken_samples == 0 {
            return;
        }
        let fade_samples = self.fade_samples().min(self.pending.len());
        let from = self.pending.len() - fade_samples;
        for (index, sample) in self.pending[from..].iter_mut().enumerate() {
            *sample *= fade(fade_samples - 1 - index, fade_samples);
        }
        // zeros follow, so that the last sample passes through both of its frames
        self.pending.resize(self.pending.len() + self.window.len(), 0.0);
        self.take_frames(0, series);
        self.taken_samples = 0;
    }

    fn fade_samples(&self) -> usize {
        (FADE_S * self.sample_rate_hz).round() as usize
    }

    fn take_frames(&mut self, keep_samples: usize, series: &mut [Vec<Complex<f32>>]) {
        let (frame_samples, hop_samples) = (self.window.len(), self.window.len() / 2);
        let mut start = 0;
        while start + frame_samples + keep_samples <= self.pending.len() {
            for ((into, sample), weight) in self.input.iter_mut().zip(&self.pending[start..]).zip(&self.window) {
                *into = sample * weight;
            }
            // the plan made the buffers, so that their lengths are right
            let is_done = self.plan.process_with_scratch(&mut self.input, &mut self.output, &mut self.scratch);
            debug_assert!(is_done.is_ok());
            for (channel, series) in self.channels.iter_mut().zip(series.iter_mut()) {
                channel.add_frame(&self.output, self.frame_index, frame_samples, series, &mut self.inverse_scratch);
            }
            self.frame_index += 1;
            start += hop_samples;
        }
        self.pending.drain(..start);
    }
}

impl Channel {
    fn new(band: &ChannelBand, bin_hz: f64, planner: &mut ComplexPlanner) -> Self {
        let middle_hz = (band.band_hz_low + band.band_hz_high) / 2.0;
        let centre_bin = (middle_hz / bin_hz).round() as i64;
        let half_bins = ((band.band_hz_high - middle_hz) / bin_hz).ceil() as usize + GUARD_BINS;
        let width = smooth_at_least((2 * half_bins).max(WIDTH_BINS_MIN), 2 * TICKS_PER_HOP);
        let first_bin = centre_bin - width as i64 / 2;
        let gain = |bin: i64| {
            let hz = (bin as f64 * bin_hz).clamp(band.band_hz_low, band.band_hz_high);
            let share = (hz - centre_bin as f64 * bin_hz) / (band.band_hz_high - band.band_hz_low);
            10f64.powf(band.noise_fall_db / 10.0 * share / 2.0) as f32
        };
        Self {
            order: band.order,
            is_first: band.is_first,
            centre_hz: centre_bin as f64 * bin_hz,
            rate_hz: width as f64 * bin_hz,
            hop_samples: width / 2,
            first_bin,
            centre_bin,
            gains: (first_bin..).take(width).map(gain).collect(),
            inverse: planner.inverse(width),
            frame: vec![Complex::default(); width],
            tail: vec![Complex::default(); width / 2],
        }
    }

    /// Adds one frame of the sound and appends the half frame that it completes.
    fn add_frame(
        &mut self,
        spectrum: &[Complex<f32>],
        frame_index: i64,
        frame_samples: usize,
        series: &mut Vec<Complex<f32>>,
        scratch: &mut [Complex<f32>],
    ) {
        let width = self.frame.len();
        // factor 2 for the positive frequencies alone; the sign refers the phase to the start of the stretch
        let sign = if (self.centre_bin * frame_index).rem_euclid(2) == 1 { -1.0 } else { 1.0 };
        let scale = sign * 2.0 / frame_samples as f32;
        let (rising, negative) = self.frame.split_at_mut(width / 2);
        for ((into, gain), bin) in negative.iter_mut().chain(rising).zip(&self.gains).zip(self.first_bin..) {
            // bin 0 holds the offset of the converter
            *into = match usize::try_from(bin) {
                Ok(bin) if bin > 0 => spectrum.get(bin).copied().unwrap_or_default() * (scale * gain),
                _ => Complex::default(),
            };
        }
        self.inverse.process_with_scratch(&mut self.frame, scratch);
        let (first, second) = self.frame.split_at(width / 2);
        if frame_index >= 0 {
            series.extend(first.iter().zip(&self.tail).map(|(new, old)| new + old));
        }
        self.tail.copy_from_slice(second);
    }
}

/// Raised cosine from 0 to 1 over `length` samples.
fn fade(index: usize, length: usize) -> f32 {
    let share = (index as f64 + 0.5) / length.max(1) as f64;
    (0.5 - 0.5 * (TAU / 2.0 * share).cos()) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_channel_is_the_line_itself_shifted_to_its_middle() {
        let (rate, hz, amplitude, phase) = (48000.0, 4162.7, 0.3, 0.7);
        let samples: Vec<f32> = (0..96000)
            .map(|n| {
                let t = f64::from(n) / rate;
                // a line of another sound well outside the band, ten times as strong
                (amplitude * (TAU * hz * t + phase).cos() + 10.0 * amplitude * (TAU * 3000.0 * t).cos()) as f32
            })
            .collect();
        let band =
            ChannelBand { order: 69.0, is_first: true, band_hz_low: 3820.0, band_hz_high: 4480.0, noise_fall_db: 0.0 };
        let mut bank = ChannelBank::new(rate, &[band]);
        for block in [7, 1000, 65536] {
            let mut series = vec![Vec::new()];
            bank.restart();
            samples.chunks(block).for_each(|samples| bank.push(samples, &mut series));
            bank.finish(&mut series);
            let channel = &bank.channels[0];
            assert!((series[0].len() as f64 / channel.rate_hz - 2.0).abs() < 0.2);
            let mut worst = 0.0f64;
            for (p, z) in series[0].iter().enumerate() {
                let t = p as f64 / channel.rate_hz;
                if (0.1..1.9).contains(&t) {
                    let turn = TAU * (hz - channel.centre_hz) * t + phase;
                    let want = Complex::new(amplitude * turn.cos(), amplitude * turn.sin());
                    worst = worst.max((Complex::new(f64::from(z.re), f64::from(z.im)) - want).norm() / amplitude);
                }
            }
            assert!(worst < 1e-3, "blocks of {block}: {worst}");
        }
    }

    #[test]
    fn a_channel_makes_up_for_noise_that_falls() {
        let (rate, low_hz, high_hz, fall_db) = (48000.0, 3000.0, 5000.0, 20.0);
        let band = ChannelBand {
            order: 1.0,
            is_first: true,
            band_hz_low: low_hz,
            band_hz_high: high_hz,
            noise_fall_db: fall_db,
        };
        // three lines that fall as the noise does
        let lines = [0.1, 0.5, 0.9].map(|share: f64| {
            let hz = low_hz + share * (high_hz - low_hz);
            (hz, 10f64.powf(fall_db * (0.5 - share) / 20.0))
        });
        let samples: Vec<f32> = (0..96000)
            .map(|n| {
                let t = f64::from(n) / rate;
                lines.iter().map(|(hz, amplitude)| amplitude * (TAU * hz * t).cos()).sum::<f64>() as f32
            })
            .collect();
        let mut bank = ChannelBank::new(rate, &[band]);
        let mut series = vec![Vec::new()];
        bank.restart();
        bank.push(&samples, &mut series);
        bank.finish(&mut series);
        let channel = &bank.channels[0];
        for (hz, _) in lines {
            let turned = |(n, z): (usize, &Complex<f32>)| {
                let turn = TAU * (hz - channel.centre_hz) * n as f64 / channel.rate_hz;
                Complex::new(f64::from(z.re), f64::from(z.im)) * Complex::from_polar(1.0, -turn)
            };
            let amplitude =
                series[0].iter().enumerate().map(turned).sum::<Complex<f64>>().norm() / (2.0 * channel.rate_hz);
            assert!((amplitude - 1.0).abs() < 0.03, "{hz}: {amplitude}");
        }
    }
}
