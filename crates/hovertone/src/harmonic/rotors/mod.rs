//! Several rotors told apart from one microphone.
//!
//! Each quantum of up to ten seconds goes through: spectra of all lines in short frames (`spectra`), a path for each rotor with the
//! others taken away (`search`), amplitudes of all lines solved for together so that each rotor is heard alone
//! (`separation`), and then the same likelihood as for a single rotor (`coherence`).

mod atoms;
mod identity;
mod mixture;
mod retrace;
mod search;
mod separation;
mod spectra;

use super::coherence::{Level, best_level, first_level, level_around, likelihood_min, polished};
use super::floor::FloorMeter;
use super::path::SpeedPath;
use super::quanta::{Quantum, QuantumCutter};
use super::track::{HarmonicBlock, HarmonicTrack};
use super::{block_at, noise_variances_of};
use crate::channel::ChannelBand;
use crate::span::Span;
use atoms::{ChannelAtoms, atoms_of};
use identity::{Identity, TrackFrame};
use rustfft::FftPlanner;
use retrace::retraced;
use search::{OffsetGrid, better_track, found_tracks, scores_of_frame};
use realfft::num_complex::Complex;
use separation::{SeparatedRotor, separated};
use spectra::{FRAME_TICKS, Spectra, frame_middle_ticks};

/// Longest stretch that is taken together.
const QUANTUM_S_MAX: f64 = 10.0;
/// A line of order o has frames of `√(this / o)`: half a minute of rotors of a hovering multirotor leave their common speed by less
/// than 0.4 rev/s per second, which smears the line over one resolution cell.
const COHERENCE_TURNS_S: f64 = 3.0;
/// … before their common speed is known.
const FIRST_COHERENCE_TURNS_S: f64 = 1.7;
/// A frame is no longer than this: sound in a room loses its phase.
const FRAME_S_MAX: f64 = 0.4;
/// Times that each rotor is looked for again beside all others, before and after the common speed is known.
const FIRST_SWEEPS: usize = 1;
const SWEEPS: usize = 2;
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
    identity: Identity,
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
            identity: Identity::default(),
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
        let Self { cutter, floors, atoms, limits_rev_s, count, planner, identity, rotors } = self;
        let quantum = cutter.quantum(ticks);
        let (start_s, tick_s, taken) = (quantum.start_s, quantum.tick_s, quantum.ticks);
        let noise_variances = noise_variances_of(floors, &quantum.series, quantum.mean_square);
        let heard = rotors_of_quantum(&quantum, &noise_variances, atoms, *limits_rev_s, *count, planner);
        cutter.drop_ticks(taken);
        let frame_s = FRAME_TICKS as f64 * tick_s;
        let frames: Vec<Vec<TrackFrame>> = heard.iter().map(|rotor| rotor.frames(tick_s)).collect();
        let labelling = identity.labelled(&frames, frame_s);
        let blocks: Vec<Vec<HarmonicBlock>> = heard
            .iter()
            .map(|rotor| {
                let fits = rotor.level.blocks.iter();
                fits.map(|fit| block_at(fit, true, (start_s, tick_s), (rotor.lines, *limits_rev_s))).collect()
            })
            .collect();
        for (rotor, track) in rotors.iter_mut().enumerate() {
            // stretches in which the rotor keeps one track
            let mut from = 0;
            while let Some(first) = labelling.get(from) {
                let kept = labelling[from..].iter().take_while(|labels| labels[rotor] == first[rotor]).count();
                let to = from + kept;
                let end_s = if to == labelling.len() { f64::INFINITY } else { start_s + to as f64 * frame_s };
                let stretch = Span { from_s: start_s + from as f64 * frame_s, to_s: end_s };
                track.blocks.extend(blocks[first[rotor]].iter().filter_map(|block| block.within(stretch)));
                from = to;
            }
        }
    }
}

/// Length of the frames of a line.
fn frame_s_of_order(coherence_turns_s: f64) -> impl Fn(f64) -> f64 {
    move |order| (coherence_turns_s / order).sqrt().min(FRAME_S_MAX)
}

