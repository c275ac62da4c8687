//! A first path of the speed: the best path through the scores of a comb in short frames.

use super::lines::TrackedLines;
use super::path::SpeedPath;
use crate::harmonic::best_path::best_path;
use crate::thresholds::LINE_NATS_MAX;
use hovertone_signal::passes::StretchListener;
use hovertone_signal::spectrogram::{Stft, Window};
use hovertone_signal::statistics::median;

/// Step between frames: fast motors reach a speed in ten steps. *Numeric.*
const HOP_S: f64 = 0.01;
/// Ratio of neighbouring speeds, less one: half the width of a line of order 20 in frames of four turns. *Numeric.*
const GRID_SHARE: f64 = 0.01;
/// Standard deviation of the steps of a path, in grid points per frame: a motor with a time constant of 50 ms that steps by a sixth. *Physics.*
const STEP_STD: f64 = 3.0;
/// Score of a line far above the floor, in nats: a louder line tells no more of the speed. *Decision.*
const LINE_SCORE_MAX: f64 = 4.0;
/// Score of a line that is absent: half the speed has all lines and as many absent ones between them. *Decision.*
const ABSENT_SCORE: f64 = -1.0;
/// Largest height of a line, in nats, by which even and odd lines are compared.
const HEIGHT_MAX: f64 = LINE_NATS_MAX;
/// Even lines may be higher than odd ones by this, in nats; more is half the speed of a shaft whose own lines are heard. *Decision.*
const ALTERNATION_MAX: f64 = 3.0;
/// Width of the stretches of a spectrum whose median is the floor: wide against lines. *Decision.*
const FLOOR_HZ: f64 = 400.0;
/// Median power of noise over its mean: ln 2. *Physics.*
const MEDIAN_SHARE: f64 = std::f64::consts::LN_2;
/// Zero padding of the transforms. *Numeric.*
const ZERO_PAD_FACTOR: u32 = 4;
/// Frames whose path is sought at once, and frames at either end whose path is not used: they lack neighbours. *Numeric.*
const CHUNK_FRAMES: usize = 3000;
const MARGIN_FRAMES: usize = 100;

/// Takes in the sound and finds the path.
pub(super) struct CoarseListener {
    stft: Stft<f32>,
    comb: Comb,
    speeds_rev_s: Vec<f64>,
    /// Scores of the frames whose path is not final.
    scores: Vec<Vec<f64>>,
    times_s: Vec<f64>,
    /// Frames of them whose path is final, as they stand in a chunk before.
    done: usize,
    path: SpeedPath,
}

impl CoarseListener {
    pub(super) fn new(lines: &TrackedLines, sample_rate_hz: f64) -> Self {
        let count = ((lines.fastest_rev_s / lines.slowest_rev_s).ln() / GRID_SHARE) as i32 + 1;
        let speeds_rev_s: Vec<f64> =
            (0..count).map(|at| lines.slowest_rev_s * (GRID_SHARE * f64::from(at)).exp()).collect();
        let stft = Stft::new(sample_rate_hz, Window::Hann, lines.frame_s, HOP_S, ZERO_PAD_FACTOR);
        let comb = Comb::new(lines, &speeds_rev_s, stft.bin_hz());
        Self { stft, comb, speeds_rev_s, scores: Vec::new(), times_s: Vec::new(), done: 0, path: SpeedPath::default() }
    }

    pub(super) fn finish(mut self) -> SpeedPath {
        self.take_path(0);
        self.path
    }

    /// Finds the path of the frames at hand, and keeps it but for the last `margin` ones.
    fn take_path(&mut self, margin: usize) {
        let path = best_path(&self.scores, STEP_STD);
        let end = path.len().saturating_sub(margin);
        let is_final = self.done..end.max(self.done);
        self.path.time_s.extend_from_slice(&self.times_s[is_final.clone()]);
        self.path.speed_rev_s.extend(path[is_final].iter().map(|&point| self.speeds_rev_s[point]));
        let from = end.saturating_sub(margin);
        self.scores.drain(..from);
        self.times_s.drain(..from);
        self.done = end - from;
    }
}

impl StretchListener for CoarseListener {
    fn restart(&mut self, start_s: f64, _length_s: f64) {
        self.stft.restart(start_s);
    }

    fn push(&mut self, samples: &[f32]) {
        let Self { stft, comb, scores, times_s, .. } = self;
        stft.push(samples, |frame| {
            scores.push(comb.scores(frame.power));
            times_s.push(frame.centre_s);
        });
        if self.scores.len() >= CHUNK_FRAMES {
            self.take_path(MARGIN_FRAMES);
        }
    }
}

/// The bins of the lines of each speed.
struct Comb {
    bins: Vec<Vec<usize>>,
    floor_bins: usize,
    bin_count: usize,
}

impl Comb {
    fn new(lines: &TrackedLines, speeds_rev_s: &[f64], bin_hz: f64) -> Self {
        let bins_of = |&speed_rev_s: &f64| -> Vec<usize> {
            let bin = |line: u32| (f64::from(line) * lines.order * speed_rev_s / bin_hz).round() as usize;
            (1..=lines.count_at(speed_rev_s)).map(bin).collect()
        };
        let bin_count = (lines.hz_max / bin_hz) as usize + 2;
        Self {
            bins: speeds_rev_s.iter().map(bins_of).collect(),
            floor_bins: ((FLOOR_HZ / bin_hz) as usize).clamp(1, bin_count),
            bin_count,
        }
    }

    /// The score of each speed in a power spectrum.
    fn scores(&self, power: &[f64]) -> Vec<f64> {
        let power = &power[..self.bin_count.min(power.len())];
        let floors = power.chunks(self.floor_bins).map(|part| (median(part).unwrap_or(0.0) / MEDIAN_SHARE).ln());
        let floors: Vec<f64> = floors.collect();
        let height = |(bin, power): (usize, &f64)| {
            let over = power.ln() - floors[bin / self.floor_bins];
            if over.is_finite() { over.clamp(0.0, HEIGHT_MAX) } else { 0.0 }
        };
        let heights: Vec<f64> = power.iter().enumerate().map(height).collect();
        self.bins.iter().map(|bins| score_of(bins, &heights)).collect()
    }
}

/// The score of one speed, whose lines are at these bins, from the heights of all bins.
fn score_of(bins: &[usize], heights: &[f64]) -> f64 {
    let of_lines = || bins.iter().filter_map(|&bin| heights.get(bin).copied());
    let mean = |values: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
        if count > 0.0 { sum / count } else { 0.0 }
    };
    let (odd, even) = (mean(&mut of_lines().step_by(2)), mean(&mut of_lines().skip(1).step_by(2)));
    let alternation = (even - odd - ALTERNATION_MAX).max(0.0);
    of_lines().map(|height| height.min(LINE_SCORE_MAX) + ABSENT_SCORE - alternation).sum()
}
