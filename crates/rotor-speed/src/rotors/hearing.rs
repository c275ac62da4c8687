//! A chunk, listened to again and again: the rotors looked for beside each other, taken apart, their paths drawn again, and what
//! is left over given to those that have nothing.

use super::RoughChunk;
use super::atoms::ChannelAtoms;
use super::grid::OffsetGrid;
use super::line_weights::line_weights;
use super::pace::Pace;
use super::paths::{around, continuous_paths, offsets_from, path_through, paths_along, smoothed_mean, tracks_of};
use super::retrace::retraced;
use super::scores::{GridScores, Trust};
use super::search::{found_tracks, reclaimed_tracks, worths_of_another};
use super::separation::{SeparatedRotor, separated};
use super::spectra::{FRAME_TICKS, Spectra};
use super::together::FrameScores;
use crate::harmonic::chunks::Chunk;
use crate::harmonic::speed_path::SpeedPath;
use crate::thresholds::{BESIDE_SHARE, CLEAR_NATS};
use hovertone_signal::fft::ComplexPlanner;
use realfft::num_complex::Complex;

/// A line at f has frames of `√(this / f)` along a rotor's own path. *Decision.*
pub(super) const OWN_FRAME_HZ_S2: f64 = 480.0;
/// Rotors are looked for so far beyond what the first search found, as a share of the speed.
pub(super) const MARGIN_SHARE: f64 = BESIDE_SHARE;
/// Rotors of a hovering multirotor leave their common speed by less than 1 % in a second, which smears a line over less than two
/// resolution cells of these frames. *Decision.*
pub(super) const COMMON_SEARCH: Search =
    Search { frame_hz_s2: 180.0, margin_share: MARGIN_SHARE, sweeps: 2, is_afresh: false, residue_share: 0.03 };
/// The same for rotors that are close together: each stands in what another leaves behind. *Decision.*
pub(super) const COMMON_SEARCH_OF_CLOSE: Search = Search { residue_share: 0.0, ..COMMON_SEARCH };
/// And along what these have found, afresh: tracks that have taken each other's rotors would stay there. *Decision.*
pub(super) const CLOSE_SEARCH: Search =
    Search { frame_hz_s2: OWN_FRAME_HZ_S2, margin_share: 0.003, sweeps: 2, is_afresh: true, residue_share: 0.0 };
/// Where rotors are close to each other nearly all the time, first from where they are. *Decision.*
pub(super) const ALWAYS_CLOSE_SEARCH: Search = Search { is_afresh: false, ..CLOSE_SEARCH };

/// A line at f has frames of `√(this / f)` along what rotors that bob share. *Decision.*
const TOGETHER_FRAME_HZ_S2: f64 = 60.0;
/// Times that the rotors are drawn as one pattern, each time along what they shared before. *Numeric.*
const TOGETHER_ROUNDS: usize = 3;
/// In a room with a reverberation time of 0.5 s this share of the power is still there a frame later. 0.2 to 0.6 do alike. These frames overlap,
/// so that sound that holds still counts less as well: this is for what moves by a cell or so from one to the next. *Decision.*
const ECHO_SHARE: f32 = 0.3;

/// A rotor's lines must be worth this much more than the best of what is left when all rotors have been taken away: a path drawn through
/// noise alone follows its maxima.
pub(super) const HEARD_MARGIN: f64 = CLEAR_NATS;

/// How the rotors are looked for beside each other.
#[derive(Clone, Copy)]
pub(super) struct Search {
    /// A line at f has frames of `√(this / f)`.
    pub(super) frame_hz_s2: f64,
    /// How far beyond what is known, as a share of the speed.
    margin_share: f64,
    /// Times that each is looked for again beside all others.
    sweeps: usize,
    /// Whether what is known of the rotors is forgotten but for what they share.
    is_afresh: bool,
    /// See [`Trust`].
    residue_share: f32,
}

/// Rotors taken apart along their paths.
pub(super) struct Apart {
    pub(super) paths: Vec<SpeedPath>,
    pub(super) rotors: Vec<SeparatedRotor>,
    /// What no rotor explains of each channel, and its energy in units of the noise.
    rests: Vec<Vec<Complex<f32>>>,
    pub(super) rest_energy: f64,
    frames: usize,
}

impl Apart {
    pub(super) fn tracks(&self) -> Vec<Vec<f64>> {
        tracks_of(&self.paths, self.frames)
    }

    /// The rotors are worth as much as they were along the paths for which is known what is left over beside them.
    fn worth_as_much_as(mut self, other: Self) -> Self {
        for (own, other) in self.rotors.iter_mut().zip(other.rotors) {
            *own = SeparatedRotor {
                lines: std::mem::take(&mut own.lines),
                levels: std::mem::take(&mut own.levels),
                ..other
            };
        }
        self
    }

