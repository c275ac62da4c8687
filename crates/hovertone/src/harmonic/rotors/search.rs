//! Where the rotors are, roughly: a path for each through a map of all lines from which the others have been taken away, each in
//! turn (RELAX), with the best path by Viterbi's algorithm.

use super::super::map::best_path;
use super::atoms::{ChannelAtoms, HannLobes, REACH_CELLS};
use super::mixture::Mixture;
use super::spectra::{LineSpectra, Spectra};
use realfft::num_complex::Complex;
use std::ops::Range;

/// Share of a line's energy that must be left to it by the others.
const ENERGY_LEFT_MIN: f32 = 0.1;
/// How much a rotor's speed changes from one frame to the next, as a share.
const STEP_STD_SHARE: f64 = 0.002;
/// Likelihoods are cut here, so that the product of so many is still a number.
const LIKELIHOOD_MAX: f32 = 1e9;
const LINES_PER_LOGARITHM: usize = 32;
/// A rotor's own track covers so many points of the grid to either side.
const OWN_POINTS: usize = 1;
/// Points of the grid in a resolution cell of the line that resolves most finely.
const GRID_PER_CELL: f64 = 2.0;

/// Speeds that are looked for, as offsets from the common speed.
pub(super) struct OffsetGrid {
    first_rev_s: f64,
    step_rev_s: f64,
    points: usize,
}

