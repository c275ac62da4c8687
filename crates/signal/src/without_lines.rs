//! A source → the same source without lines of constant frequency, such as mains hum. The number of samples and their times stay.
//!
//! Frames of 2 s under a Blackman–Harris window (Harris, Proc. IEEE 66, 1978) overlap by three quarters, so that the windows add up to a
//! constant. Of each frame, the bins within the main lobe of each line are transformed back; what they add up to is subtracted. A line is
//! more than 70 dB weaker afterwards, but for a second at the ends, and all sound further than 2 Hz from the lines is unchanged.

use crate::spectrogram::smooth_at_least;
use crate::{SignalSource, SourceError};
use hovertone_fft::{TransformNumber, real_inverse};
use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealToComplex};
use std::f64::consts::TAU;
use std::ops::Range;
use std::sync::Arc;

/// Length of a frame, s. *Numeric.*
const FRAME_S: f64 = 2.0;
/// Frames that overlap at each sample. *Numeric.*
const OVERLAP: usize = 4;
/// Cosine terms of the Blackman–Harris window. *Physics.*
const WINDOW_TERMS: [f64; 4] = [0.35875, -0.48829, 0.14128, -0.01168];
/// Half of the width of its main lobe, in bins. *Physics.*
const LOBE_BINS: f64 = 4.0;
/// How far a line may move within a recording, as a share of its frequency. *Numeric.*
const DRIFT_SHARE: f64 = 0.0003;
/// Length of the sound that continues the recording before its start and after its end, s. *Numeric.*
const CONTINUED_S: f64 = 1.0;

/// Lines of constant frequency at multiples of one frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyLines {
    /// The frequency whose multiples the lines are.
    pub fundamental_hz: f64,
    /// The lines, from low to high.
    pub lines_hz: Vec<f64>,
}

impl SteadyLines {
    /// Whether a frequency is among those that are left out with the lines.
    pub fn hold(&self, hz: f64) -> bool {
        self.lines_hz.iter().any(|line_hz| (hz - line_hz).abs() <= half_width_hz(*line_hz))
    }
}

/// Half of the width of what is left out with a line, Hz.
fn half_width_hz(line_hz: f64) -> f64 {
    LOBE_BINS / FRAME_S + DRIFT_SHARE * line_hz
}

/// Takes lines out of a source, pass after pass.
pub(crate) struct LineFilter {
    plan: Arc<dyn RealToComplex<f32>>,
    back: Arc<dyn ComplexToReal<f32>>,
    /// The window, with the scale of both transforms and of the overlap.
    window: Vec<f32>,
    /// The bins of the lines.
    bins: Vec<Range<usize>>,
    /// Length by which the sound is shifted to continue it: whole periods of the fundamental.
    continued_samples: usize,
    frame: Vec<f32>,
    spectrum: Vec<Complex<f32>>,
    kept: Vec<Complex<f32>>,
    lines: Vec<f32>,
    scratch: Vec<Complex<f32>>,
    back_scratch: Vec<Complex<f32>>,
}

impl LineFilter {
    pub(crate) fn new(lines: &SteadyLines, sample_rate_hz: f64) -> Self {
        let length = smooth_at_least((FRAME_S * sample_rate_hz).round() as usize, 2 * OVERLAP);
        let (plan, back) = (f32::real_forward(length), real_inverse(length));
        let bin_hz = sample_rate_hz / length as f64;
        let scale = 1.0 / (WINDOW_TERMS[0] * (OVERLAP * length) as f64);
        let weight = |n: usize| {
            let turn = TAU * n as f64 / length as f64;
            WINDOW_TERMS.iter().enumerate().map(|(k, a)| a * (turn * k as f64).cos()).sum::<f64>() * scale
        };
        let period = sample_rate_hz / lines.fundamental_hz;
        let count = ((CONTINUED_S * lines.fundamental_hz).round() as usize).max(1);
        // of some numbers of periods, the one that is nearest to a whole number of samples
        let off = |periods: usize| (periods as f64 * period - (periods as f64 * period).round()).abs();
        let periods = (count / 2 + 1..=count).min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(1);
        let first = |hz: f64| ((hz - half_width_hz(hz)) / bin_hz).ceil().max(0.0) as usize;
        let last = |hz: f64| (((hz + half_width_hz(hz)) / bin_hz).floor() as usize).min(length / 2);
        Self {
            window: (0..length).map(|n| weight(n) as f32).collect(),
            bins: lines.lines_hz.iter().map(|&hz| first(hz)..last(hz) + 1).collect(),
            continued_samples: (periods as f64 * period).round() as usize,
            frame: plan.make_input_vec(),
            spectrum: plan.make_output_vec(),
            kept: back.make_input_vec(),
            lines: back.make_output_vec(),
            scratch: plan.make_scratch_vec(),
            back_scratch: back.make_scratch_vec(),
            plan,
            back,
        }
    }

