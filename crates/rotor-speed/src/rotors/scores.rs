//! What speaks for one more rotor at each speed: the likelihood of all its lines, beside rotors that are known and echoes.

use super::atoms::{ChannelAtoms, PlacedLobe, REACH_CELLS};
use super::grid::OffsetGrid;
use super::mixture::Mixture;
use super::spectra::{LineSpectra, Spectra};
use crate::thresholds::LINE_NATS_MAX;
use realfft::num_complex::Complex;
use std::array::from_fn;
use std::ops::Range;

/// Share of a line's energy that must be left to it by the others. *Decision.*
const ENERGY_LEFT_MIN: f32 = 0.1;
/// Up to here a line counts for its likelihood, and beyond for the logarithm.
const LINEAR_UP_TO: f64 = LINE_NATS_MAX;
/// What a rotor leaves behind when it is taken away lies within so many cells of its lines. *Decision.*
const RESIDUE_CELLS: f32 = 4.0;
/// Below this share of the lines' power it counts for nothing. *Decision.*
const RESIDUE_MIN: f32 = 0.03;
/// Likelihoods are cut here, so that the product of so many is still a number. *Numeric.*
const LIKELIHOOD_MAX: f32 = 1e9;
/// Lines whose likelihoods are multiplied before a logarithm is taken. *Numeric.*
const LINES_PER_LOGARITHM: usize = 32;

/// What the spectra are taken for.
#[derive(Clone, Copy)]
pub(super) struct Trust<'a> {
    /// What each line counts.
    pub(super) line_weights: &'a [f64],
    /// Power that a rotor leaves around its lines when it is taken away, as a share of its own: neither its path nor its level is
    /// quite what is assumed.
    pub(super) residue_share: f32,
    /// Power that is still heard where it was in the next frame, as a share: what the walls send back counts as noise.
    pub(super) echo_share: f32,
}

/// What a line's likelihood counts for: itself where it is weak, which is what tells most in noise; its logarithm where it is strong:
/// what is left of a strong line after it was taken away must not outvote the lines of a weak rotor.
pub(super) fn worth(likelihood: f64) -> f64 {
    LINEAR_UP_TO * (likelihood / LINEAR_UP_TO).ln_1p()
}

/// Points of the grid that are worked on at once, which the compiler turns into vector instructions. *Numeric.*
const LANES: usize = 4;

