//! Where the rotors are, roughly: a path for each through a map of all lines from which the others have been taken away, each in
//! turn (RELAX), with the best path by Viterbi's algorithm.

use super::super::best_path::best_path;
use super::atoms::{ChannelAtoms, HannLobes, REACH_CELLS};
use super::mixture::Mixture;
use super::spectra::{LineSpectra, Spectra};
use crate::statistics::median;
use realfft::num_complex::Complex;
use std::ops::Range;

/// Share of a line's energy that must be left to it by the others.
const ENERGY_LEFT_MIN: f32 = 0.1;
/// How much a rotor's speed changes from one frame to the next, as a share.
const STEP_STD_SHARE: f64 = 0.001;
/// Up to here a line counts for its likelihood, and beyond for the logarithm.
const LINEAR_UP_TO: f64 = 8.0;
/// What a rotor leaves behind when it is taken away lies within so many cells of its lines, and counts for nothing below this.
const RESIDUE_CELLS: f32 = 4.0;
const RESIDUE_MIN: f32 = 0.03;
/// Likelihoods are cut here, so that the product of so many is still a number.
const LIKELIHOOD_MAX: f32 = 1e9;
const LINES_PER_LOGARITHM: usize = 32;
/// A rotor's own track covers so many points of the grid to either side.
const OWN_POINTS: usize = 1;
/// What a rotor claims of what was left over is taken from so many points to either side.
const CLAIMED_POINTS: usize = 5;
/// The best of some hundred points of noise lies so many median deviations over their median: 3.4 standard deviations.
const NOTHING_DEVIATIONS: f64 = 5.0;
/// Points of the grid in a resolution cell of the line that resolves most finely.
const GRID_PER_CELL: f64 = 2.0;

/// What the spectra are taken for.
#[derive(Clone, Copy)]
pub(super) struct Trust<'a> {
    /// What each line counts.
    pub(super) line_weights: &'a [f64],
    /// Power that a rotor leaves around its lines when it is taken away, as a share of its own: neither its path nor its level is
    /// quite what is assumed.
    pub(super) residue_share: f32,
}

/// Speeds that are looked for, as offsets from the common speed.
#[derive(Default)]
pub(super) struct OffsetGrid {
    first_rev_s: f64,
    pub(super) step_rev_s: f64,
    points: usize,
}

impl OffsetGrid {
    pub(super) fn new((low_rev_s, high_rev_s): (f64, f64), spectra: &Spectra) -> Self {
        let finest = spectra.lines.iter().map(|line| line.order * line.frame_s).fold(1.0, f64::max);
        let points = ((high_rev_s - low_rev_s) * finest * GRID_PER_CELL).ceil().max(2.0) as usize + 1;
        Self { first_rev_s: low_rev_s, step_rev_s: (high_rev_s - low_rev_s) / (points - 1) as f64, points }
    }

    pub(super) fn points(&self) -> usize {
        self.points
    }

    fn offset_rev_s(&self, place: usize) -> f64 {
        self.first_rev_s + place as f64 * self.step_rev_s
    }

    /// The bins of a line's frames into which it can fall.
    pub(super) fn bins_of(&self, line: &LineSpectra) -> Range<usize> {
        let bin_of = |place: usize| line.bin_of(line.order * self.offset_rev_s(place) * line.frame_s);
        let from = (bin_of(0).max(0.0) as usize).min(line.frame_bins() - 2);
        from..(bin_of(self.points - 1) as usize + 2).clamp(from + 2, line.frame_bins())
    }

    /// The points around an offset, so many to either side.
    fn points_around(&self, offset_rev_s: f64, reach: usize) -> Range<usize> {
        let place = ((offset_rev_s - self.first_rev_s) / self.step_rev_s).round();
        let place = place.clamp(0.0, self.points as f64 - 1.0) as usize;
        place.saturating_sub(reach)..(place + reach + 1).min(self.points)
    }

    /// Standard deviation of the step from frame to frame, in points.
    fn step_std(&self, middle_rev_s: f64) -> f64 {
        STEP_STD_SHARE * middle_rev_s / self.step_rev_s
    }
}

