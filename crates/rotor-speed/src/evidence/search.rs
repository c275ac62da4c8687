//! The speeds with the most votes: a path in each window of speeds, and its multiples.

use super::companions::DISTANCE_MAX;
use super::excess::Excess;
use super::path::best_path;
use super::pauses::quiet_frames;
use super::rotor_lines::RotorLines;
use super::voice::Voice;
use super::votes::{VotePlaces, VoteTable, votes_of_frames};
use crate::thresholds::{CLEAR_NATS, MOST};
use hovertone_signal::statistics::{mean, median};
use std::ops::{Range, RangeInclusive};

/// Step of the logarithm of the speeds of the search: half the width of a line of a frame at the highest frequency. *Numeric.*
pub(super) const GRID_STEP: f64 = 1e-3;
/// Ratio of the ends of a window of speeds in which the best path is looked for: a rotor keeps within it in hover. *Decision.*
const WINDOW_RATIO: f64 = 1.6;
/// Ratio of the starts of neighbouring windows; they overlap, so that each path is well inside of one. *Numeric.*
const WINDOW_STEP_RATIO: f64 = 1.25;
/// Speeds of the hypotheses over the speed of each path: octaves, and families of three. *Decision.*
const FACTORS: [f64; 10] = [1.0, 0.5, 2.0, 1.0 / 3.0, 3.0, 0.25, 4.0, 2.0 / 3.0, 1.5, 4.0 / 3.0];
/// Largest difference of the logarithms of a speed and of an octave or family of another that is the same rotor's. *Numeric.*
const RELATED: f64 = 0.05;
/// An octave down, none, and one up. *Physics.*
const OCTAVES: [f64; 3] = [0.5, 1.0, 2.0];
/// Smallest share of the most votes that a rotor's path has, less some nats.
pub(super) const VOTES_SHARE_MIN: f64 = MOST;
/// These nats.
pub(super) const VOTES_NATS_APART: f64 = CLEAR_NATS;
/// Paths whose mean distance is at most this many points are one path. *Numeric.*
const SAME_POINTS: usize = 2;
/// Smallest difference of the logarithms of two speeds that is a jump: rotors of one vehicle, and a rotor in a manoeuvre, stay within it.
const JUMP_MIN: f64 = DISTANCE_MAX;
/// A comb that is slower by this factor is no voice beside a rotor: it has a line near any line of several rotors. *Decision.*
const SLOWER_MAX: f64 = 0.25;

/// The votes of all frames for all speeds of a rotor that makes these lines.
pub(super) struct Search {
    grid: SpeedGrid,
    /// `votes[frame][speed]`.
    votes: Vec<Vec<f32>>,
    /// The best path in each window of speeds.
    paths: Vec<Vec<usize>>,
    /// Whether each frame is one of the quieter ones.
    quiet_frames: Vec<bool>,
}

/// A path with all speeds multiplied by a factor.
#[derive(Clone, Debug)]
pub(super) struct Multiple {
    /// Index of the path.
    pub(super) path: usize,
    pub(super) factor: f64,
    pub(super) speeds_rev_s: Vec<f64>,
    /// Their mean.
    pub(super) speed_rev_s: f64,
    /// Median over the frames of the votes for it, in nats.
    pub(super) votes_nats: f64,
    /// The same over the quieter frames.
    pub(super) quiet_votes_nats: f64,
}

impl Search {
    /// `None` without frames.
    pub(super) fn of(excess: &Excess, lines: &RotorLines, speeds_rev_s: &RangeInclusive<f64>) -> Option<Self> {
        let bins = excess.frames.first()?.levels.len();
        let grid = SpeedGrid::of(speeds_rev_s);
        let table = VoteTable::of(lines);
        let places = VotePlaces::new(&grid.speeds_rev_s, &table, excess.bin_hz, bins);
        let votes = votes_of_frames(&excess.frames, &table, &places);
        let hops = excess.hops();
        let mut paths: Vec<Vec<usize>> =
            grid.windows().into_iter().map(|window| best_path(&votes, window, &hops, GRID_STEP)).collect();
        // the speed of a path along an end of the grid is outside of it
        if paths.iter().any(|path| !grid.is_at_end(path)) {
            paths.retain(|path| !grid.is_at_end(path));
        }
        Some(Self { grid, votes, paths, quiet_frames: quiet_frames(&excess.frames) })
    }

    /// The speeds along the best path of each window.
    pub(super) fn speeds_of_paths(&self) -> impl Iterator<Item = Vec<f64>> {
        self.paths.iter().map(|path| self.grid.speeds_of(path))
    }

    /// The paths at all factors. One with far fewer votes than the best is left out, unless it is an octave or a family of it: the lines of a
    /// rotor sound in most frames, but only the first harmonics vote, and of octaves the faster one has more of these. None where none has the
    /// least votes of a rotor.
    pub(super) fn multiples(&self, votes_nats_min: f64) -> Vec<Multiple> {
        let mut found: Vec<(Vec<usize>, Multiple)> = Vec::new();
        for factor in FACTORS {
            for (path, points) in self.paths.iter().enumerate() {
                let Some(points) = self.grid.times(points, factor) else { continue };
                if found.iter().any(|(other, _)| is_same_path(other, &points)) {
                    continue;
                }
                found.extend(self.multiple(path, factor, &points).map(|multiple| (points, multiple)));
            }
        }
        let most = found.iter().max_by(|(_, a), (_, b)| a.votes_nats.total_cmp(&b.votes_nats));
        let Some((_, most)) = most.filter(|(_, most)| most.votes_nats >= votes_nats_min) else { return Vec::new() };
        let least_nats = VOTES_SHARE_MIN * most.votes_nats - VOTES_NATS_APART;
        // beside the best one may be a path through the lines of several rotors
        let is_other_octave = |it: &Multiple| {
            is_family(it.speed_rev_s, most.speed_rev_s) && !is_at_ratio(it.speed_rev_s, most.speed_rev_s, 1.0)
        };
        let is_left = |it: &Multiple| it.votes_nats >= least_nats || is_other_octave(it);
        found.iter().filter(|(_, it)| is_left(it)).map(|(_, it)| it.clone()).collect()
    }

