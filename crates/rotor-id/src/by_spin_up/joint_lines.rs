//! The lines of several rotors in one frame, solved together.

use super::frames::{Frame, leakage};
use hovertone_signal::line_solver::SolvedLines;
use realfft::num_complex::Complex;

/// Ridge on the diagonal of the normal equations: two lines at one frequency share their power. *Numeric.*
const RIDGE: f64 = 1e-3;
/// Number of steps to either side in the search of a speed. *Numeric.*
const SEARCH_STEPS: i32 = 6;
/// Rounds in which amplitudes are solved and then speeds are searched. *Numeric.*
const ROUNDS: usize = 2;

type C = Complex<f64>;

/// The lines in use.
pub(super) struct JointLines {
    pub(super) orders: Vec<f64>,
    /// Power of the noise at the line of each order: the unit of all powers.
    pub(super) noise: Vec<f64>,
}

/// Amplitudes and powers of the rotors in a frame.
struct Solved {
    /// `amplitudes[rotor][order]`.
    amplitudes: Vec<Vec<C>>,
    /// For each rotor.
    powers: Vec<f64>,
}

impl JointLines {
    /// Power of each rotor's lines over that of the noise, summed over the orders: the power that the sound loses without the rotor. A rotor
    /// at the speed of another one has little of it. Noise alone gives about the number of orders.
    pub(super) fn powers(&self, frame: &Frame, speeds_rev_s: &[f64]) -> Vec<f64> {
        self.solve(frame, speeds_rev_s).map_or_else(|| vec![0.0; speeds_rev_s.len()], |solved| solved.powers)
    }

    /// Speeds near the expected ones: each maximises the power of its rotor in the sound without the other rotors, in turn, as in RELAX (Li
    /// and Stoica 1996). `reach_share` is the largest change of each speed; at 0 the speed stays.
    pub(super) fn speeds_near(&self, frame: &Frame, expected_rev_s: &[f64], reach_share: &[f64]) -> Vec<f64> {
        let mut speeds = expected_rev_s.to_vec();
        for _ in 0..ROUNDS {
            let Some(solved) = self.solve(frame, &speeds) else { break };
            for rotor in 0..speeds.len() {
                if reach_share[rotor] <= 0.0 {
                    continue;
                }
                let step = expected_rev_s[rotor] * reach_share[rotor] / f64::from(SEARCH_STEPS);
                let candidates = (-SEARCH_STEPS..=SEARCH_STEPS).map(|k| expected_rev_s[rotor] + step * f64::from(k));
                let power = |speed: &f64| -> f64 {
                    let line = |(order, noise): (&f64, &f64)| {
                        self.without_others(frame, order * speed, rotor, &speeds, &solved).norm_sqr() / noise
                    };
                    self.orders.iter().zip(&self.noise).map(line).sum()
                };
                let best = candidates.max_by(|a, b| power(a).total_cmp(&power(b)));
                speeds[rotor] = best.unwrap_or(speeds[rotor]);
            }
        }
        speeds
    }

    /// The spectrum at a frequency, minus the lines of all rotors but one.
    fn without_others(&self, frame: &Frame, hz: f64, rotor: usize, speeds_rev_s: &[f64], solved: &Solved) -> C {
        let mut rest = frame.at(hz);
        for (other, speed) in speeds_rev_s.iter().enumerate().filter(|(other, _)| *other != rotor) {
            for (order, amplitude) in self.orders.iter().zip(&solved.amplitudes[other]) {
                rest -= amplitude * leakage(hz - order * speed);
            }
        }
        rest
    }

    fn solve(&self, frame: &Frame, speeds_rev_s: &[f64]) -> Option<Solved> {
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
