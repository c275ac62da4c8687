//! The amplitudes of all rotors' lines in one block of sound, those of one order solved for together.

use hovertone_signal::line_solver::{INFLATION_MAX, SolvedLines};
use realfft::num_complex::Complex;
use std::cmp::Ordering;
use std::f64::consts::{PI, TAU};

/// Lines of real rotors swell and fade by this share within a block; so much of one that is near leaks into another.
const SWELL_SHARE: f64 = 0.1;

type C = Complex<f64>;

/// Sums over a block, as samples come in.
pub(super) struct LineSums {
    start_s: f64,
    block_s: f64,
    rotors: usize,
    order_max: u32,
    weights: f64,
    /// Products of the sound with each rotor's half orders: `sound[rotor][half − 1]`; odd halves are between the lines.
    sound: Vec<Vec<C>>,
    /// Products of the rotors' lines with each other: `pairs[order − 1][a][b]`.
    pairs: Vec<Vec<Vec<C>>>,
}

/// Power of each line in a block, and of noise, where it is apart from others: `lines[rotor][order − 1]`.
pub(super) struct BlockLines {
    lines: Vec<Vec<Option<(f64, f64)>>>,
}

impl BlockLines {
    pub(super) fn power(&self, rotor: usize, order: u32) -> Option<(f64, f64)> {
        *self.lines.get(rotor)?.get(order.checked_sub(1)? as usize)?
    }
}

impl LineSums {
    pub(super) fn new(start_s: f64, block_s: f64, rotors: usize, order_max: u32) -> Self {
        let halves = 2 * order_max as usize + 1;
        let pairs = vec![vec![vec![C::default(); rotors]; rotors]; order_max as usize];
        Self {
            start_s,
            block_s,
            rotors,
            order_max,
            weights: 0.0,
            sound: vec![vec![C::default(); halves]; rotors],
            pairs,
        }
    }

    pub(super) fn has_lasted_s(&self, time_s: f64) -> f64 {
        time_s - self.start_s
    }

    /// A sample, and the turns of each rotor at its time.
    pub(super) fn add(&mut self, sample: f64, time_s: f64, turns: &[f64]) {
        let weight = 0.5 - 0.5 * (TAU * (time_s - self.start_s) / self.block_s).cos();
        self.weights += weight;
        let half_turns: Vec<C> = turns
            .iter()
            .map(|turns| {
                let (im, re) = (PI * (turns % 2.0)).sin_cos();
                C::new(re, im)
            })
            .collect();
        let mut powers = half_turns.clone();
        for half in 0..2 * self.order_max as usize + 1 {
            for (sums, power) in self.sound.iter_mut().zip(&powers) {
                sums[half] += power.conj() * (weight * sample);
            }
            if half % 2 == 1 {
                let pairs = &mut self.pairs[half / 2];
                for a in 0..self.rotors {
                    for b in a + 1..self.rotors {
                        pairs[a][b] += powers[a].conj() * powers[b] * weight;
                    }
                }
            }
            powers.iter_mut().zip(&half_turns).for_each(|(power, step)| *power *= step);
        }
    }

    pub(super) fn solved(&self) -> BlockLines {
        let lines = (0..self.rotors).map(|_| Vec::with_capacity(self.order_max as usize)).collect();
        let mut block = BlockLines { lines };
        for order in 1..=self.order_max as usize {
            let pairs = &self.pairs[order - 1];
            let entry = |a: usize, b: usize| match a.cmp(&b) {
                Ordering::Less => pairs[a][b],
                Ordering::Equal => C::new(self.weights, 0.0),
                Ordering::Greater => pairs[b][a].conj(),
            };
            let products: Vec<C> = self.sound.iter().map(|halves| halves[2 * order - 1]).collect();
            let solved = SolvedLines::from_normal_equations(entry, &products);
            for rotor in 0..self.rotors {
                let line = solved.as_ref().and_then(|solved| {
                    let inflation = solved.variance(rotor) * self.weights;
                    let power_of = |rotor: usize| solved.amplitudes()[rotor].norm_sqr();
                    let others = (0..self.rotors).filter(|other| *other != rotor);
                    let loudest = others.map(power_of).fold(0.0, f64::max);
                    let leaked = SWELL_SHARE.powi(2) * (inflation - 1.0).max(0.0) * loudest;
                    // of noise alone: between this line and its neighbours
                    let beside = |half: usize| (self.sound[rotor][half] / self.weights).norm_sqr();
                    let noise = inflation * (beside(2 * order - 2) + beside(2 * order)) / 2.0 + leaked;
                    (inflation <= INFLATION_MAX).then_some((2.0 * power_of(rotor), 2.0 * noise))
                });
                block.lines[rotor].push(line);
            }
        }
        block
    }
}