    /// A multiple of a path, which runs along these points. `None` without frames.
    fn multiple(&self, path: usize, factor: f64, points: &[usize]) -> Option<Multiple> {
        let votes = self.votes_along(points);
        let quiet: Vec<f64> =
            votes.iter().zip(&self.quiet_frames).filter(|(_, is_quiet)| **is_quiet).map(|(votes, _)| *votes).collect();
        let speeds_rev_s = self.grid.speeds_of(points);
        Some(Multiple {
            path,
            factor,
            speed_rev_s: mean(&speeds_rev_s)?,
            speeds_rev_s,
            votes_nats: median(&votes)?,
            quiet_votes_nats: median(&quiet)?,
        })
    }

    /// The speed at a point of the grid.
    pub(super) fn speed_rev_s(&self, point: usize) -> f64 {
        self.grid.speeds_rev_s[point]
    }

    fn votes_along(&self, path: &[usize]) -> Vec<f64> {
        path.iter().zip(&self.votes).map(|(&point, votes)| f64::from(votes[point])).collect()
    }

    /// What a voice or an instrument, which jumps, explains beside a rotor near this speed or at one of its octaves and families. `None` where
    /// that is less than `gain_nats_min` more, in nats a frame.
    pub(super) fn voice_beside(&self, speed_rev_s: f64, gain_nats_min: f64) -> Option<Voice> {
        let mean_rev_s = |path: &[usize]| mean(&self.grid.speeds_of(path));
        let is_family = |path: &&Vec<usize>| mean_rev_s(path).is_some_and(|of_rev_s| is_family(of_rev_s, speed_rev_s));
        let sum = |path: &[usize]| self.votes_along(path).into_iter().sum::<f64>();
        let best = self.paths.iter().filter(is_family).max_by(|a, b| sum(a).total_cmp(&sum(b)))?;
        let is_near = |shift: isize| {
            let ratio = shift as f64 * GRID_STEP;
            ratio < SLOWER_MAX.ln() || OCTAVES.iter().any(|octave| (ratio - octave.ln()).abs() < JUMP_MIN)
        };
        Voice::beside(&self.votes, best, GRID_STEP, gain_nats_min, is_near)
    }
}

/// Whether a speed is that of another one's octave or family.
pub(super) fn is_family(speed_rev_s: f64, of_rev_s: f64) -> bool {
    FACTORS.iter().any(|&factor| is_at_ratio(speed_rev_s, of_rev_s, factor))
}

/// Whether a speed is another one times a factor.
fn is_at_ratio(speed_rev_s: f64, of_rev_s: f64, factor: f64) -> bool {
    (speed_rev_s / (factor * of_rev_s)).ln().abs() < RELATED
}

/// Whether two paths are equal but for the grid.
fn is_same_path(a: &[usize], b: &[usize]) -> bool {
    let apart: usize = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).sum();
    apart <= SAME_POINTS * a.len()
}

/// Speeds with a constant step of the logarithm.
struct SpeedGrid {
    speeds_rev_s: Vec<f64>,
}

impl SpeedGrid {
    fn of(range: &RangeInclusive<f64>) -> Self {
        let steps = ((range.end() / range.start()).ln() / GRID_STEP).ceil() as u32;
        Self { speeds_rev_s: (0..=steps).map(|step| range.start() * (GRID_STEP * f64::from(step)).exp()).collect() }
    }

    /// Overlapping windows that cover the grid.
    fn windows(&self) -> Vec<Range<usize>> {
        let points = self.speeds_rev_s.len();
        let width = (WINDOW_RATIO.ln() / GRID_STEP) as usize;
        let step = (WINDOW_STEP_RATIO.ln() / GRID_STEP) as usize;
        let starts = (0..).step_by(step);
        let last = points.saturating_sub(width).div_ceil(step);
        starts.take(last + 1).map(|start| start..(start + width).min(points)).collect()
    }

    /// Whether most of a path is at an end of the grid.
    fn is_at_end(&self, path: &[usize]) -> bool {
        let last = self.speeds_rev_s.len().saturating_sub(1);
        let at_end = path.iter().filter(|&&point| point == 0 || point == last).count();
        2 * at_end > path.len()
    }

    /// The speeds along a path.
    fn speeds_of(&self, path: &[usize]) -> Vec<f64> {
        path.iter().map(|&point| self.speeds_rev_s[point]).collect()
    }

    /// The path with all speeds multiplied by a factor; `None` where it leaves the grid.
    fn times(&self, path: &[usize], factor: f64) -> Option<Vec<usize>> {
        let shift = (factor.ln() / GRID_STEP).round() as isize;
        let shifted = |&point: &usize| point.checked_add_signed(shift).filter(|&point| point < self.speeds_rev_s.len());
        path.iter().map(shifted).collect()
    }
}
