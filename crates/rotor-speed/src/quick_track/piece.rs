//! Pieces of sound, each long enough for a mean of its lines and short enough for memory: paths made better, and the track.

use super::aligned::{FrameGrid, Sound, shift_scores};
use super::lines::TrackedLines;
use super::offsets::{FrameShifts, frame_shifts};
use super::path::SpeedPath;
use super::{QuickStretch, QuickTrack};
use crate::thresholds::{CLEAR_NATS, HEARD_S_MIN};
use hovertone_signal::passes::StretchListener;
use hovertone_signal::spectrogram::hann_frequency_weight;
use hovertone_signal::statistics::mean;

/// Shortest and longest piece: a piece has a step with both its levels, and not much else, so that its lines are alike. *Decision.*
const PIECE_S_MIN: f64 = 2.0;
const PIECE_S_MAX: f64 = 4.0;
/// A piece ends where the path moves least within this time on both sides. *Decision.*
const QUIET_S: f64 = 0.3;
/// How often the path is made better: what is left of an error within a frame falls by half or more each time. *Numeric.*
const ROUNDS: usize = 3;
/// Places in a frame at which a path is seen. *Numeric.*
const SEEN_PLACES: u32 = 32;
/// Frames over which a better path is smoothed, against noise: half a frame's length. *Numeric.*
const SMOOTH_FRAMES: usize = 5;
/// Frames over which it is judged whether rotors are heard: three lengths of a frame. *Numeric.*
const JUDGED_FRAMES: usize = 30;
/// Smallest height of the lines over the noise in which rotors are heard, in nats: a path that follows the highest noise has 2.
const HEIGHT_MIN: f64 = CLEAR_NATS;
/// Shortest stretch: a step has two levels; beeps of an ESC are shorter.
const STRETCH_S_MIN: f64 = HEARD_S_MIN;

/// How near the given path is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Approach {
    /// Within some per cent: it is made better in rounds.
    FromAfar,
    /// Within the width of the lines.
    Near,
}

/// Takes in the sound and makes the track.
pub(super) struct PieceListener<'a> {
    grid: FrameGrid,
    path: &'a SpeedPath,
    approach: Approach,
    sample_rate_hz: f64,
    samples: Vec<f32>,
    start_s: f64,
    track: QuickTrack,
    /// Whether the last frame so far belongs to the last stretch.
    is_open: bool,
}

impl<'a> PieceListener<'a> {
    pub(super) fn new(lines: &TrackedLines, path: &'a SpeedPath, approach: Approach, sample_rate_hz: f64) -> Self {
        let grid = FrameGrid::new(lines, sample_rate_hz);
        Self {
            grid,
            path,
            approach,
            sample_rate_hz,
            samples: Vec::new(),
            start_s: 0.0,
            track: QuickTrack { frame_s: grid.frame_s(), stretches: Vec::new() },
            is_open: false,
        }
    }

    pub(super) fn finish(mut self) -> QuickTrack {
        self.take_piece(self.samples.len());
        self.track.stretches.retain(|stretch| match stretch.time_s.as_slice() {
            [first, .., last] => last - first >= STRETCH_S_MIN,
            _ => false,
        });
        self.track
    }

    /// Makes the track in a number of audio samples.
    fn take_piece(&mut self, sample_count: usize) {
        let sound = Sound { samples: &self.samples[..sample_count], start_s: self.start_s };
        let frame_count = self.grid.frame_count(sound.samples.len());
        if frame_count == 0 || self.path.time_s.is_empty() {
            return;
        }
        let speeds = match self.approach {
            Approach::FromAfar => speeds_from_afar(&self.grid, &sound, self.path),
            Approach::Near => speeds_near(&self.grid, &sound, self.path),
        };
        for (frame, heard) in speeds.into_iter().enumerate() {
            let time_s = self.grid.centre_s(self.start_s, frame);
            match heard {
                None => self.is_open = false,
                Some(speed_rev_s) => {
                    if !std::mem::replace(&mut self.is_open, true) {
                        self.track.stretches.push(QuickStretch::default());
                    }
                    if let Some(stretch) = self.track.stretches.last_mut() {
                        stretch.time_s.push(time_s);
                        stretch.speed_rev_s.push(speed_rev_s);
                    }
                }
            }
        }
        let used = frame_count * self.grid.hop_samples();
        self.samples.drain(..used);
        self.start_s += used as f64 / self.sample_rate_hz;
    }
}

impl PieceListener<'_> {
    /// How far the path moves around a time.
    fn moved_rev_s(&self, time_s: f64) -> f64 {
        (self.path.at(time_s + QUIET_S) - self.path.at(time_s - QUIET_S)).abs()
    }
}

impl StretchListener for PieceListener<'_> {
    fn restart(&mut self, start_s: f64, _length_s: f64) {
        self.start_s = start_s;
        self.samples.clear();
        self.is_open = false;
    }

    fn push(&mut self, samples: &[f32]) {
        if self.path.time_s.is_empty() {
            return;
        }
        self.samples.extend_from_slice(samples);
        let from = (PIECE_S_MIN * self.sample_rate_hz) as usize;
        let to = (PIECE_S_MAX * self.sample_rate_hz) as usize;
        while self.samples.len() >= to {
            let places = (from..=to).step_by(self.grid.hop_samples());
            let moved = |place: &usize| self.moved_rev_s(self.start_s + *place as f64 / self.sample_rate_hz);
            let end = places.min_by(|a, b| moved(a).total_cmp(&moved(b))).unwrap_or(to);
            self.take_piece(end);
        }
    }
}

