//! One quantum of sound → the blocks of each rotor.

use super::super::coherence::{Level, best_level, likelihood_min};
use super::super::join::joined;
use super::super::path::SpeedPath;
use super::super::quanta::Quantum;
use super::atoms::ChannelAtoms;
use super::identity::{Identity, TrackFrame};
use super::retrace::retraced;
use super::search::{OffsetGrid, better_track, found_tracks, scores_of_frame};
use super::separation::{RESOLVED_CELLS, SeparatedRotor, separated};
use super::spectra::{FRAME_TICKS, Spectra, frame_middle_ticks};
use crate::channel::ChannelBand;
use realfft::num_complex::Complex;
use rustfft::FftPlanner;

/// A line at f has frames of `√(this / f)`: rotors of a hovering multirotor leave their common speed by less than 1 % in a second,
/// which smears the line over less than two resolution cells.
const COMMON_FRAME_HZ_S2: f64 = 180.0;
/// … before their common speed is known, …
const FIRST_FRAME_HZ_S2: f64 = 100.0;
/// … and along a rotor's own path.
const OWN_FRAME_HZ_S2: f64 = 480.0;
/// A frame is no longer than this: sound in a room loses its phase.
const FRAME_S_MAX: f64 = 0.4;
/// Times that each rotor is looked for again beside all others, before and after the common speed is known.
const FIRST_SWEEPS: usize = 1;
const SWEEPS: usize = 2;
/// Times that the rotors are taken apart and their paths drawn again.
const RETRACES: usize = 1;
/// The search goes this far beyond what the first one found, as a share of the speed.
const MARGIN_SHARE: f64 = 0.03;
/// A rotor's lines must be worth this much more than the best of what is left when all rotors have been taken away: a path drawn through
/// noise alone follows its maxima.
const HEARD_MARGIN: f64 = 1.5;
/// Frames to either side over which the common speed is averaged.
const COMMON_FRAMES: usize = 2;

/// What was heard of one rotor.
pub(super) struct HeardRotor {
    pub(super) line_count: usize,
    pub(super) level: Level,
    /// Its path as the search has it, and as the blocks that stand out of the noise have it.
    pub(super) traced: SpeedPath,
    path: SpeedPath,
    /// Level of each line in each frame.
    levels: Vec<Vec<f64>>,
    /// In each frame, whether its lines are worth more than anything that is left.
    are_heard: Vec<bool>,
    /// Share of the frames in which that would be so for a rotor of a tenth of its power.
    pub(super) faint_share: f64,
}

impl HeardRotor {
    /// The rotor in each frame.
    pub(super) fn frames(&self, tick_s: f64) -> Vec<TrackFrame> {
        let frames = self.levels.first().map_or(0, Vec::len);
        let reach = FRAME_TICKS / 2;
        (0..frames)
            .map(|frame| {
                let middle = frame_middle_ticks(frame);
                let (before, after) = (self.path.speed_rev_s(middle - reach), self.path.speed_rev_s(middle + reach));
                TrackFrame {
                    speed_rev_s: self.path.speed_rev_s(middle),
                    slope_rev_s2: (after - before) / (2 * reach) as f64 / tick_s,
                    levels: self.levels.iter().map(|line| (line[frame] > 0.0).then(|| line[frame].ln())).collect(),
                    is_heard: self.are_heard[frame],
                }
            })
            .collect()
    }
}

/// Length of the frames of a line of some order, around some speed.
fn frame_s_of_order(frame_hz_s2: f64, speed_rev_s: f64) -> impl Fn(f64) -> f64 {
    move |order| (frame_hz_s2 / (order * speed_rev_s)).sqrt().min(FRAME_S_MAX)
}

