//! Power of every shaft line of every rotor in one block of sound; lines of one order are solved together.

use hovertone_signal::line_solver::{INFLATION_MAX, SolvedLines};
use realfft::num_complex::Complex;
use std::cmp::Ordering;
use std::f64::consts::{PI, TAU};

/// Amplitude by which lines of real rotors swell and fade within a block, as a share: this share of a neighbouring line leaks into a
/// line that overlaps it. *Physics.*
const SWELL_SHARE: f64 = 0.1;

type C = Complex<f64>;

/// Sums over a block, as audio samples come in, weighted by a Hann window.
pub(super) struct BlockSums {
    start_s: f64,
    block_s: f64,
    rotors: usize,
    order_max: u32,
    /// Sum of the window's weights.
    weights: f64,
    /// `sound[rotor][half − 1]`: product of the sound with the rotor's half order `half / 2`. Odd halves lie between the lines.
    sound: Vec<Vec<C>>,
    /// `pairs[order − 1][a][b]`, a < b: products of the lines of two rotors.
    pairs: Vec<Vec<Vec<C>>>,
}

/// Power of a line and of the noise at it.
#[derive(Clone, Copy)]
pub(super) struct LinePower {
    pub(super) power: f64,
    pub(super) noise: f64,
}

/// The lines of a block: `lines[rotor][order − 1]`; none where a line cannot be separated from another rotor's.
pub(super) struct BlockLines {
    lines: Vec<Vec<Option<LinePower>>>,
}

impl BlockLines {
    pub(super) fn line(&self, rotor: usize, order: u32) -> Option<LinePower> {
        *self.lines.get(rotor)?.get(order.checked_sub(1)? as usize)?
    }
}

impl BlockSums {
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

    /// Time from the start of the block to `time_s`.
    pub(super) fn length_s(&self, time_s: f64) -> f64 {
        time_s - self.start_s
    }

    /// Adds an audio sample, with the turns that each rotor's shaft has made.
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

    /// The lines of the block, order by order.
    pub(super) fn solve(&self) -> BlockLines {
        let mut lines: Vec<Vec<Option<LinePower>>> = vec![Vec::with_capacity(self.order_max as usize); self.rotors];
        for order in 1..=self.order_max as usize {
            let solved = self.solve_order(order);
            for (rotor, lines) in lines.iter_mut().enumerate() {
                lines.push(solved.as_ref().and_then(|solved| self.line_power(solved, rotor, order)));
            }
        }
        BlockLines { lines }
    }

    /// Amplitudes of the lines of one order, one for each rotor.
    fn solve_order(&self, order: usize) -> Option<SolvedLines> {
        let pairs = &self.pairs[order - 1];
        let gram = |a: usize, b: usize| match a.cmp(&b) {
            Ordering::Less => pairs[a][b],
            Ordering::Equal => C::new(self.weights, 0.0),
            Ordering::Greater => pairs[b][a].conj(),
        };
        let products: Vec<C> = self.sound.iter().map(|halves| halves[2 * order - 1]).collect();
        SolvedLines::from_normal_equations(gram, &products)
    }

    /// Power of a line, and of the noise at it: the mean power half an order below and above, which the separation inflates, and what leaks
    /// from the loudest other line as it swells.
    fn line_power(&self, solved: &SolvedLines, rotor: usize, order: usize) -> Option<LinePower> {
        let inflation = solved.variance(rotor) * self.weights;
        let power_of = |rotor: usize| solved.amplitudes()[rotor].norm_sqr();
        let others = (0..self.rotors).filter(|other| *other != rotor);
        let loudest = others.map(power_of).fold(0.0, f64::max);
        let leaked = SWELL_SHARE.powi(2) * (inflation - 1.0).max(0.0) * loudest;
        let beside = |half: usize| (self.sound[rotor][half] / self.weights).norm_sqr();
        let noise = inflation * (beside(2 * order - 2) + beside(2 * order)) / 2.0 + leaked;
        // a sine is two complex exponentials
        (inflation <= INFLATION_MAX).then_some(LinePower { power: 2.0 * power_of(rotor), noise: 2.0 * noise })
    }
}