    /// The one that leaves less unexplained.
    pub(super) fn or_better(self, other: Self) -> Self {
        if other.rest_energy < self.rest_energy { other } else { self }
    }
}

/// One chunk, listened to again and again.
pub(super) struct Hearing<'a, 'p> {
    chunk: &'a Chunk<'a>,
    atoms: &'a [ChannelAtoms],
    pace: Pace,
    middle_rev_s: f64,
    line_weights: Vec<f64>,
    planner: &'p mut ComplexPlanner,
}

impl<'a, 'p> Hearing<'a, 'p> {
    /// Where rotors are roughly; and the frames of a first search along what they share.
    pub(super) fn new(
        chunk: &'a Chunk<'a>,
        atoms: &'a [ChannelAtoms],
        RoughChunk { tracks: rough, pace, .. }: &RoughChunk,
        planner: &'p mut ComplexPlanner,
    ) -> Option<(Self, Spectra)> {
        let speeds = || rough.iter().flatten();
        let middle_rev_s = speeds().sum::<f64>() / speeds().count().max(1) as f64;
        if middle_rev_s <= 0.0 {
            return None;
        }
        let mut hearing = Self { chunk, atoms, pace: *pace, middle_rev_s, line_weights: Vec::new(), planner };
        let spectra = hearing.spectra(&chunk.series, rough, hearing.frame_s(COMMON_SEARCH.frame_hz_s2))?;
        let grid = hearing.grid(&offsets_from(rough, &spectra.common_rev_s), COMMON_SEARCH.margin_share, &spectra);
        hearing.line_weights = line_weights(&spectra, &grid, rough.len());
        Some((hearing, spectra))
    }

    /// Resolution of the line that resolves most finely.
    pub(super) fn cell_rev_s(&self, frame_hz_s2: f64) -> f64 {
        let frame_s = self.frame_s(frame_hz_s2);
        1.0 / self.chunk.channels.iter().map(|line| line.order * frame_s(line.order)).fold(1.0, f64::max)
    }

    /// Length of the frames of a line of some order.
    fn frame_s(&self, frame_hz_s2: f64) -> impl Fn(f64) -> f64 + use<> {
        self.pace.frame_s_of_order(frame_hz_s2, self.middle_rev_s)
    }

    fn apart(&self, paths: Vec<SpeedPath>) -> Apart {
        let frame_s = self.frame_s(OWN_FRAME_HZ_S2);
        let (rotors, rests) = separated(self.chunk, self.atoms, &paths, frame_s, &self.line_weights);
        let energy = |rest: &Vec<Complex<f32>>| rest.iter().map(|z| f64::from(z.norm_sqr())).sum::<f64>();
        let rest_energy = rests.iter().zip(&self.chunk.noise_variances).map(|(rest, noise)| energy(rest) / noise).sum();
        Apart { paths, rotors, rests, rest_energy, frames: self.chunk.ticks / FRAME_TICKS }
    }

    /// Offsets around those of tracks, and a share of the speed beyond.
    fn grid(&self, offsets_rev_s: &[Vec<f64>], margin_share: f64, spectra: &Spectra) -> OffsetGrid {
        OffsetGrid::new(around(offsets_rev_s, margin_share * self.middle_rev_s), spectra)
    }

    /// Frames along what tracks share.
    fn spectra(
        &mut self,
        series: &[&[Complex<f32>]],
        tracks: &[Vec<f64>],
        frame_s: impl Fn(f64) -> f64,
    ) -> Option<Spectra> {
        let common = path_through(smoothed_mean(tracks, self.pace.common_frames()), self.chunk)?;
        Some(Spectra::along(self.chunk, series, &common, frame_s, 1, self.planner))
    }

    /// The rotors, looked for along what their tracks share.
    pub(super) fn searched(&mut self, tracks: &[Vec<f64>], search: Search) -> Apart {
        match self.spectra(&self.chunk.series, tracks, self.frame_s(search.frame_hz_s2)) {
            Some(spectra) => self.searched_in(&spectra, tracks, search),
            None => self.apart(Vec::new()),
        }
    }