/// How far two rotors must be apart to be told so, by the line that tells it best.
pub(super) fn resolution_rev_s(bands: &[ChannelBand]) -> f64 {
    let length_s = |band: &ChannelBand| {
        let speed_rev_s = (band.band_hz_low + band.band_hz_high) / 2.0 / band.order;
        frame_s_of_order(OWN_FRAME_HZ_S2, speed_rev_s)(band.order)
    };
    let finest = bands.iter().map(|band| band.order * length_s(band)).fold(0.0, f64::max);
    RESOLVED_CELLS / finest
}

/// The rotors of a quantum, in no order.
pub(super) fn rotors_of_quantum(
    quantum: &Quantum<'_>,
    atoms: &[ChannelAtoms],
    limits_rev_s: (f64, f64),
    count: usize,
    planner: &mut FftPlanner<f32>,
) -> Vec<HeardRotor> {
    let (tick_s, ticks) = (quantum.tick_s, quantum.ticks);
    let middle_rev_s = (limits_rev_s.0 + limits_rev_s.1) / 2.0;
    let along = |common: &SpeedPath, series: &[&[Complex<f32>]], frame_hz_s2: f64, planner: &mut FftPlanner<f32>| {
        Spectra::along(quantum, series, common, frame_s_of_order(frame_hz_s2, middle_rev_s), planner)
    };

    // a first search, along no path at all
    let Some(constant) = path_through([middle_rev_s], quantum) else { return Vec::new() };
    let spectra = along(&constant, &quantum.series, FIRST_FRAME_HZ_S2, planner);
    let grid = OffsetGrid::new((limits_rev_s.0 - middle_rev_s, limits_rev_s.1 - middle_rev_s), &spectra);
    let first = found_tracks(&spectra, atoms, &grid, &[], (count, FIRST_SWEEPS));
    let Some(common) = path_through(smoothed_mean(&first).into_iter().map(|offset| middle_rev_s + offset), quantum)
    else {
        return Vec::new();
    };

    // another one, along what the rotors share
    let spectra = along(&common, &quantum.series, COMMON_FRAME_HZ_S2, planner);
    let start: Vec<Vec<f64>> = first
        .iter()
        .map(|track| {
            track.iter().zip(&spectra.common_rev_s).map(|(offset, common)| middle_rev_s + offset - common).collect()
        })
        .collect();
    let grid = OffsetGrid::new(around(&start, MARGIN_SHARE * middle_rev_s), &spectra);
    let tracks = found_tracks(&spectra, atoms, &grid, &start, (count, SWEEPS));
    let speeds = tracks
        .iter()
        .map(|track| track.iter().zip(&spectra.common_rev_s).map(|(offset, common)| common + offset).collect());
    let mut paths = continuous_paths(&speeds.collect::<Vec<Vec<f64>>>(), quantum);

    // two tracks may share a rotor for a while, and another is left over
    let apart_along =
        |paths: &[SpeedPath]| separated(quantum, atoms, paths, frame_s_of_order(OWN_FRAME_HZ_S2, middle_rev_s));
    let (rotors, rests) = apart_along(&paths);
    let rests: Vec<&[Complex<f32>]> = rests.iter().map(Vec::as_slice).collect();
    let rest = along(&common, &rests, COMMON_FRAME_HZ_S2, planner);
    let scores: Vec<Vec<f64>> =
        (0..rest.frames()).map(|frame| scores_of_frame(&rest, atoms, frame, &grid, &[])).collect();
    let speeds = paths.iter().zip(&rotors).map(|(path, rotor)| {
        let offsets = rest
            .common_rev_s
            .iter()
            .enumerate()
            .map(|(frame, common)| path.speed_rev_s(frame_middle_ticks(frame)) - common);
        let own: Vec<(f64, f64)> = offsets.zip(rotor.worths.iter().copied()).collect();
        better_track(&scores, &own, &grid, middle_rev_s)
            .iter()
            .zip(&rest.common_rev_s)
            .map(|(offset, common)| common + offset)
            .collect()
    });
    paths = continuous_paths(&speeds.collect::<Vec<Vec<f64>>>(), quantum);

    for _ in 0..RETRACES {
        let (rotors, _) = apart_along(&paths);
        let speeds = paths
            .iter()
            .zip(&rotors)
            .map(|(path, rotor)| retraced(&rotor.lines, path, frame_s_of_order(OWN_FRAME_HZ_S2, middle_rev_s)));
        paths = continuous_paths(&speeds.collect::<Vec<Vec<f64>>>(), quantum);
    }
    let (rotors, _) = apart_along(&paths);
    let nulls: Vec<f64> = scores
        .iter()
        .enumerate()
        .map(|(frame, left)| {
            let ghost = rotors.iter().map(|rotor| rotor.ghost_worths[frame]).fold(0.0, f64::max);
            left.iter().copied().fold(ghost, f64::max) + HEARD_MARGIN
        })
        .collect();
    paths
        .into_iter()
        .zip(rotors)
        .map(|(path, SeparatedRotor { lines, levels, worths, faint_worths, .. })| {
            let level = joined(&lines, &path, &best_level(&lines, &path));
            let points = level.points(likelihood_min(lines.len()), tick_s);
            let traced = path;
            let path = SpeedPath::through(&points, tick_s, ticks).unwrap_or_else(|| traced.clone());
            let are_heard = worths.iter().zip(&nulls).map(|(worth, null)| worth > null).collect();
            let faint = faint_worths.iter().zip(&nulls).filter(|(worth, null)| worth > null).count();
            let faint_share = faint as f64 / nulls.len().max(1) as f64;
            HeardRotor { line_count: lines.len(), level, traced, path, levels, are_heard, faint_share }
        })
        .collect()
}