/// Scores of the points of a grid, frame by frame.
pub(super) struct GridScores<'a> {
    lines: Vec<CountingLine<'a>>,
    common_rev_s: &'a [f64],
    /// Of the frame before.
    echo_share: f32,
    points: usize,
    left: LeftBeside,
    /// What a line multiplies the likelihood with, in each of its bins.
    factors: Vec<f32>,
    /// Product of these for each point, in whole lanes.
    products: Vec<[f64; LANES]>,
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
    /// Among them, the bin below it at each point, in whole lanes.
    below: Vec<[u32; LANES]>,
    /// How far on it is to the next bin.
    shares: Vec<[f32; LANES]>,
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
            echo_share: trust.echo_share,
            points: grid.points(),
            left: LeftBeside { residue_share: trust.residue_share, ..LeftBeside::default() },
            factors: Vec::new(),
            products: vec![[1.0; LANES]; grid.points().div_ceil(LANES)],
        }
    }

    /// What speaks for one more rotor at each point, beside others at known offsets.
    pub(super) fn of_frame(&mut self, frame: usize, others_rev_s: &[f64]) -> Vec<f64> {
        let Self { lines, common_rev_s, echo_share, left, factors, products, .. } = self;
        let mut scores = vec![0.0; self.points];
        for (index, line) in lines.iter().enumerate() {
            left.take_away(line, frame, common_rev_s[frame], others_rev_s);
            if let Some(before) = frame.checked_sub(1).filter(|_| *echo_share > 0.0) {
                let moved_rev_s = common_rev_s[frame] - common_rev_s[before];
                left.discount(line, line.spectra.frame(before), moved_rev_s, *echo_share);
            }
            let scale = (line.weight / LINEAR_UP_TO) as f32;
            factors.clear();
            factors.extend(left.likelihoods.iter().map(|likelihood| 1.0 + scale * likelihood.min(LIKELIHOOD_MAX)));
            line.places.multiply(factors, products);
            // one logarithm for many lines
            if index % LINES_PER_LOGARITHM == LINES_PER_LOGARITHM - 1 || index + 1 == lines.len() {
                for (score, product) in scores.iter_mut().zip(products.as_flattened_mut()) {
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
        let place_of = |point: usize| {
            let place = line.bin_of(line.order * grid.offset_rev_s(point) * line.frame_s) - bins.start as f64;
            place.max(0.0)
        };
        let bin_below = |place: f64| place.floor().min((bins.len() - 2) as f64);
        // the last lanes go on where the grid has ended, and count for nothing
        let places = (0..grid.points().div_ceil(LANES)).map(|lanes| from_fn(|lane| place_of(LANES * lanes + lane)));
        let (below, shares) = places
            .map(|places: [f64; LANES]| {
                let share = |place: f64| (place - bin_below(place)).min(1.0) as f32;
                (places.map(|place| bin_below(place) as u32), places.map(share))
            })
            .unzip();
        Self { bins, below, shares }
    }

    /// Multiplies the product at each point with the factor there, between those of the bins around it.
    fn multiply(&self, factors: &[f32], products: &mut [[f64; LANES]]) {
        for ((products, below), shares) in products.iter_mut().zip(&self.below).zip(&self.shares) {
            let own = below.map(|bin| factors[bin as usize]);
            let next = below.map(|bin| factors[bin as usize + 1]);
            for (lane, product) in products.iter_mut().enumerate() {
                let factor = own[lane] + shares[lane] * (next[lane] - own[lane]);
                // rounding of what is likely beyond all measure must not make it unlikely
                *product *= f64::from(if factor > 1.0 { factor } else { 1.0 });
            }
        }
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
    places: Vec<PlacedLobe>,
    seen: Vec<Complex<f64>>,
    mixture: Mixture,
}

impl LeftBeside {
    fn take_away(&mut self, line: &CountingLine<'_>, frame: usize, common_rev_s: f64, others_rev_s: &[f64]) {
        let Self { residue_share, likelihoods, left, energy_left, floor, places, seen, mixture } = self;
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
                if reached.contains(&cells)
                    && let Some(z) = line.at(frame, cells)
                {
                    places.push(PlacedLobe::at(cells));
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
        mixture.mix_steady(places);
        for (place, amplitude) in places.iter().zip(mixture.amplitudes(seen)) {
            let amplitude = Complex::new(amplitude.re as f32, amplitude.im as f32);
            let bin_of = |cells: f64| line.bin_of(cells) - bins.start as f64;
            let from = bin_of(place.cells - REACH_CELLS).ceil().max(0.0) as usize;
            let to = ((bin_of(place.cells + REACH_CELLS).floor() + 1.0).max(0.0) as usize).min(left.len());
            if from >= to {
                continue;
            }
            let lobes = place.lobes_from(line.half_cells_of(bins.start + from));
            for ((left, energy), lobe) in left[from..to].iter_mut().zip(&mut energy_left[from..to]).zip(lobes) {
                *left -= amplitude * lobe;
                *energy *= 1.0 - lobe * lobe;
            }
            let residue = *residue_share * amplitude.norm_sqr();
            if residue > RESIDUE_MIN {
                let first_cells = line.cells_of(bins.start + from) - place.cells;
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

    /// What was heard a frame before, while the common speed has moved on, is noise now.
    fn discount(&mut self, line: &CountingLine<'_>, before: &[Complex<f32>], moved_rev_s: f64, echo_share: f32) {
        let CountingLine { spectra: line, places: LinePlaces { bins, .. }, .. } = line;
        let moved_bins = line.bin_of(line.order * moved_rev_s * line.frame_s) - line.bin_of(0.0);
        let whole = moved_bins.floor();
        let share = (moved_bins - whole) as f32;
        let whole = whole as isize;
        let power = |bin: Option<usize>| bin.and_then(|bin| before.get(bin)).map_or(0.0, Complex::norm_sqr);
        for (likelihood, bin) in self.likelihoods.iter_mut().zip(bins.clone()) {
            let (own, next) = (power(bin.checked_add_signed(whole)), power(bin.checked_add_signed(whole + 1)));
            *likelihood /= 1.0 + echo_share * (own + share * (next - own));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::atoms::hann_lobe;
    use super::*;

    /// A line of order 1 in two frames of 0.2 s; in the second it has moved up and is weaker than the echo of the first.
    #[test]
    fn an_echo_is_no_rotor() {
        let frame = |lines: &[(f64, f64)]| -> Vec<Complex<f32>> {
            let at = |cells: f64| lines.iter().map(|(place, level)| level * hann_lobe(cells - place)).sum::<f64>();
            (0..160).map(|bin| Complex::new(at((f64::from(bin) - 80.0) / 2.0) as f32, 0.1)).collect()
        };
        // places are cells from the common speed, which is 5 rev/s, a cell, higher in the second frame
        let mut spectra = Spectra::of_line(&[frame(&[(-8.0, 40.0)]), frame(&[(-9.0, 20.0), (6.0, 15.0)])]);
        spectra.common_rev_s = vec![60.0, 65.0];
        let grid = OffsetGrid::new(-100.0..=100.0, &spectra);
        let atoms = [ChannelAtoms { orders: vec![1.0] }];
        let best_rev_s = |echo_share: f32| {
            let trust = Trust { line_weights: &[1.0], residue_share: 0.0, echo_share };
            let scores = GridScores::new(&spectra, &atoms, &grid, trust).of_frame(1, &[]);
            let best = (0..grid.points()).max_by(|&a, &b| scores[a].total_cmp(&scores[b])).unwrap();
            assert_eq!(grid.score_at(&scores, grid.offset_rev_s(best)), scores[best]);
            grid.offset_rev_s(best)
        };
        assert!((best_rev_s(0.0) + 45.0).abs() < 1.5);
        assert!((best_rev_s(0.3) - 30.0).abs() < 1.5);
    }
}
