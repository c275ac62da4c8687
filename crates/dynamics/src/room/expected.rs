//! Unknowns → expected power of each bin of each frame, and its derivatives.

use super::kernel::{Kernel, WIDTH};
use super::parameters::{Arrival, CURVE, GAINS, Layout, NOISE_KNOTS, PLACE, RoomCurve, SHARES, arrivals};
use super::spectra::{PLACES, StepSpectra, TurnFrame};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Differences of the unknowns of curve and place, for derivatives. *Numeric.*
const DIFFERENCES: [f64; CURVE + PLACE] = [5e-4, 0.01, 1e-3, 0.05, 0.1, 0.05, 0.1];
/// Unknowns with differences to both sides: those of the curve itself. *Numeric.*
const CENTRAL: usize = 3;
/// When the gains of a line are given, in time constants from the start: between them it crosses resonances of the room. *Decision.*
const GAIN_KNOTS: [f64; GAINS] = [0.0, 0.6, 1.5, 3.5];

/// What does not change during a fit.
pub(super) struct Expectation<'a> {
    spectra: &'a StepSpectra,
    pub(super) layout: Layout,
    kernel: Kernel,
    place_weights: [f64; PLACES],
    /// Speed before the step; the shares of the rotors make up for its error.
    from_rev_s: f64,
    /// Shares of the gains in each frame.
    gains: Vec<[f64; GAINS]>,
    /// Lower knot of each bin, and the share of the upper one.
    knots: Vec<(usize, f64)>,
}

/// Expected powers, frame by frame.
pub(super) struct Expected {
    pub(super) power: DVector<f64>,
    /// Derivatives, one column for each unknown.
    pub(super) slopes: DMatrix<f64>,
}

impl<'a> Expectation<'a> {
    /// `first`: the curve that the fit begins with.
    pub(super) fn new(spectra: &'a StepSpectra, first: &RoomCurve) -> Self {
        let gains = |frame: &TurnFrame| {
            let place = (frame.centre_s - first.start_s) / first.time_constant_s;
            let behind = GAIN_KNOTS.iter().position(|knot| place < *knot).unwrap_or(GAINS);
            let mut shares = [0.0; GAINS];
            if behind == 0 || behind == GAINS {
                shares[behind.min(GAINS - 1)] = 1.0;
            } else {
                let share = (place - GAIN_KNOTS[behind - 1]) / (GAIN_KNOTS[behind] - GAIN_KNOTS[behind - 1]);
                (shares[behind - 1], shares[behind]) = (1.0 - share, share);
            }
            shares
        };
        let weights: [f64; PLACES] =
            std::array::from_fn(|place| (PI * (place as f64 + 0.5) / PLACES as f64).sin().powi(4));
        let sum: f64 = weights.iter().sum();
        let bins = spectra.bin_count();
        let knot = |bin: usize| {
            // equal ratios between knots
            let ratio = ((spectra.first_bin + bin) as f64 / spectra.first_bin as f64).ln()
                / ((spectra.first_bin + bins) as f64 / spectra.first_bin as f64).ln();
            let place = ratio * (NOISE_KNOTS - 1) as f64;
            let low = (place as usize).min(NOISE_KNOTS - 2);
            (low, place - low as f64)
        };
        Self {
            spectra,
            layout: Layout::of(spectra),
            kernel: Kernel::new(),
            place_weights: weights.map(|weight| weight / sum),
            from_rev_s: first.from_rev_s,
            gains: spectra.frames.iter().map(gains).collect(),
            knots: (0..bins).map(knot).collect(),
        }
    }

    pub(super) fn cell_count(&self) -> usize {
        self.spectra.frames.len() * self.spectra.bin_count()
    }

    pub(super) fn curve(&self, unknowns: &DVector<f64>) -> RoomCurve {
        RoomCurve {
            start_s: unknowns[0],
            time_constant_s: unknowns[1].exp(),
            from_rev_s: self.from_rev_s,
            to_rev_s: self.from_rev_s * unknowns[2].exp(),
        }
    }

    /// The expected powers alone.
    pub(super) fn power(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let mut power = DVector::zeros(self.cell_count());
        let seen = self.seen(unknowns);
        self.add_lines(unknowns, &seen, &mut |cell, value, _| power[cell] += value);
        self.add_noise(unknowns, &seen, &mut |cell, value, _| power[cell] += value);
        power
    }

    /// The expected powers and their derivatives.
    pub(super) fn expected(&self, unknowns: &DVector<f64>) -> Expected {
        let mut power = DVector::zeros(self.cell_count());
        let mut slopes = DMatrix::zeros(self.cell_count(), self.layout.count());
        let seen = self.seen(unknowns);
        self.add_lines(unknowns, &seen, &mut |cell, value, unknown| {
            power[cell] += value;
            slopes[(cell, unknown)] += value;
        });
        self.add_noise(unknowns, &seen, &mut |cell, value, unknown| {
            power[cell] += value;
            slopes[(cell, unknown)] += value;
        });
        self.fill_gains(&mut slopes);
        for (at, difference) in DIFFERENCES.into_iter().enumerate() {
            let moved = |by: f64| {
                let mut moved = unknowns.clone();
                moved[at] += by;
                self.power(&moved)
            };
            let slope = if at < CENTRAL {
                (moved(difference) - moved(-difference)) / (2.0 * difference)
            } else {
                (moved(difference) - &power) / difference
            };
            slopes.set_column(at, &slope);
        }
        Expected { power, slopes }
    }