/// Lowest and highest of all tracks, and a margin beyond.
fn around(tracks: &[Vec<f64>], margin: f64) -> (f64, f64) {
    let all = || tracks.iter().flatten().copied();
    (all().fold(f64::INFINITY, f64::min) - margin, all().fold(f64::NEG_INFINITY, f64::max) + margin)
}

/// The path through speeds in the middles of all frames.
fn path_through(speeds_rev_s: impl IntoIterator<Item = f64>, quantum: &Quantum<'_>) -> Option<SpeedPath> {
    let time_s = |frame: usize| frame_middle_ticks(frame) as f64 * quantum.tick_s;
    let points: Vec<(f64, f64)> =
        speeds_rev_s.into_iter().enumerate().map(|(frame, speed)| (time_s(frame), speed)).collect();
    SpeedPath::through(&points, quantum.tick_s, quantum.ticks)
}

/// Paths through the same speeds, so labelled in each frame that each path is as continuous as it can be.
fn continuous_paths(speeds_rev_s: &[Vec<f64>], quantum: &Quantum<'_>) -> Vec<SpeedPath> {
    let frame_s = FRAME_TICKS as f64 * quantum.tick_s;
    let frames: Vec<Vec<TrackFrame>> = speeds_rev_s
        .iter()
        .map(|track| track.iter().map(|&speed_rev_s| TrackFrame { speed_rev_s, ..TrackFrame::default() }).collect())
        .collect();
    let labelling = Identity::default().labelled(&frames, frame_s);
    (0..speeds_rev_s.len())
        .filter_map(|rotor| {
            path_through(
                labelling.iter().enumerate().map(|(frame, labels)| speeds_rev_s[labels[rotor]][frame]),
                quantum,
            )
        })
        .collect()
}

/// The mean of all tracks in each frame, smoothed.
fn smoothed_mean(tracks: &[Vec<f64>]) -> Vec<f64> {
    let frames = tracks.first().map_or(0, Vec::len);
    let means: Vec<f64> =
        (0..frames).map(|frame| tracks.iter().map(|track| track[frame]).sum::<f64>() / tracks.len() as f64).collect();
    (0..frames)
        .map(|frame| {
            let near = &means[frame.saturating_sub(COMMON_FRAMES)..(frame + COMMON_FRAMES + 1).min(frames)];
            near.iter().sum::<f64>() / near.len() as f64
        })
        .collect()
}