impl OffsetGrid {
    pub(super) fn new((low_rev_s, high_rev_s): (f64, f64), spectra: &Spectra) -> Self {
        let finest = spectra.lines.iter().map(|line| line.order * line.frame_s).fold(1.0, f64::max);
        let points = ((high_rev_s - low_rev_s) * finest * GRID_PER_CELL).ceil().max(2.0) as usize + 1;
        Self { first_rev_s: low_rev_s, step_rev_s: (high_rev_s - low_rev_s) / (points - 1) as f64, points }
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
) -> Vec<Vec<f64>> {
    let middle = spectra.common_rev_s.iter().sum::<f64>() / spectra.frames().max(1) as f64;
    let step_std = grid.step_std(middle);
    let track_beside = |others: &[&Vec<f64>]| -> Vec<f64> {
        let scores: Vec<Vec<f64>> = (0..spectra.frames())
            .map(|frame| {
                let others: Vec<f64> = others.iter().map(|track| track[frame]).collect();
                scores_of_frame(spectra, atoms, frame, grid, &others)
            })
            .collect();
        best_path(&scores, step_std)
            .into_iter()
            .map(|place| grid.first_rev_s + place as f64 * grid.step_rev_s)
            .collect()
    };
    let mut tracks: Vec<Vec<f64>> = start.to_vec();
    while tracks.len() < count {
        let track = track_beside(&tracks.iter().collect::<Vec<_>>());
        tracks.push(track);
    }
    if count > 1 {
        for rotor in (0..sweeps).flat_map(|_| 0..count) {
            let others: Vec<&Vec<f64>> =
                tracks.iter().enumerate().filter(|(other, _)| *other != rotor).map(|(_, track)| track).collect();
            tracks[rotor] = track_beside(&others);
        }
    }
    tracks
}

/// The track of one rotor where the lines of all rotors have been taken away: it stays at its own offset, which is worth so much
/// in each frame, or goes where something is left that is worth more.
pub(super) fn better_track(
    rest_scores: &[Vec<f64>],
    own: &[(f64, f64)],
    grid: &OffsetGrid,
    middle_rev_s: f64,
) -> Vec<f64> {
    let place_of = |offset: f64| {
        let place = ((offset - grid.first_rev_s) / grid.step_rev_s).round();
        place.clamp(0.0, grid.points as f64 - 1.0) as usize
    };
    let scores: Vec<Vec<f64>> = rest_scores
        .iter()
        .zip(own)
        .map(|(rest, (offset, worth))| {
            let mut scores = rest.clone();
            let place = place_of(*offset);
            for score in &mut scores[place.saturating_sub(OWN_POINTS)..(place + OWN_POINTS + 1).min(grid.points)] {
                *score = worth.max(*score);
            }
            scores
        })
        .collect();
    best_path(&scores, grid.step_std(middle_rev_s))
        .into_iter()
        .zip(own)
        .map(|(place, (offset, _))| {
            let is_elsewhere = place.abs_diff(place_of(*offset)) > OWN_POINTS + 1;
            if is_elsewhere { grid.first_rev_s + place as f64 * grid.step_rev_s } else { *offset }
        })
        .collect()
}

/// What a line's likelihood counts for. Its logarithm: what is left of a strong line after it was taken away must not outvote the
/// lines of a weak rotor.
pub(super) fn worth(likelihood: f64) -> f64 {
    likelihood.ln_1p()
}

/// What speaks for one more rotor at each point of the grid, beside others at known offsets.
pub(super) fn scores_of_frame(
    spectra: &Spectra,
    atoms: &[ChannelAtoms],
    frame: usize,
    grid: &OffsetGrid,
    others_rev_s: &[f64],
) -> Vec<f64> {
    let mut scores = vec![0.0; grid.points];
    let mut products = vec![1.0f64; grid.points];
    let mut left = LeftBeside::default();
    for (index, (line, atoms)) in spectra.lines.iter().zip(atoms).enumerate() {
        let bin_of =
            |point: usize| line.bin_of(line.order * (grid.first_rev_s + point as f64 * grid.step_rev_s) * line.frame_s);
        let (first, step) = (bin_of(0), bin_of(1) - bin_of(0));
        let from = (first.max(0.0) as usize).min(line.frame(frame).len() - 2);
        let to = (bin_of(grid.points - 1) as usize + 2).clamp(from + 2, line.frame(frame).len());
        left.take_away(line, atoms, (frame, from..to), spectra.common_rev_s[frame], others_rev_s);
        let last = left.likelihoods.len() - 2;
        for (point, product) in products.iter_mut().enumerate() {
            let place = (first - from as f64 + step * point as f64).max(0.0);
            let bin = (place as usize).min(last);
            let share = (place - bin as f64).min(1.0) as f32;
            let likelihood = left.likelihoods[bin] + share * (left.likelihoods[bin + 1] - left.likelihoods[bin]);
            *product *= 1.0 + f64::from(likelihood.min(LIKELIHOOD_MAX));
        }
        // one logarithm for many lines
        if index % LINES_PER_LOGARITHM == LINES_PER_LOGARITHM - 1 || index + 1 == spectra.lines.len() {
            for (score, product) in scores.iter_mut().zip(&mut products) {
                *score += std::mem::replace(product, 1.0).ln();
            }
        }
    }
    scores
}

/// A line's likelihood in some bins of a frame, once other rotors have been taken away.
#[derive(Default)]
struct LeftBeside {
    likelihoods: Vec<f32>,
    left: Vec<Complex<f32>>,
    energy_left: Vec<f32>,
    places: Vec<f64>,
    seen: Vec<Complex<f64>>,
}

impl LeftBeside {
    fn take_away(
        &mut self,
        line: &LineSpectra,
        atoms: &ChannelAtoms,
        (frame, bins): (usize, Range<usize>),
        common_rev_s: f64,
        others_rev_s: &[f64],
    ) {
        let Self { likelihoods, left, energy_left, places, seen } = self;
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
        for (cells, amplitude) in places.iter().zip(Mixture::of_steady(places).amplitudes(seen)) {
            let amplitude = Complex::new(amplitude.re as f32, amplitude.im as f32);
            let bin_of = |cells: f64| line.bin_of(cells) - bins.start as f64;
            let from = bin_of(cells - REACH_CELLS).ceil().max(0.0) as usize;
            let to = ((bin_of(cells + REACH_CELLS).floor() + 1.0).max(0.0) as usize).min(left.len());
            if from >= to {
                continue;
            }
            let lobes = HannLobes::from(line.cells_of(bins.start + from) - cells, line.cells_of(1) - line.cells_of(0));
            for ((left, energy), lobe) in left[from..to].iter_mut().zip(&mut energy_left[from..to]).zip(lobes) {
                *left -= amplitude * lobe;
                *energy *= 1.0 - lobe * lobe;
            }
        }
        likelihoods.extend(left.iter().zip(energy_left).map(|(z, energy)| z.norm_sqr() / energy.max(ENERGY_LEFT_MIN)));
    }
}
