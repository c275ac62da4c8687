//! Several rotors told apart from one microphone.
//!
//! Each quantum of up to ten seconds goes through: spectra of all lines in short frames (`spectra`), a path for each rotor with the
//! others taken away (`search`), amplitudes of all lines solved for together so that each rotor is heard alone
//! (`separation`), and then the same likelihood as for a single rotor (`coherence`).

mod atoms;
mod mixture;
mod search;
mod separation;
mod spectra;

use super::coherence::{Level, best_level, first_level, likelihood_min, polished};
use super::floor::FloorMeter;
use super::path::SpeedPath;
use super::quanta::{Quantum, QuantumCutter};
use super::track::HarmonicTrack;
use super::{block_at, noise_variances_of};
use crate::channel::ChannelBand;
use atoms::{ChannelAtoms, atoms_of};
use rustfft::FftPlanner;
use search::{OffsetGrid, found_tracks};
use separation::{SeparatedRotor, separated};
use spectra::{Spectra, frame_middle_ticks};

/// Longest stretch that is taken together.
const QUANTUM_S_MAX: f64 = 10.0;
/// A line of order o has frames of `√(this / o)`: half a minute of rotors of a hovering multirotor leave their common speed by less
/// than 0.4 rev/s per second, which smears the line over one resolution cell.
const COHERENCE_TURNS_S: f64 = 3.0;
/// … before their common speed is known.
const FIRST_COHERENCE_TURNS_S: f64 = 1.7;
/// A frame is no longer than this: sound in a room loses its phase.
const FRAME_S_MAX: f64 = 0.4;
/// Frames to either side over which the common speed is averaged.
const COMMON_FRAMES: usize = 2;

/// Follows the speeds of several rotors through stretches of sound.
pub(crate) struct RotorTracer {
    cutter: QuantumCutter,
    floors: Vec<FloorMeter>,
    atoms: Vec<ChannelAtoms>,
    limits_rev_s: (f64, f64),
    count: usize,
    planner: FftPlanner<f32>,
    rotors: Vec<HarmonicTrack>,
}

impl RotorTracer {
    /// Hears `count` rotors in the lines of `bands`, which all stand for the same limits of speed. `mesh_order` is the order of
    /// the gear mesh, if there is one.
    pub(crate) fn new(sample_rate_hz: f64, bands: &[ChannelBand], mesh_order: Option<f64>, count: usize) -> Self {
        let cutter = QuantumCutter::new(sample_rate_hz, bands, QUANTUM_S_MAX);
        let mut planner = FftPlanner::new();
        let limits_rev_s =
            bands.first().map_or((0.0, 1.0), |band| (band.band_hz_low / band.order, band.band_hz_high / band.order));
        let step_s = cutter.tick_s() * spectra::FRAME_TICKS as f64;
        Self {
            floors: cutter.channels().iter().map(|channel| FloorMeter::new(channel.hop_samples, &mut planner)).collect(),
            atoms: atoms_of(cutter.channels(), mesh_order),
            limits_rev_s,
            count,
            planner,
            rotors: vec![HarmonicTrack { step_s, ..HarmonicTrack::default() }; count],
            cutter,
        }
    }

    /// A new stretch of sound begins at `start_s` and should last `length_s`.
    pub(crate) fn restart(&mut self, start_s: f64, length_s: f64) {
        self.end_stretch();
        self.cutter.restart(start_s, length_s);
    }

    pub(crate) fn push(&mut self, samples: &[f32]) {
        self.cutter.push(samples);
        while let Some(ticks) = self.cutter.ready_ticks() {
            self.take_quantum(ticks);
        }
    }

    /// The rotors, fastest first.
    pub(crate) fn finish(mut self) -> Vec<HarmonicTrack> {
        self.end_stretch();
        self.rotors
    }

    fn end_stretch(&mut self) {
        if let Some(ticks) = self.cutter.last_ticks() {
            self.take_quantum(ticks);
        }
    }

