//! Tracks of several rotors, speeds in each frame, and the paths through them.

use super::identity::{Identity, Steps, TrackFrame};
use super::pace::Pace;
use super::spectra::{FRAME_TICKS, frame_middle_ticks};
use crate::harmonic::chunks::Chunk;
use crate::harmonic::speed_path::{SpeedPath, SpeedPoint};
use std::ops::RangeInclusive;

/// Lowest and highest of all tracks, and a margin beyond.
pub(super) fn around<'a>(tracks: impl IntoIterator<Item = &'a Vec<f64>>, margin: f64) -> RangeInclusive<f64> {
    let (low, high) = tracks
        .into_iter()
        .flatten()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &speed| (low.min(speed), high.max(speed)));
    low - margin..=high + margin
}

/// Offsets from a common speed that lead nowhere beyond limits, lowest and highest; where it moves by more than is between these, those
/// from their middle.
pub(super) fn offsets_within(limits_rev_s: &RangeInclusive<f64>, common_rev_s: &[f64]) -> RangeInclusive<f64> {
    let (slowest, fastest) =
        common_rev_s.iter().fold((f64::INFINITY, 0.0f64), |(low, high), &speed| (low.min(speed), high.max(speed)));
    let (low, high) = (limits_rev_s.start() - slowest, limits_rev_s.end() - fastest);
    let half_width = (limits_rev_s.end() - limits_rev_s.start()) / 2.0;
    if low < high { low..=high } else { -half_width..=half_width }
}

/// The path through speeds in the middles of all frames.
pub(super) fn path_through(speeds_rev_s: impl IntoIterator<Item = f64>, chunk: &Chunk<'_>) -> Option<SpeedPath> {
    let time_s = |frame: usize| frame_middle_ticks(frame) as f64 * chunk.tick_s;
    let points: Vec<SpeedPoint> = speeds_rev_s
        .into_iter()
        .enumerate()
        .map(|(frame, speed_rev_s)| SpeedPoint { time_s: time_s(frame), speed_rev_s })
        .collect();
    SpeedPath::through(&points, chunk.tick_s, chunk.ticks)
}

/// Paths through the same speeds, so labelled in each frame that each path is as continuous as it can be.
pub(super) fn continuous_paths(speeds_rev_s: &[Vec<f64>], pace: Pace, chunk: &Chunk<'_>) -> Vec<SpeedPath> {
    let frame_s = FRAME_TICKS as f64 * chunk.tick_s;
    let frames: Vec<Vec<TrackFrame>> = speeds_rev_s
        .iter()
        .map(|track| track.iter().map(|&speed_rev_s| TrackFrame { speed_rev_s, ..TrackFrame::default() }).collect())
        .collect();
    let steps = Steps { frame_s, pace, resolution_rev_s: 0.0, gap_s: 0.0 };
    let labelling = Identity::default().labelled(&frames, &steps).tracks;
    (0..speeds_rev_s.len())
        .filter_map(|rotor| {
            path_through(labelling.iter().enumerate().map(|(frame, labels)| speeds_rev_s[labels[rotor]][frame]), chunk)
        })
        .collect()
}

/// Paths through tracks that are offsets from a common speed.
pub(super) fn paths_along(
    offsets_rev_s: &[Vec<f64>],
    common_rev_s: &[f64],
    pace: Pace,
    chunk: &Chunk<'_>,
) -> Vec<SpeedPath> {
    let of = |track: &Vec<f64>| track.iter().zip(common_rev_s).map(|(offset, common)| common + offset).collect();
    continuous_paths(&offsets_rev_s.iter().map(of).collect::<Vec<Vec<f64>>>(), pace, chunk)
}

/// The speeds of paths in each frame.
pub(super) fn tracks_of(paths: &[SpeedPath], frames: usize) -> Vec<Vec<f64>> {
    let of = |path: &SpeedPath| (0..frames).map(|frame| path.speed_rev_s(frame_middle_ticks(frame))).collect();
    paths.iter().map(of).collect()
}

/// Tracks as offsets from a common speed.
pub(super) fn offsets_from(tracks: &[Vec<f64>], common_rev_s: &[f64]) -> Vec<Vec<f64>> {
    let of = |track: &Vec<f64>| track.iter().zip(common_rev_s).map(|(speed, common)| speed - common).collect();
    tracks.iter().map(of).collect()
}

/// The mean of all tracks in each frame, averaged over so many frames to either side.
pub(super) fn smoothed_mean(tracks: &[Vec<f64>], reach: usize) -> Vec<f64> {
    let frames = tracks.first().map_or(0, Vec::len);
    let means: Vec<f64> =
        (0..frames).map(|frame| tracks.iter().map(|track| track[frame]).sum::<f64>() / tracks.len() as f64).collect();
    (0..frames)
        .map(|frame| {
            let near = &means[frame.saturating_sub(reach)..(frame + reach + 1).min(frames)];
            near.iter().sum::<f64>() / near.len() as f64
        })
        .collect()
}

/// Share of the frames in which two tracks are closer than this.
pub(super) fn share_close(tracks: &[Vec<f64>], distance_rev_s: f64) -> f64 {
    let frames = tracks.first().map_or(0, Vec::len);
    let is_close = |frame: &usize| {
        let mut speeds: Vec<f64> = tracks.iter().map(|track| track[*frame]).collect();
        speeds.sort_by(f64::total_cmp);
        speeds.windows(2).any(|pair| pair[1] - pair[0] < distance_rev_s)
    };
    (0..frames).filter(is_close).count() as f64 / frames.max(1) as f64
}
