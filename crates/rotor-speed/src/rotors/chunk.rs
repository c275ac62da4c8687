//! One chunk of sound → the blocks of each rotor.

use super::RoughChunk;
use super::atoms::ChannelAtoms;
use super::grid::OffsetGrid;
use super::hearing::{
    ALWAYS_CLOSE_SEARCH, Apart, CLOSE_SEARCH, COMMON_SEARCH, COMMON_SEARCH_OF_CLOSE, HEARD_MARGIN, Hearing,
    MARGIN_SHARE, OWN_FRAME_HZ_S2,
};
use super::identity::TrackFrame;
use super::line_weights::line_weights;
use super::motion::common_motion;
use super::pace::Pace;
use super::paths::{around, offsets_within, path_through, share_close, tracks_of};
use super::phase_kept::phase_kept;
use super::scores::Trust;
use super::search::found_tracks;
use super::separation::{RESOLVED_CELLS, SeparatedRotor};
use super::spectra::{FRAME_TICKS, Spectra, frame_middle_ticks};
use crate::harmonic::block::BlockFit;
use crate::harmonic::chunks::Chunk;
use crate::harmonic::join::joined;
use crate::harmonic::partition::{Partition, blocks_between, doubled_partition, likelihood_min};
use crate::harmonic::speed_path::SpeedPath;
use crate::thresholds::{MANY, NEARLY_ALL};
use hovertone_signal::channels::ChannelBand;
use hovertone_signal::fft::ComplexPlanner;
use std::ops::RangeInclusive;

/// A line at f has frames of `√(this / f)` before anything is known of the rotors. *Decision.*
const FIRST_FRAME_HZ_S2: f64 = 100.0;
/// Of the frames of the first search, every so many'th is enough. *Numeric.*
const FIRST_FRAMES_APART: usize = 3;
/// Times that each rotor is then looked for again beside all others. *Numeric.*
const FIRST_SWEEPS: usize = 1;
/// What a rotor leaves behind that is taken away along no path at all. *Decision.*
const FIRST_RESIDUE_SHARE: f32 = 0.06;
/// Where two rotors are closer than so many of those cells for long, longer frames tell them apart better. *Decision.*
const CLOSE_CELLS: f64 = 2.0;
/// Share of the frames that is long.
const CLOSE_SHARE: f64 = MANY;
/// Share of the frames in which two searches are better than one: of rotors 0.1 % apart all four are right in 0.946 of the frames of 20 clips, and in
/// 0.938 by one. That is not so 0.3 % apart.
const ALWAYS_CLOSE_SHARE: f64 = NEARLY_ALL;

/// What was heard of one rotor.
pub(super) struct HeardRotor {
    pub(super) line_count: usize,
    pub(super) level: Partition,
    pub(super) between: Vec<BlockFit>,
    /// Its path as the search has it, and as the blocks that stand out of the noise have it.
    pub(super) traced: SpeedPath,
    path: SpeedPath,
    /// Level of each line in each frame.
    levels: Vec<Vec<f64>>,
    /// In each frame, whether its lines are worth more than anything that is left.
    are_heard: Vec<bool>,
    /// Share of the frames in which that would be so for a rotor of a quarter of its power.
    pub(super) faint_share: f64,
    /// Share of the frames in which two rotors are close to each other, where that is often so.
    pub(super) close_share: f64,
    /// Share of the frames in which one more rotor is heard in what all of them leave.
    pub(super) another_share: f64,
    /// How much of their phase its lines keep from frame to frame.
    pub(super) phase_kept: Option<f64>,
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

/// How far two rotors must be apart to be told so, by the line that tells it best.
pub(super) fn resolution_rev_s(bands: &[ChannelBand]) -> f64 {
    let length_s = |band: &ChannelBand| {
        let speed_rev_s = (band.band_hz_low + band.band_hz_high) / 2.0 / band.order;
        Pace::Steady.frame_s_of_order(OWN_FRAME_HZ_S2, speed_rev_s)(band.order)
    };
    let finest = bands.iter().map(|band| band.order * length_s(band)).fold(0.0, f64::max);
    RESOLVED_CELLS / finest
}

/// Where the rotors of a chunk are, roughly: speeds in each frame, in no order; and how these change. A search along what they share,
/// if they bob, and else along no path at all, so wide that it misses none.
pub(super) fn rough_tracks(
    chunk: &Chunk<'_>,
    atoms: &[ChannelAtoms],
    limits_rev_s: &RangeInclusive<f64>,
    count: usize,
    planner: &mut ComplexPlanner,
) -> (Vec<Vec<f64>>, Pace) {
    let middle_rev_s = (limits_rev_s.start() + limits_rev_s.end()) / 2.0;
    let motion = common_motion(chunk, atoms, limits_rev_s, count, planner);
    let pace = if motion.is_some() { Pace::Bobbing } else { Pace::Steady };
    let Some(common) = motion.or_else(|| path_through([middle_rev_s], chunk)) else { return (Vec::new(), pace) };
    let frame_s = Pace::Steady.frame_s_of_order(FIRST_FRAME_HZ_S2, middle_rev_s);
    let spectra = Spectra::along(chunk, &chunk.series, &common, frame_s, FIRST_FRAMES_APART, planner);
    let grid = OffsetGrid::new(offsets_within(limits_rev_s, &spectra.common_rev_s), &spectra);
    let line_weights = line_weights(&spectra, &grid, count);
    let trust = Trust { line_weights: &line_weights, residue_share: FIRST_RESIDUE_SHARE, echo_share: 0.0 };
    let tracks = found_tracks(&spectra, atoms, &grid, &[], count, FIRST_SWEEPS, trust);
    let frames = chunk.ticks / FRAME_TICKS;
    let paths: Vec<SpeedPath> = tracks.iter().filter_map(|track| spectra.path_at(track, chunk)).collect();
    (tracks_of(&paths, frames), pace)
}

/// The band of speeds in which all rotors are, as far as rough tracks tell.
pub(super) fn band_of_tracks<'a>(
    tracks: impl Iterator<Item = &'a Vec<f64>>,
    limits_rev_s: &RangeInclusive<f64>,
) -> RangeInclusive<f64> {
    let margin = MARGIN_SHARE * (limits_rev_s.start() + limits_rev_s.end()) / 2.0;
    let (low, high) = around(tracks, margin).into_inner();
    if low < high { low.max(*limits_rev_s.start())..=high.min(*limits_rev_s.end()) } else { limits_rev_s.clone() }
}