    /// A source without the lines, at its first sample once it is rewound.
    pub(crate) fn over<'a>(&'a mut self, source: &'a mut dyn SignalSource) -> WithoutLines<'a> {
        WithoutLines {
            source,
            filter: self,
            pending: Vec::new(),
            sums: Vec::new(),
            start: None,
            is_at_end: false,
            out: Vec::new(),
        }
    }

    fn hop(&self) -> usize {
        self.window.len() / OVERLAP
    }

    /// Adds the lines of a frame to their sums.
    fn add_lines(&mut self, samples: &[f32], sums: &mut [f32]) {
        for ((into, sample), weight) in self.frame.iter_mut().zip(samples).zip(&self.window) {
            *into = sample * weight;
        }
        // the plans made these buffers, so that their lengths are right
        let is_done = self.plan.process_with_scratch(&mut self.frame, &mut self.spectrum, &mut self.scratch);
        self.kept.fill(Complex::default());
        for bins in self.bins.iter().filter(|bins| bins.start < bins.end) {
            self.kept[bins.clone()].copy_from_slice(&self.spectrum[bins.clone()]);
        }
        let is_back = self.back.process_with_scratch(&mut self.kept, &mut self.lines, &mut self.back_scratch);
        debug_assert!(is_done.is_ok() && is_back.is_ok());
        sums.iter_mut().zip(&self.lines).for_each(|(sum, line)| *sum += line);
    }
}

/// A source without lines.
pub(crate) struct WithoutLines<'a> {
    source: &'a mut dyn SignalSource,
    filter: &'a mut LineFilter,
    /// Samples from the start of the next frame on.
    pending: Vec<f32>,
    /// Sums of the lines at the same samples, as far as frames have covered them.
    sums: Vec<f32>,
    /// Pending samples that lie before the first sample of the source. `None` before the first frame.
    start: Option<usize>,
    is_at_end: bool,
    out: Vec<f32>,
}

impl WithoutLines<'_> {
    /// Reads until a frame is complete, or to the end.
    fn fill(&mut self) -> Result<(), SourceError> {
        let length = self.filter.window.len();
        while !self.is_at_end && self.pending.len() < 2 * length {
            match self.source.next_block()? {
                Some(block) => self.pending.extend_from_slice(block),
                None => {
                    self.is_at_end = true;
                    self.continue_after_end();
                }
            }
        }
        if self.start.is_none() {
            self.start = Some(self.continue_before_start());
        }
        Ok(())
    }

    /// Samples before the first one: the sound shifted by whole periods of the fundamental, in which the lines keep their phase.
    fn continue_before_start(&mut self) -> usize {
        let before = self.filter.window.len() - self.filter.hop();
        let shift = self.filter.continued_samples.min(self.pending.len());
        let back = |ago: usize| shift.checked_sub(1).map_or(0.0, |last| self.pending[last - ago % shift]);
        let continued: Vec<f32> = (0..before).rev().map(back).collect();
        self.pending.splice(..0, continued);
        before
    }

    /// The same after the last sample.
    fn continue_after_end(&mut self) {
        let after = self.filter.window.len() - self.filter.hop();
        let end = self.pending.len();
        let shift = self.filter.continued_samples.min(end);
        for index in (end..end + after).filter(|_| shift > 0) {
            self.pending.push(self.pending[index - shift]);
        }
    }
}