    fn take_quantum(&mut self, ticks: usize) {
        let Self { cutter, floors, atoms, limits_rev_s, count, planner, rotors } = self;
        let quantum = cutter.quantum(ticks);
        let taken = quantum.ticks;
        let place = (quantum.start_s, quantum.tick_s);
        let noise_variances = noise_variances_of(floors, &quantum.series, quantum.mean_square);
        let levels = rotors_of_quantum(&quantum, &noise_variances, atoms, *limits_rev_s, *count, planner);
        for (track, (lines, level)) in rotors.iter_mut().zip(levels) {
            track.blocks.extend(level.blocks.iter().map(|fit| block_at(fit, true, place, (lines, *limits_rev_s))));
        }
        cutter.drop_ticks(taken);
    }
}

/// Length of the frames of a line.
fn frame_s_of_order(coherence_turns_s: f64) -> impl Fn(f64) -> f64 {
    move |order| (coherence_turns_s / order).sqrt().min(FRAME_S_MAX)
}

/// Each rotor's number of lines and blocks of speed.
fn rotors_of_quantum(
    quantum: &Quantum<'_>,
    noise_variances: &[f64],
    atoms: &[ChannelAtoms],
    limits_rev_s: (f64, f64),
    count: usize,
    planner: &mut FftPlanner<f32>,
) -> Vec<(usize, Level)> {
    let (tick_s, ticks) = (quantum.tick_s, quantum.ticks);
    let middle_rev_s = (limits_rev_s.0 + limits_rev_s.1) / 2.0;
    let Some(constant) = SpeedPath::through(&[(0.0, middle_rev_s)], tick_s, ticks) else { return Vec::new() };
    let first = Spectra::along(quantum, noise_variances, &constant, frame_s_of_order(FIRST_COHERENCE_TURNS_S), planner);
    let reach = (limits_rev_s.0 - middle_rev_s, limits_rev_s.1 - middle_rev_s);
    let tracks = found_tracks(&first, atoms, &OffsetGrid::new(reach, &first), count);
    let common: Vec<(f64, f64)> = smoothed_mean(&tracks)
        .into_iter()
        .enumerate()
        .map(|(frame, offset)| (frame_middle_ticks(frame) as f64 * tick_s, middle_rev_s + offset))
        .collect();
    let Some(common) = SpeedPath::through(&common, tick_s, ticks) else { return Vec::new() };
    let frame_s = frame_s_of_order(COHERENCE_TURNS_S);
    let second = Spectra::along(quantum, noise_variances, &common, &frame_s, planner);
    let mean = common.mean_rev_s();
    let reach = (limits_rev_s.0 - mean, limits_rev_s.1 - mean);
    let tracks = found_tracks(&second, atoms, &OffsetGrid::new(reach, &second), count);
    let mut paths: Vec<SpeedPath> = tracks
        .iter()
        .filter_map(|track| {
            let points: Vec<(f64, f64)> = track
                .iter()
                .enumerate()
                .map(|(frame, offset)| (frame_middle_ticks(frame) as f64 * tick_s, second.common_rev_s[frame] + offset))
                .collect();
            SpeedPath::through(&points, tick_s, ticks)
        })
        .collect();
    let apart = separated(quantum, noise_variances, atoms, &paths, &frame_s);
    for (path, SeparatedRotor { lines, .. }) in paths.iter_mut().zip(&apart) {
        let threshold = likelihood_min(lines.len());
        let level = first_level(lines, path);
        let better: Vec<(f64, f64)> = level
            .blocks
            .iter()
            .filter(|block| block.likelihood >= threshold)
            .map(|block| (block.middle_s(tick_s), block.speed_rev_s))
            .collect();
        if let Some(better) = SpeedPath::through(&better, tick_s, ticks) {
            *path = better;
        }
    }
    let apart = separated(quantum, noise_variances, atoms, &paths, &frame_s);
    paths
        .iter()
        .zip(&apart)
        .map(|(path, SeparatedRotor { lines, .. })| (lines.len(), polished(lines, path, &best_level(lines, path))))
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