/// The tracks of `count` rotors as offsets from the common speed in each frame: those that are not known from `start`, one after the
/// other, and then `sweeps` times each again beside all others.
pub(super) fn found_tracks(
    spectra: &Spectra,
    atoms: &[ChannelAtoms],
    grid: &OffsetGrid,
    start: &[Vec<f64>],
    (count, sweeps): (usize, usize),
    trust: Trust<'_>,
) -> Vec<Vec<f64>> {
    let middle = spectra.common_rev_s.iter().sum::<f64>() / spectra.frames().max(1) as f64;
    let step_std = grid.step_std(middle) * (spectra.frames_apart() as f64).sqrt();
    let mut searches: Vec<SearchBeside> = (0..count).map(|_| SearchBeside::new(spectra.frames())).collect();
    let mut tracks: Vec<Vec<f64>> = start.to_vec();
    let grid_scores = GridScores::new(spectra, atoms, grid, trust);
    let mut find = |rotor: usize, tracks: &[Vec<f64>]| -> Vec<f64> {
        let others: Vec<&Vec<f64>> =
            tracks.iter().enumerate().filter(|(other, _)| *other != rotor).map(|(_, track)| track).collect();
        let scores = searches[rotor].scores(&others, |frame, others| grid_scores.of_frame(frame, others));
        best_path(scores, step_std).into_iter().map(|place| grid.offset_rev_s(place)).collect()
    };
    while tracks.len() < count {
        let track = find(tracks.len(), &tracks);
        tracks.push(track);
    }
    if count > 1 {
        for rotor in (0..sweeps).flat_map(|_| 0..count) {
            tracks[rotor] = find(rotor, &tracks);
        }
    }
    tracks
}

/// What speaks for one rotor, frame by frame. Where the others stay where they were, it stays what it was.
struct SearchBeside {
    scores: Vec<Vec<f64>>,
    /// Where the others were; `None` before the first search.
    others_rev_s: Vec<Option<Vec<f64>>>,
}

impl SearchBeside {
    fn new(frames: usize) -> Self {
        Self { scores: vec![Vec::new(); frames], others_rev_s: vec![None; frames] }
    }

    fn scores(&mut self, others: &[&Vec<f64>], score: impl Fn(usize, &[f64]) -> Vec<f64>) -> &[Vec<f64>] {
        for (frame, (scores, before)) in self.scores.iter_mut().zip(&mut self.others_rev_s).enumerate() {
            let now: Vec<f64> = others.iter().map(|track| track[frame]).collect();
            if before.as_ref() != Some(&now) {
                *scores = score(frame, &now);
                *before = Some(now);
            }
        }
        &self.scores
    }
}

/// The tracks of rotors whose lines have all been taken away, leaving `rest_scores`: each stays at its own offset, which is worth so
/// much in each frame, or goes where something is left over that is worth more, or where another rotor hides it. What one claims
/// is no longer there for the next; those that share another's rotor, and so are worth least, come first.
pub(super) fn reclaimed_tracks(
    rest_scores: &[Vec<f64>],
    offsets_rev_s: &[Vec<f64>],
    worths: &[&[f64]],
    grid: &OffsetGrid,
    middle_rev_s: f64,
) -> Vec<Vec<f64>> {
    let nothing: Vec<f64> = rest_scores.iter().map(|scores| worth_of_nothing(scores)).collect();
    let mut left = rest_scores.to_vec();
    let mut tracks = offsets_rev_s.to_vec();
    let total = |rotor: usize| worths[rotor].iter().sum::<f64>();
    let mut order: Vec<usize> = (0..tracks.len()).collect();
    order.sort_by(|&a, &b| total(a).total_cmp(&total(b)));
    for rotor in order {
        let scores: Vec<Vec<f64>> = left
            .iter()
            .enumerate()
            .map(|(frame, left)| {
                let mut scores = left.clone();
                for (other, track) in tracks.iter().enumerate() {
                    let worth = if other == rotor { worths[rotor][frame] } else { nothing[frame] };
                    for score in &mut scores[grid.points_around(track[frame], OWN_POINTS)] {
                        *score = worth.max(*score);
                    }
                }
                scores
            })
            .collect();
        for (frame, place) in best_path(&scores, grid.step_std(middle_rev_s)).into_iter().enumerate() {
            if !grid.points_around(tracks[rotor][frame], OWN_POINTS + 1).contains(&place) {
                let offset = grid.offset_rev_s(place);
                tracks[rotor][frame] = offset;
                for score in &mut left[frame][grid.points_around(offset, CLAIMED_POINTS)] {
                    *score = score.min(nothing[frame]);
                }
            }
        }
    }
    tracks
}