/// The speed that each frame sees, near a path; `None` where no rotor is heard.
fn speeds_near(grid: &FrameGrid, sound: &Sound<'_>, path: &SpeedPath) -> Vec<Option<f64>> {
    let shifts = frame_shifts(&shift_scores(grid, sound, &|at_s| path.at(at_s)));
    let distances = shifts.slopes.iter().map(|slope| slope * grid.shift_share);
    heard_speeds(seen_speeds(grid, sound, path, distances), &shifts)
}

/// The same where the path is farther.
fn speeds_from_afar(grid: &FrameGrid, sound: &Sound<'_>, coarse: &SpeedPath) -> Vec<Option<f64>> {
    let frame_count = grid.frame_count(sound.samples.len());
    let margin = (grid.frame_s() / grid.hop_s()).ceil() as usize;
    // points at the middle of each frame, and beyond the first and the last
    let time_s = |point: usize| grid.centre_s(sound.start_s, point) - margin as f64 * grid.hop_s();
    let times_s: Vec<f64> = (0..frame_count + 2 * margin).map(time_s).collect();
    let mut path = SpeedPath { speed_rev_s: times_s.iter().map(|&at_s| coarse.at(at_s)).collect(), time_s: times_s };
    let (mut seen, mut shifts) = (Vec::new(), FrameShifts::default());
    for _ in 0..ROUNDS {
        shifts = frame_shifts(&shift_scores(grid, sound, &|at_s| path.at(at_s)));
        let distances = || shifts.steps.iter().map(|step| step * grid.shift_share);
        seen = seen_speeds(grid, sound, &path, distances());
        let own = &path.speed_rev_s[margin..margin + frame_count];
        let better: Vec<f64> = own.iter().zip(distances()).map(|(speed, share)| speed * (1.0 + share)).collect();
        path.speed_rev_s = smoothed_between(&better, margin);
    }
    heard_speeds(seen, &shifts)
}

/// The path as each frame sees it, and a distance from it as a share of the speed.
fn seen_speeds(
    grid: &FrameGrid,
    sound: &Sound<'_>,
    path: &SpeedPath,
    distances: impl Iterator<Item = f64>,
) -> Vec<f64> {
    let places = (0..SEEN_PLACES).map(|at| (f64::from(at) + 0.5) / f64::from(SEEN_PLACES) - 0.5);
    let weights: Vec<(f64, f64)> = places.map(|share| (share * grid.frame_s(), hann_frequency_weight(share))).collect();
    let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
    let seen = |(frame, distance): (usize, f64)| {
        let centre_s = grid.centre_s(sound.start_s, frame);
        let mean: f64 = weights.iter().map(|(offset_s, weight)| weight * path.at(centre_s + offset_s)).sum();
        mean / sum + distance * path.at(centre_s)
    };
    distances.enumerate().map(seen).collect()
}

/// A running mean, with the end values beyond both ends.
fn smoothed_between(speed_rev_s: &[f64], margin: usize) -> Vec<f64> {
    let last = speed_rev_s.len() as isize - 1;
    let half = (SMOOTH_FRAMES / 2) as isize;
    let at = |place: isize| speed_rev_s[place.clamp(0, last) as usize];
    let places = -(margin as isize)..speed_rev_s.len() as isize + margin as isize;
    places.map(|place| (place - half..=place + half).map(at).sum::<f64>() / SMOOTH_FRAMES as f64).collect()
}

/// The speeds where rotors are heard: where lines stand over the noise in the frames around.
fn heard_speeds(speeds: Vec<f64>, shifts: &FrameShifts) -> Vec<Option<f64>> {
    let heights = &shifts.heights;
    let is_heard = |frame: usize| {
        let from = frame.saturating_sub(JUDGED_FRAMES / 2);
        let to = (frame + JUDGED_FRAMES / 2).min(heights.len());
        mean(&heights[from..to]).is_some_and(|height| height > HEIGHT_MIN)
    };
    speeds.into_iter().enumerate().map(|(frame, speed)| is_heard(frame).then_some(speed)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tone::ToneConfig;
    use hovertone_vehicle::Order;

    #[test]
    fn along_a_path_without_points_nothing_is_heard() {
        let rate_hz = 8000.0;
        let lines = TrackedLines::of_heard(&ToneConfig::of_order(Order::new(2.0).unwrap()), 60.0, rate_hz);
        let path = SpeedPath::default();
        let mut pieces = PieceListener::new(&lines, &path, Approach::Near, rate_hz);
        pieces.restart(0.0, 6.0);
        // longer than the longest piece
        let sound = vec![0.1; 48_000];
        pieces.push(&sound);
        assert!(pieces.finish().stretches.is_empty());
    }
}