impl SignalSource for WithoutLines<'_> {
    fn sample_rate_hz(&self) -> f64 {
        self.source.sample_rate_hz()
    }

    fn start_s(&self) -> f64 {
        self.source.start_s()
    }

    fn next_block(&mut self) -> Result<Option<&[f32]>, SourceError> {
        let (length, hop) = (self.filter.window.len(), self.filter.hop());
        self.out.clear();
        while self.out.is_empty() {
            self.fill()?;
            // what is left after the last sample are fewer samples than the sound was continued by
            if self.pending.len() <= length - hop {
                return Ok(None);
            }
            let end = if self.is_at_end { self.pending.len() - (length - hop) } else { hop };
            self.pending.resize(self.pending.len().max(length), 0.0);
            self.sums.resize(length, 0.0);
            self.filter.add_lines(&self.pending[..length], &mut self.sums);
            let from = self.start.map_or(0, |before| before.min(hop));
            self.start = self.start.map(|before| before - from);
            let to = end.min(hop).max(from);
            self.out
                .extend(self.pending[from..to].iter().zip(&self.sums[from..to]).map(|(sample, line)| sample - line));
            self.pending.drain(..hop);
            self.sums.drain(..hop);
        }
        Ok(Some(&self.out))
    }

    fn rewind(&mut self) -> Result<(), SourceError> {
        self.pending.clear();
        self.sums.clear();
        (self.start, self.is_at_end) = (None, false);
        self.source.rewind()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Signal;

    const RATE_HZ: f64 = 8000.0;

    fn sine(hz: f64, seconds: f64) -> Vec<f32> {
        (0..(seconds * RATE_HZ) as u32).map(|n| (TAU * hz * f64::from(n) / RATE_HZ).sin() as f32).collect()
    }

    fn without(samples: &[f32], lines: &SteadyLines) -> Vec<f32> {
        let mut source = Signal::new(samples.to_vec(), RATE_HZ);
        let mut filter = LineFilter::new(lines, RATE_HZ);
        let mut left = filter.over(&mut source);
        let mut passes: [Vec<f32>; 2] = Default::default();
        for pass in &mut passes {
            left.rewind().unwrap();
            while let Some(block) = left.next_block().unwrap() {
                pass.extend_from_slice(block);
            }
        }
        let [first, second] = passes;
        assert_eq!(first, second);
        first
    }

    fn rms(samples: &[f32]) -> f64 {
        (samples.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>() / samples.len() as f64).sqrt()
    }

    #[test]
    fn the_lines_are_gone_from_the_first_sample_to_the_last_and_the_rest_stays() {
        let hum = SteadyLines { fundamental_hz: 49.97, lines_hz: vec![49.97, 149.91, 499.7] };
        for seconds in [0.7, 2.0, 3.3, 11.0] {
            let rest = sine(163.0, seconds);
            let mut samples = rest.clone();
            for &hz in &hum.lines_hz {
                samples.iter_mut().zip(sine(hz, seconds)).for_each(|(sample, line)| *sample += line);
            }
            let left = without(&samples, &hum);
            assert_eq!(left.len(), rest.len(), "{seconds} s");
            let error: Vec<f32> = left.iter().zip(&rest).map(|(left, rest)| left - rest).collect();
            assert!(rms(&error) < 0.02, "{seconds} s: {}", rms(&error));
            let inner = (2.0 * RATE_HZ) as usize;
            if let Some(inside) = error.len().checked_sub(inner).filter(|end| *end > inner) {
                assert!(rms(&error[inner..inside]) < 3e-4, "{seconds} s: {}", rms(&error[inner..inside]));
            }
        }
    }

    #[test]
    fn a_source_without_samples_stays_one() {
        let hum = SteadyLines { fundamental_hz: 60.0, lines_hz: vec![60.0] };
        for samples in [&[][..], &[0.5], &[0.5; 100]] {
            assert_eq!(without(samples, &hum).len(), samples.len());
        }
    }
}