/// What was heard of one rotor in a quantum.
struct HeardRotor {
    lines: usize,
    level: Level,
    path: SpeedPath,
    /// Level of each line in each frame.
    levels: Vec<Vec<f64>>,
}

impl HeardRotor {
    fn frames(&self, tick_s: f64) -> Vec<TrackFrame> {
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
                }
            })
            .collect()
    }
}

/// The rotors of a quantum, in no order.
fn rotors_of_quantum(
    quantum: &Quantum<'_>,
    noise_variances: &[f64],
    atoms: &[ChannelAtoms],
    limits_rev_s: (f64, f64),
    count: usize,
    planner: &mut FftPlanner<f32>,
) -> Vec<HeardRotor> {
    let (tick_s, ticks) = (quantum.tick_s, quantum.ticks);
    let middle_rev_s = (limits_rev_s.0 + limits_rev_s.1) / 2.0;
    let Some(constant) = SpeedPath::through(&[(0.0, middle_rev_s)], tick_s, ticks) else { return Vec::new() };
    let first = Spectra::along(quantum, &quantum.series, noise_variances, &constant, frame_s_of_order(FIRST_COHERENCE_TURNS_S), planner);
    let reach = (limits_rev_s.0 - middle_rev_s, limits_rev_s.1 - middle_rev_s);
    let tracks = found_tracks(&first, atoms, &OffsetGrid::new(reach, &first), &[], (count, FIRST_SWEEPS));
    let common: Vec<(f64, f64)> = smoothed_mean(&tracks)
        .into_iter()
        .enumerate()
        .map(|(frame, offset)| (frame_middle_ticks(frame) as f64 * tick_s, middle_rev_s + offset))
        .collect();
    let Some(common) = SpeedPath::through(&common, tick_s, ticks) else { return Vec::new() };
    let frame_s = frame_s_of_order(COHERENCE_TURNS_S);
    let second = Spectra::along(quantum, &quantum.series, noise_variances, &common, &frame_s, planner);
    let mean = common.mean_rev_s();
    let reach = (limits_rev_s.0 - mean, limits_rev_s.1 - mean);
    let start: Vec<Vec<f64>> = tracks
        .iter()
        .map(|track| track.iter().zip(&second.common_rev_s).map(|(offset, common)| middle_rev_s + offset - common).collect())
        .collect();
    let tracks = found_tracks(&second, atoms, &OffsetGrid::new(reach, &second), &start, (count, SWEEPS));
    let tracks = continuous(&tracks, FRAME_TICKS as f64 * tick_s);
    if std::env::var("HT_STAGE").is_ok_and(|v| v == "tracks") {
        let mut out = Vec::new();
        for track in &tracks {
            let points: Vec<(f64, f64)> = track.iter().enumerate()
                .map(|(frame, offset)| (frame_middle_ticks(frame) as f64 * tick_s, second.common_rev_s[frame] + offset)).collect();
            let path = SpeedPath::through(&points, tick_s, ticks).unwrap();
            let (apart, _) = separated(quantum, noise_variances, atoms, &[path.clone()], &frame_s);
            let mut level = first_level(&apart[0].lines, &path);
            let n = level.blocks.len();
            for b in &mut level.blocks {
                let f = ((b.tick_from + b.tick_to) / 2).min(ticks-1);
                b.speed_rev_s = path.speed_rev_s(f);
                b.slope_rev_s2 = 0.0; b.likelihood = 1e9; b.information = 1e6;
            }
            let _ = n;
            out.push(HeardRotor { lines: 3, level, path, levels: vec![vec![1.0; ticks / FRAME_TICKS]; 3] });
        }
        return out;
    }
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
    let ev = |n: &str, d: f64| std::env::var(n).map_or(d, |v| v.parse().unwrap());
    let frame_s = frame_s_of_order(ev("HT_C", 8.0));
    let grid = OffsetGrid::new(reach, &second);
    for _ in 0..ev("HT_WIDE", 1.0) as usize {
        let (apart, rests) = separated(quantum, noise_variances, atoms, &paths, &frame_s);
        let rests: Vec<&[Complex<f32>]> = rests.iter().map(Vec::as_slice).collect();
        let rest = Spectra::along(quantum, &rests, noise_variances, &common, frame_s_of_order(COHERENCE_TURNS_S), planner);
        let scores: Vec<Vec<f64>> = (0..rest.frames()).map(|frame| scores_of_frame(&rest, atoms, frame, &grid, &[])).collect();
        for (path, rotor) in paths.iter_mut().zip(&apart) {
            let own: Vec<(f64, f64)> = rotor.worths.iter().enumerate()
                .map(|(frame, worth)| (path.speed_rev_s(frame_middle_ticks(frame)) - rest.common_rev_s[frame], *worth)).collect();
            let better = better_track(&scores, &own, &grid, mean);
            let moved = better.iter().filter(|b| b.is_some()).count();
            if std::env::var("HT_DBG").is_ok() { eprintln!("moved {moved} of {}  worth {:.0}", better.len(), rotor.worths.iter().sum::<f64>() / better.len() as f64); }
            let points: Vec<(f64, f64)> = better.iter().zip(&own).enumerate().map(|(frame, (better, (offset, _)))|
                (frame_middle_ticks(frame) as f64 * tick_s, rest.common_rev_s[frame] + better.unwrap_or(*offset))).collect();
            if moved > 0 { if let Some(p) = SpeedPath::through(&points, tick_s, ticks) { *path = p; } }
        }
    }
    let relabel = |paths: &mut Vec<SpeedPath>| {
        let tracks: Vec<Vec<f64>> = paths.iter().map(|path| (0..ticks / FRAME_TICKS).map(|frame| path.speed_rev_s(frame_middle_ticks(frame))).collect()).collect();
        let tracks = continuous(&tracks, FRAME_TICKS as f64 * tick_s);
        for (path, track) in paths.iter_mut().zip(&tracks) {
            let points: Vec<(f64, f64)> = track.iter().enumerate().map(|(frame, speed)| (frame_middle_ticks(frame) as f64 * tick_s, *speed)).collect();
            if let Some(p) = SpeedPath::through(&points, tick_s, ticks) { *path = p; }
        }
    };
    for _ in 0..ev("HT_IT", 2.0) as usize {
        let (apart, _) = separated(quantum, noise_variances, atoms, &paths, &frame_s);
        for (path, rotor) in paths.iter_mut().zip(&apart) {
            *path = retraced(&rotor.lines, path, &frame_s);
        }
        relabel(&mut paths);
    }
    let (apart, _) = separated(quantum, noise_variances, atoms, &paths, &frame_s);
    paths
        .into_iter()
        .zip(apart)
        .map(|(path, SeparatedRotor { lines, levels, .. })| {
            let level = if std::env::var("HT_BEST").is_ok() { level_around(&lines, &path, ev("HT_CELLS", 0.0)) } else { polished(&lines, &path, &best_level(&lines, &path)) };
            let threshold = likelihood_min(lines.len());
            let path = SpeedPath::through(&level.points(threshold, tick_s), tick_s, ticks).unwrap_or(path);
            HeardRotor { lines: lines.len(), level, path, levels }
        })
        .collect()
}

/// The same tracks, so labelled that each is as continuous as it can be.
fn continuous(tracks: &[Vec<f64>], frame_s: f64) -> Vec<Vec<f64>> {
    let frames: Vec<Vec<TrackFrame>> = tracks
        .iter()
        .map(|track| track.iter().map(|&speed_rev_s| TrackFrame { speed_rev_s, ..TrackFrame::default() }).collect())
        .collect();
    let labelling = Identity::default().labelled(&frames, frame_s);
    (0..tracks.len())
        .map(|rotor| labelling.iter().enumerate().map(|(frame, labels)| tracks[labels[rotor]][frame]).collect())
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