/// What the best point of a frame is worth where there is nothing but noise, as its other points tell.
fn worth_of_nothing(scores: &[f64]) -> f64 {
    let middle = median(scores).unwrap_or_default();
    let deviations: Vec<f64> = scores.iter().map(|score| (score - middle).abs()).collect();
    middle + NOTHING_DEVIATIONS * median(&deviations).unwrap_or_default()
}

/// What a line's likelihood counts for: itself where it is weak, which is what tells most in noise; its logarithm where it is strong:
/// what is left of a strong line after it was taken away must not outvote the lines of a weak rotor.
pub(super) fn worth(likelihood: f64) -> f64 {
    LINEAR_UP_TO * (likelihood / LINEAR_UP_TO).ln_1p()
}

/// Scores of the points of a grid, frame by frame.
pub(super) struct GridScores<'a> {
    lines: Vec<CountingLine<'a>>,
    common_rev_s: &'a [f64],
    residue_share: f32,
    points: usize,
}

/// A line that counts.
struct CountingLine<'a> {
    spectra: &'a LineSpectra,
    atoms: &'a ChannelAtoms,
    places: LinePlaces,
    weight: f64,
}

/// Where a line is at each point of a grid.
struct LinePlaces {
    /// The bins into which it can fall.
    bins: Range<usize>,
    /// Among them, the bin below it and how far on it is to the next.
    at_points: Vec<(u32, f32)>,
}

impl<'a> GridScores<'a> {
    pub(super) fn new(spectra: &'a Spectra, atoms: &'a [ChannelAtoms], grid: &OffsetGrid, trust: Trust<'_>) -> Self {
        let lines = spectra.lines.iter().zip(atoms).zip(trust.line_weights);
        let lines = lines.filter(|(_, weight)| **weight > 0.0).map(|((spectra, atoms), &weight)| CountingLine {
            spectra,
            atoms,
            places: LinePlaces::of(spectra, grid),
            weight,
        });
        Self {
            lines: lines.collect(),
            common_rev_s: &spectra.common_rev_s,
            residue_share: trust.residue_share,
            points: grid.points,
        }
    }

    /// What speaks for one more rotor at each point, beside others at known offsets.
    pub(super) fn of_frame(&self, frame: usize, others_rev_s: &[f64]) -> Vec<f64> {
        let mut scores = vec![0.0; self.points];
        let mut products = vec![1.0f64; self.points];
        let mut left = LeftBeside { residue_share: self.residue_share, ..LeftBeside::default() };
        let mut factors: Vec<(f32, f32)> = Vec::new();
        for (index, line) in self.lines.iter().enumerate() {
            left.take_away(line, frame, self.common_rev_s[frame], others_rev_s);
            let scale = (line.weight / LINEAR_UP_TO) as f32;
            let factor = |likelihood: f32| 1.0 + scale * likelihood.min(LIKELIHOOD_MAX);
            factors.clear();
            // of each bin, and how much the next one has more
            let pairs = left.likelihoods.iter().zip(left.likelihoods.iter().skip(1));
            factors.extend(pairs.map(|(&own, &next)| (factor(own), factor(next) - factor(own))));
            for (&(bin, share), product) in line.places.at_points.iter().zip(&mut products) {
                let (own, more) = factors[bin as usize];
                // rounding of what is likely beyond all measure must not make it unlikely
                *product *= f64::from((own + share * more).max(1.0));
            }
            // one logarithm for many lines
            if index % LINES_PER_LOGARITHM == LINES_PER_LOGARITHM - 1 || index + 1 == self.lines.len() {
                for (score, product) in scores.iter_mut().zip(&mut products) {
                    *score += LINEAR_UP_TO * std::mem::replace(product, 1.0).ln();
                }
            }
        }
        scores
    }
}