    /// A gain multiplies all shares of its line.
    fn fill_gains(&self, slopes: &mut DMatrix<f64>) {
        let bins = self.spectra.bin_count();
        for line in 0..self.layout.lines {
            let mut sum = DVector::zeros(self.cell_count());
            for share in 0..SHARES.len() {
                sum += slopes.column(self.layout.power(line, share));
            }
            for knot in 0..GAINS {
                let column = sum.map_with_location(|cell, _, value| value * self.gains[cell / bins][knot]);
                slopes.set_column(self.layout.gain(line, knot), &column);
            }
        }
    }

    /// What each frame hears: the speeds of all arrivals at all its places.
    fn seen(&self, unknowns: &DVector<f64>) -> Vec<SeenFrame> {
        let (curve, arrivals) = (self.curve(unknowns), arrivals(unknowns));
        let louder = unknowns[LOUDER];
        let total: f64 = arrivals.iter().map(|arrival| arrival.power).sum();
        let loudness = |speed_rev_s: f64| (louder * (speed_rev_s / self.from_rev_s).ln()).exp();
        let last = loudness(curve.to_rev_s);
        let frame = |frame: &TurnFrame| {
            let mut speeds = Vec::with_capacity(arrivals.len() * PLACES);
            let mut mean = 0.0;
            for place in 0..PLACES {
                for &Arrival { delay_s, power } in &arrivals {
                    let speed_rev_s = curve.at(frame.place_s[place] - delay_s);
                    let weight = power * self.place_weights[place] * loudness(speed_rev_s);
                    mean += weight / total;
                    speeds.push(Seen {
                        bins_per_order: self.spectra.turns * speed_rev_s / frame.path_rev_s[place],
                        weight,
                    });
                }
            }
            merge(&mut speeds);
            let done = if (last - 1.0).abs() > EQUAL { ((mean - 1.0) / (last - 1.0)).clamp(0.0, 1.0) } else { 0.0 };
            SeenFrame { speeds, done }
        };
        self.spectra.frames.iter().map(frame).collect()
    }

    fn add_lines(&self, unknowns: &DVector<f64>, seen: &[SeenFrame], add: &mut impl FnMut(usize, f64, usize)) {
        let bins = self.spectra.bin_count();
        for (at, frame) in seen.iter().enumerate() {
            for (line, order) in self.spectra.orders.iter().enumerate() {
                let gains = self.gains[at].iter().enumerate();
                let gain: f64 = gains.map(|(knot, share)| share * unknowns[self.layout.gain(line, knot)]).sum();
                for (share, of_mean) in SHARES.iter().enumerate() {
                    let unknown = self.layout.power(line, share);
                    let power = (unknowns[unknown] + gain).exp();
                    for seen in &frame.speeds {
                        let place = order * (1.0 + of_mean) * seen.bins_per_order - self.spectra.first_bin as f64;
                        let (first, row) = self.kernel.at(place);
                        let weight = power * seen.weight;
                        if first >= 0 && first as usize + WIDTH <= bins {
                            let cell = at * bins + first as usize;
                            row.iter().enumerate().for_each(|(bin, value)| add(cell + bin, weight * value, unknown));
                        } else {
                            let inside = (first..).zip(row).filter(|(bin, _)| (0..bins as isize).contains(bin));
                            inside.for_each(|(bin, value)| add(at * bins + bin as usize, weight * value, unknown));
                        }
                    }
                }
            }
        }
    }

    /// The noise of the rotors comes by the same ways as their lines.
    fn add_noise(&self, unknowns: &DVector<f64>, seen: &[SeenFrame], add: &mut impl FnMut(usize, f64, usize)) {
        let bins = self.spectra.bin_count();
        for (at, frame) in seen.iter().enumerate() {
            for (bin, &(low, share)) in self.knots.iter().enumerate() {
                for (knot, of_knot) in [(low, 1.0 - share), (low + 1, share)] {
                    for (side, of_side) in [1.0 - frame.done, frame.done].into_iter().enumerate() {
                        let unknown = self.layout.noise(knot, side);
                        add(at * bins + bin, of_knot * of_side * unknowns[unknown].exp(), unknown);
                    }
                }
            }
        }
    }
}

/// Place of the power of the speed among the unknowns.
const LOUDER: usize = 3;
/// Loudness that is as good as equal. *Numeric.*
const EQUAL: f64 = 1e-6;

/// What a frame hears.
struct SeenFrame {
    speeds: Vec<Seen>,
    /// Share of the change of the noise that is done.
    done: f64,
}

/// A speed that a frame hears.
#[derive(Clone, Copy)]
struct Seen {
    bins_per_order: f64,
    weight: f64,
}

/// Speeds that are as good as equal become one.
fn merge(seen: &mut Vec<Seen>) {
    seen.sort_by(|a, b| a.bins_per_order.total_cmp(&b.bins_per_order));
    let mut merged: Vec<Seen> = Vec::with_capacity(seen.len());
    let mut from = 0.0;
    for next in seen.drain(..) {
        match merged.last_mut() {
            Some(last) if next.bins_per_order < from * (1.0 + MERGED_SHARE) => {
                let weight = last.weight + next.weight;
                last.bins_per_order += (next.bins_per_order - last.bins_per_order) * next.weight / weight;
                last.weight = weight;
            }
            _ => {
                from = next.bins_per_order;
                merged.push(next);
            }
        }
    }
    *seen = merged;
}

/// Speeds closer than this are one: a tenth of a bin at order 8 and four turns. *Numeric.*
const MERGED_SHARE: f64 = 3e-3;