    /// The same in frames that are there.
    pub(super) fn searched_in(&self, spectra: &Spectra, tracks: &[Vec<f64>], search: Search) -> Apart {
        let start = offsets_from(tracks, &spectra.common_rev_s);
        let grid = self.grid(&start, search.margin_share, spectra);
        let known: &[Vec<f64>] = if search.is_afresh { &[] } else { &start };
        let trust = Trust { line_weights: &self.line_weights, residue_share: search.residue_share, echo_share: 0.0 };
        let found = found_tracks(spectra, self.atoms, &grid, known, start.len(), search.sweeps, trust);
        self.apart(paths_along(&found, &spectra.common_rev_s, self.pace, self.chunk))
    }

    /// Each rotor's path drawn again in its own lines.
    pub(super) fn retraced(&self, apart: Apart) -> Apart {
        let frame_s = self.frame_s(OWN_FRAME_HZ_S2);
        let speeds = apart.paths.iter().zip(&apart.rotors).map(|(path, rotor)| retraced(&rotor.lines, path, &frame_s));
        let paths = continuous_paths(&speeds.collect::<Vec<Vec<f64>>>(), self.pace, self.chunk);
        apart.or_better(self.apart(paths))
    }

    /// What speaks for one more rotor where all have been taken away.
    pub(super) fn left_over(&mut self, apart: &Apart, frame_hz_s2: f64) -> FrameScores {
        let tracks = apart.tracks();
        let rests: Vec<&[Complex<f32>]> = apart.rests.iter().map(Vec::as_slice).collect();
        let frame_s = self.frame_s(frame_hz_s2);
        self.scores(&rests, &tracks, frame_s, 0.0)
    }

    /// Share of the frames in which one more rotor is heard in what all of them leave: its lines are worth more than noise is, and more than what
    /// is left of the loudest one, `ghosts` in each frame. Of simulated flights with four tracks it was 0.00 to 0.15 where there were no others, and
    /// 0.57 to 1.00 in 18 of 23 where there were six or eight.
    pub(super) fn another_share(&self, left: &FrameScores, ghosts: &[f64]) -> f64 {
        let worths = worths_of_another(&left.scores, ghosts, &left.grid, self.middle_rev_s);
        let heard = worths.iter().filter(|worth| **worth > HEARD_MARGIN).count();
        heard as f64 / worths.len().max(1) as f64
    }

    /// What speaks for one rotor along what tracks share.
    fn scores(
        &mut self,
        series: &[&[Complex<f32>]],
        tracks: &[Vec<f64>],
        frame_s: impl Fn(f64) -> f64,
        echo_share: f32,
    ) -> FrameScores {
        let Some(spectra) = self.spectra(series, tracks, frame_s) else {
            return FrameScores::default();
        };
        let grid = self.grid(&offsets_from(tracks, &spectra.common_rev_s), MARGIN_SHARE, &spectra);
        let trust = Trust { line_weights: &self.line_weights, residue_share: 0.0, echo_share };
        let mut grid_scores = GridScores::new(&spectra, self.atoms, &grid, trust);
        let scores = (0..spectra.frames()).map(|frame| grid_scores.of_frame(frame, &[])).collect();
        FrameScores { scores, grid, common_rev_s: spectra.common_rev_s }
    }

    /// The rotors once more as one pattern, where that explains more of what is not an echo: a path that lags behind explains the
    /// echoes as well, and so leaves less of the sound than the right one.
    pub(super) fn together(&mut self, apart: Apart) -> Apart {
        let frame_s = Pace::Steady.frame_s_of_order(TOGETHER_FRAME_HZ_S2, self.middle_rev_s);
        let found = apart.tracks();
        let mut tracks = found.clone();
        let mut scores = FrameScores::default();
        for _ in 0..TOGETHER_ROUNDS {
            scores = self.scores(&self.chunk.series, &tracks, &frame_s, ECHO_SHARE);
            tracks = scores.moved_as_one(&tracks, MARGIN_SHARE * self.middle_rev_s);
        }
        if scores.speak_more_for(&tracks, &found) {
            let paths = tracks.into_iter().filter_map(|track| path_through(track, self.chunk)).collect();
            self.apart(paths).worth_as_much_as(apart)
        } else {
            apart
        }
    }

    /// The rotors once more, where tracks have gone to what was left over; `None` where none had to.
    pub(super) fn reclaimed(&self, apart: &Apart, left: &FrameScores) -> Option<Apart> {
        let offsets = offsets_from(&apart.tracks(), &left.common_rev_s);
        let worths: Vec<&[f64]> = apart.rotors.iter().map(|rotor| rotor.worths.as_slice()).collect();
        let tracks = reclaimed_tracks(&left.scores, &offsets, &worths, &left.grid, self.middle_rev_s);
        (tracks != offsets)
            .then(|| self.retraced(self.apart(paths_along(&tracks, &left.common_rev_s, self.pace, self.chunk))))
    }
}
