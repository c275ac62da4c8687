//! The lines of a piece of sound along a path: in each frame, how well a shift of the path explains the sound.

use super::lines::TrackedLines;
use crate::harmonic::frame_transform::FrameTransform;
use hovertone_signal::fft::ComplexPlanner;
use hovertone_signal::spectrogram::smooth_at_least;
use hovertone_signal::statistics::median;
use realfft::num_complex::Complex;
use std::f64::consts::{LN_2, TAU};

/// Largest shift, as a share of the speed: the first path is nearer. *Decision.*
const SHIFT_SHARE_MAX: f64 = 0.06;
/// Steps of the shift within the resolution of a frame at the highest line. *Numeric.*
const SHIFTS_PER_CELL: f64 = 4.0;
/// Lowest rate of a line's signal along the path: in a frame of 30 ms it has 45 values. *Numeric.*
const LINE_RATE_HZ_MIN: f64 = 1500.0;
/// Rate of a line's signal, in widths of the shifts. *Numeric.*
const LINE_RATE_WIDTHS: f64 = 2.0;
/// Zero padding of the frames' transforms: between two bins the power is nearly straight. *Numeric.*
const ZERO_PAD_FACTOR: usize = 4;
/// Orders from a line at which the floor is measured: halfway between the lines of the shaft. *Physics.*
const FLOOR_ORDERS: [f64; 2] = [-0.5, 0.5];

/// A stretch of sound in memory.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sound<'a> {
    pub(super) samples: &'a [f32],
    pub(super) start_s: f64,
}

/// How frames are cut from lines along a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameGrid {
    lines: TrackedLines,
    sample_rate_hz: f64,
    /// Audio samples of one value of a line's signal.
    value_samples: usize,
    /// Values of a frame and of a hop.
    frame_values: usize,
    hop_values: usize,
    /// Steps of the shift on either side of 0.
    half_shifts: usize,
    /// Step of the shift, as a share of the speed.
    pub(super) shift_share: f64,
}

impl FrameGrid {
    pub(super) fn new(lines: &TrackedLines, sample_rate_hz: f64) -> Self {
        let rate_hz = LINE_RATE_HZ_MIN.max(LINE_RATE_WIDTHS * 2.0 * SHIFT_SHARE_MAX * lines.hz_max);
        let value_samples = ((sample_rate_hz / rate_hz) as usize).max(1);
        let value_s = value_samples as f64 / sample_rate_hz;
        let shift_share = 1.0 / (SHIFTS_PER_CELL * lines.frame_s * lines.hz_max);
        Self {
            lines: *lines,
            sample_rate_hz,
            value_samples,
            frame_values: smooth_at_least((lines.frame_s / value_s).round() as usize, 2),
            hop_values: ((lines.hop_s / value_s).round() as usize).max(1),
            half_shifts: (SHIFT_SHARE_MAX / shift_share).ceil() as usize,
            shift_share,
        }
    }

    fn value_s(&self) -> f64 {
        self.value_samples as f64 / self.sample_rate_hz
    }

    pub(super) fn frame_s(&self) -> f64 {
        self.frame_values as f64 * self.value_s()
    }

    pub(super) fn hop_s(&self) -> f64 {
        self.hop_values as f64 * self.value_s()
    }

    /// Audio samples of a hop.
    pub(super) fn hop_samples(&self) -> usize {
        self.hop_values * self.value_samples
    }

    /// Frames in a number of audio samples.
    pub(super) fn frame_count(&self, sample_count: usize) -> usize {
        let values = sample_count / self.value_samples;
        if values < self.frame_values { 0 } else { (values - self.frame_values) / self.hop_values + 1 }
    }

    /// Middle of a frame.
    pub(super) fn centre_s(&self, start_s: f64, frame: usize) -> f64 {
        start_s + frame as f64 * self.hop_s() + 0.5 * self.frame_s()
    }
}

