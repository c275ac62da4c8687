//! The lines of several rotors in one frame, all solved for together.

use super::frames::{Frame, leakage};
use hovertone_signal::line_solver::SolvedLines;
use realfft::num_complex::Complex;

/// On the diagonal: lines in one place share their power instead of none having any.
const RIDGE: f64 = 1e-3;
/// A search around a speed: so many steps to either side.
const SEARCH_STEPS: i32 = 6;
/// Speeds are searched, and solved for, so often in turn.
const ROUNDS: usize = 2;

type C = Complex<f64>;

/// The orders that are heard, and the power of noise at each rotor's lines: what powers are counted in.
pub(super) struct Lines {
    pub(super) orders: Vec<f64>,
    /// For each order.
    pub(super) noise: Vec<f64>,
}

/// Amplitudes in a frame: `amplitudes[rotor][order]`.
struct Solved {
    amplitudes: Vec<Vec<C>>,
    powers: Vec<f64>,
}

impl Lines {
    /// Power of each rotor's lines over that of noise, summed over the orders: what the sound loses if the rotor is left out, and
    /// those of noise alone are about as many as there are orders. A rotor in another's place has little.
    pub(super) fn powers(&self, frame: &Frame, speeds_rev_s: &[f64]) -> Vec<f64> {
        self.solved(frame, speeds_rev_s).map_or_else(|| vec![0.0; speeds_rev_s.len()], |solved| solved.powers)
    }

    /// Speeds of those rotors that are followed, near where they are expected, by the lines that the others leave.
    pub(super) fn followed(&self, frame: &Frame, expected_rev_s: &[f64], reach_share: &[f64]) -> Vec<f64> {
        let mut speeds = expected_rev_s.to_vec();
        for _ in 0..ROUNDS {
            let Some(solved) = self.solved(frame, &speeds) else { break };
            for rotor in 0..speeds.len() {
                if reach_share[rotor] <= 0.0 {
                    continue;
                }
                let step = expected_rev_s[rotor] * reach_share[rotor] / f64::from(SEARCH_STEPS);
                let candidates = (-SEARCH_STEPS..=SEARCH_STEPS).map(|k| expected_rev_s[rotor] + step * f64::from(k));
                let power = |speed: &f64| -> f64 {
                    let line = |(order, noise): (&f64, &f64)| {
                        self.left_at(frame, order * speed, rotor, &speeds, &solved).norm_sqr() / noise
                    };
                    self.orders.iter().zip(&self.noise).map(line).sum()
                };
                let best = candidates.max_by(|a, b| power(a).total_cmp(&power(b)));
                speeds[rotor] = best.unwrap_or(speeds[rotor]);
            }
        }
        speeds
    }

    /// The spectrum at a frequency without all rotors but one.
    fn left_at(&self, frame: &Frame, hz: f64, rotor: usize, speeds_rev_s: &[f64], solved: &Solved) -> C {
        let mut left = frame.at(hz);
        for (other, speed) in speeds_rev_s.iter().enumerate().filter(|(other, _)| *other != rotor) {
            for (order, amplitude) in self.orders.iter().zip(&solved.amplitudes[other]) {
                left -= amplitude * leakage(hz - order * speed);
            }
        }
        left
    }

    fn solved(&self, frame: &Frame, speeds_rev_s: &[f64]) -> Option<Solved> {
        let count = self.orders.len();
        let lines_hz: Vec<f64> =
            speeds_rev_s.iter().flat_map(|speed| self.orders.iter().map(move |order| order * speed)).collect();
        let sound: Vec<C> = lines_hz.iter().map(|&hz| frame.at(hz)).collect();
        let gram =
            |a: usize, b: usize| C::new(leakage(lines_hz[a] - lines_hz[b]) + if a == b { RIDGE } else { 0.0 }, 0.0);
        let lines = SolvedLines::from_normal_equations(gram, &sound)?;
        let power = |rotor: usize| -> f64 {
            (0..count)
                .map(|order| {
                    let line = rotor * count + order;
                    lines.amplitudes()[line].norm_sqr() / lines.variance(line) / self.noise[order]
                })
                .sum()
        };
        let powers = (0..speeds_rev_s.len()).map(power).collect();
        Some(Solved { amplitudes: lines.amplitudes().chunks(count).map(<[C]>::to_vec).collect(), powers })
    }
}