impl LinePlaces {
    fn of(line: &LineSpectra, grid: &OffsetGrid) -> Self {
        let bins = grid.bins_of(line);
        let at_points = (0..grid.points).map(|point| {
            let place =
                (line.bin_of(line.order * grid.offset_rev_s(point) * line.frame_s) - bins.start as f64).max(0.0);
            let bin = place.floor().min((bins.len() - 2) as f64);
            (bin as u32, (place - bin).min(1.0) as f32)
        });
        Self { at_points: at_points.collect(), bins }
    }
}

/// A line's likelihood in some bins of a frame, once other rotors have been taken away.
#[derive(Default)]
struct LeftBeside {
    residue_share: f32,
    likelihoods: Vec<f32>,
    left: Vec<Complex<f32>>,
    energy_left: Vec<f32>,
    /// Noise and what the others leave behind.
    floor: Vec<f32>,
    places: Vec<f64>,
    seen: Vec<Complex<f64>>,
}

impl LeftBeside {
    fn take_away(&mut self, line: &CountingLine<'_>, frame: usize, common_rev_s: f64, others_rev_s: &[f64]) {
        let Self { residue_share, likelihoods, left, energy_left, floor, places, seen } = self;
        let CountingLine { spectra: line, atoms, places: LinePlaces { bins, .. }, .. } = line;
        likelihoods.clear();
        left.clear();
        left.extend_from_slice(&line.frame(frame)[bins.clone()]);
        places.clear();
        seen.clear();
        let reached = line.cells_of(bins.start) - REACH_CELLS..line.cells_of(bins.end) + REACH_CELLS;
        for other in others_rev_s {
            for order in &atoms.orders {
                let cells = (order * (common_rev_s + other) - line.order * common_rev_s) * line.frame_s;
                if let Some(z) = line.at(frame, cells).filter(|_| reached.contains(&cells)) {
                    places.push(cells);
                    seen.push(z);
                }
            }
        }
        if places.is_empty() {
            likelihoods.extend(left.iter().map(Complex::norm_sqr));
            return;
        }
        energy_left.clear();
        energy_left.resize(left.len(), 1.0);
        floor.clear();
        floor.resize(left.len(), 1.0);
        let step_cells = line.cells_of(1) - line.cells_of(0);
        for (cells, amplitude) in places.iter().zip(Mixture::of_steady(places).amplitudes(seen)) {
            let amplitude = Complex::new(amplitude.re as f32, amplitude.im as f32);
            let bin_of = |cells: f64| line.bin_of(cells) - bins.start as f64;
            let from = bin_of(cells - REACH_CELLS).ceil().max(0.0) as usize;
            let to = ((bin_of(cells + REACH_CELLS).floor() + 1.0).max(0.0) as usize).min(left.len());
            if from >= to {
                continue;
            }
            let first_cells = line.cells_of(bins.start + from) - cells;
            let lobes = HannLobes::from(first_cells, step_cells);
            for ((left, energy), lobe) in left[from..to].iter_mut().zip(&mut energy_left[from..to]).zip(lobes) {
                *left -= amplitude * lobe;
                *energy *= 1.0 - lobe * lobe;
            }
            let residue = *residue_share * amplitude.norm_sqr();
            if residue > RESIDUE_MIN {
                let (first, step) = (first_cells as f32 / RESIDUE_CELLS, step_cells as f32 / RESIDUE_CELLS);
                for (floor, index) in floor[from..to].iter_mut().zip(0i16..) {
                    let away = first + f32::from(index) * step;
                    *floor += residue * (1.0 - away * away).max(0.0).powi(2);
                }
            }
        }
        let left = left.iter().zip(energy_left).zip(floor);
        likelihoods.extend(left.map(|((z, energy), floor)| z.norm_sqr() / (*floor * energy.max(ENERGY_LEFT_MIN))));
    }
}