/// In each frame, the score of each shift of the path: Σ ln(1 + power over floor) over the lines.
pub(super) fn shift_scores(grid: &FrameGrid, sound: &Sound<'_>, path_rev_s: &dyn Fn(f64) -> f64) -> Vec<Vec<f64>> {
    let frame_count = grid.frame_count(sound.samples.len());
    let centres_rev_s: Vec<f64> =
        (0..frame_count).map(|frame| path_rev_s(grid.centre_s(sound.start_s, frame))).collect();
    let fastest_rev_s = centres_rev_s.iter().copied().fold(0.0, f64::max);
    let mut scores = vec![vec![0.0; 2 * grid.half_shifts + 1]; frame_count];
    let mut line = LineSignal::new(grid, sound, path_rev_s);
    let mut transform = FrameTransform::new(grid.frame_values, ZERO_PAD_FACTOR, &mut ComplexPlanner::new());
    for number in 1..=grid.lines.count_at(fastest_rev_s).max(1) {
        let values = line.next();
        let order = grid.lines.order * f64::from(number);
        add_line(grid, &mut transform, &values, order, &centres_rev_s, &mut scores);
    }
    scores
}

/// The signals of the lines along the path, one after the other.
struct LineSignal<'a> {
    samples: &'a [f32],
    value_samples: usize,
    /// One turn of the first line at each audio sample, backwards, and that of the line at hand.
    first: Vec<Complex<f32>>,
    turned: Vec<Complex<f32>>,
}

impl<'a> LineSignal<'a> {
    fn new(grid: &FrameGrid, sound: &Sound<'a>, path_rev_s: &dyn Fn(f64) -> f64) -> Self {
        let value_count = sound.samples.len() / grid.value_samples;
        let mut first = Vec::with_capacity(sound.samples.len());
        let (mut turns, value_s) = (0.0, grid.value_s());
        for value in 0..value_count {
            // straight within a value
            let from_s = sound.start_s + value as f64 * value_s;
            let (from, to) = (path_rev_s(from_s), path_rev_s(from_s + value_s));
            for sample in 0..grid.value_samples {
                let share = (sample as f64 + 0.5) / grid.value_samples as f64;
                turns += (from + share * (to - from)) * grid.lines.order / grid.sample_rate_hz;
                turns = turns.fract();
                first.push(Complex::from_polar(1.0, (-TAU * turns) as f32));
            }
        }
        let turned = vec![Complex::new(1.0, 0.0); first.len()];
        Self { samples: sound.samples, value_samples: grid.value_samples, first, turned }
    }

    /// The next line, as means over the audio samples of each value.
    fn next(&mut self) -> Vec<Complex<f32>> {
        self.turned.iter_mut().zip(&self.first).for_each(|(turned, first)| *turned *= first);
        let parts = self.turned.chunks_exact(self.value_samples).zip(self.samples.chunks_exact(self.value_samples));
        let mean = |(turned, samples): (&[Complex<f32>], &[f32])| {
            turned.iter().zip(samples).map(|(turned, sample)| turned * sample).sum::<Complex<f32>>()
                / self.value_samples as f32
        };
        parts.map(mean).collect()
    }
}

fn add_line(
    grid: &FrameGrid,
    transform: &mut FrameTransform,
    values: &[Complex<f32>],
    order: f64,
    centres_rev_s: &[f64],
    scores: &mut [Vec<f64>],
) {
    let mut floors = Vec::with_capacity(2 * scores.len());
    let mut powers: Vec<Vec<f32>> = Vec::with_capacity(scores.len());
    for (frame, &speed_rev_s) in centres_rev_s.iter().enumerate() {
        let spectrum = transform.spectrum(&values[frame * grid.hop_values..]);
        let bins_per_order = speed_rev_s * grid.value_s() * spectrum.len() as f64;
        floors.extend(FLOOR_ORDERS.map(|beside| f64::from(power_at(spectrum, beside * bins_per_order))));
        let step = order * bins_per_order * grid.shift_share;
        let place = |at: usize| (at as f64 - grid.half_shifts as f64) * step;
        powers.push((0..2 * grid.half_shifts + 1).map(|at| power_at(spectrum, place(at))).collect());
    }
    let floor = (median(&floors).unwrap_or(0.0) / LN_2).max(f64::from(f32::MIN_POSITIVE)) as f32;
    for (scores, powers) in scores.iter_mut().zip(powers) {
        scores.iter_mut().zip(powers).for_each(|(score, power)| *score += f64::from((power / floor).ln_1p()));
    }
}

/// The power of a spectrum between two bins; places below 0 are negative frequencies.
fn power_at(spectrum: &[Complex<f32>], place: f64) -> f32 {
    let (whole, share) = (place.floor(), (place - place.floor()) as f32);
    let power = |bin: i64| spectrum[bin.rem_euclid(spectrum.len() as i64) as usize].norm_sqr();
    (1.0 - share) * power(whole as i64) + share * power(whole as i64 + 1)
}