/// The rotors of a chunk, in no order, from what is roughly known of them.
pub(super) fn rotors_of_chunk(
    chunk: &Chunk<'_>,
    atoms: &[ChannelAtoms],
    rough: &RoughChunk,
    planner: &mut ComplexPlanner,
) -> Vec<HeardRotor> {
    let (tick_s, ticks) = (chunk.tick_s, chunk.ticks);
    let Some((mut hearing, spectra)) = Hearing::new(chunk, atoms, rough, planner) else { return Vec::new() };
    let mut frame_hz_s2 = COMMON_SEARCH.frame_hz_s2;
    let close_rev_s = CLOSE_CELLS * hearing.cell_rev_s(frame_hz_s2);
    let are_close = |tracks: &[Vec<f64>]| share_close(tracks, close_rev_s) > CLOSE_SHARE;
    let search = if are_close(&rough.tracks) { COMMON_SEARCH_OF_CLOSE } else { COMMON_SEARCH };
    let mut apart = hearing.searched_in(&spectra, &rough.tracks, search);
    drop(spectra);
    if are_close(&apart.tracks()) {
        frame_hz_s2 = CLOSE_SEARCH.frame_hz_s2;
        let are_always_close = share_close(&apart.tracks(), close_rev_s) > ALWAYS_CLOSE_SHARE;
        for search in are_always_close.then_some(ALWAYS_CLOSE_SEARCH).into_iter().chain([CLOSE_SEARCH]) {
            let finer = hearing.searched(&apart.tracks(), search);
            apart = apart.or_better(finer);
        }
    }
    apart = hearing.retraced(apart);
    // two tracks may share a rotor for a while, and another is left over
    let mut left = hearing.left_over(&apart, frame_hz_s2);
    if let Some(reclaimed) = hearing.reclaimed(&apart, &left).filter(|other| other.rest_energy < apart.rest_energy) {
        apart = reclaimed;
        left = hearing.left_over(&apart, frame_hz_s2);
    }

    if rough.pace == Pace::Bobbing {
        apart = hearing.together(apart);
    }

    let close_share =
        Some(share_close(&apart.tracks(), close_rev_s)).filter(|&share| share > CLOSE_SHARE).unwrap_or(0.0);
    let Apart { paths, rotors, .. } = apart;
    let ghosts: Vec<f64> = (0..left.scores.len()).map(|frame| worth_of_ghost(&rotors, frame)).collect();
    let best_left = |(scores, ghost): (&Vec<f64>, &f64)| scores.iter().copied().fold(*ghost, f64::max) + HEARD_MARGIN;
    let nulls: Vec<f64> = left.scores.iter().zip(&ghosts).map(best_left).collect();
    let another_share = hearing.another_share(&left, &ghosts);
    paths
        .into_iter()
        .zip(rotors)
        .map(|(path, SeparatedRotor { lines, levels, worths, faint_worths, .. })| {
            let level = joined(&lines, &path, &doubled_partition(&lines, &path));
            let between = blocks_between(&lines, &path, &level);
            let points = level.points(likelihood_min(lines.len()), tick_s);
            let traced = path;
            let path = SpeedPath::through(&points, tick_s, ticks).unwrap_or_else(|| traced.clone());
            let phase_kept = phase_kept(&lines, &traced, &path);
            let are_heard = worths.iter().zip(&nulls).map(|(worth, null)| worth > null).collect();
            let faint = faint_worths.iter().zip(&nulls).filter(|(worth, null)| worth > null).count();
            let faint_share = faint as f64 / nulls.len().max(1) as f64;
            HeardRotor {
                line_count: lines.len(),
                level,
                between,
                traced,
                path,
                levels,
                are_heard,
                faint_share,
                close_share,
                another_share,
                phase_kept,
            }
        })
        .collect()
}

/// What may be left of the loudest rotor in a frame.
fn worth_of_ghost(rotors: &[SeparatedRotor], frame: usize) -> f64 {
    rotors.iter().map(|rotor| rotor.ghost_worths[frame]).fold(0.0, f64::max)
}
