//! One window of a line in a place with echoes: its likelihood.
//!
//! A microphone hears each rotor as it is now and, by the walls, as it was a little earlier. With echoes of random phases whose power falls
//! exponentially, the samples of a window are Gaussian with the covariance
//!
//! `R = n 1 + Σᵢ Rᵢ,   Rᵢ(t, t') = v [a eᵢ(t) eᵢ(t')* + (1 − a) ∫ exp(−d/T)/T eᵢ(t − d) eᵢ(t' − d)* dd],   eᵢ(t) = exp(j o θᵢ(t))`
//!
//! with noise n, power v of a rotor's line, share a of the direct sound, and decay T. Where the speed is steady, echoes are a part of the amplitude.

use super::heard_lines::HeardLine;
use super::place::Echoes;
use super::turns::Turns;
use super::window::{C, Window, phasor};
use nalgebra::{DMatrix, DVector, Vector4};
use std::f64::consts::TAU;

/// Length of the echoes that count, in decays. *Numeric*: 26 dB.
const DECAYS: f64 = 6.0;

/// The logarithm of the likelihood ratio of the samples of a window to "noise alone", with the speeds off the prediction by `offset_rad_s`.
pub(super) fn echoed_value(
    line: &HeardLine,
    echoes: &Echoes,
    start_s: f64,
    turns: &Turns<'_>,
    window: Window,
    offset_rad_s: &Vector4<f64>,
) -> f64 {
    let (first, last) = line.samples_of(start_s, window);
    let count = last.saturating_sub(first);
    let before = (DECAYS * echoes.decay_s() * line.rate_hz).ceil() as usize;
    let time_at = |at: usize| start_s + (first as f64 + at as f64 - before as f64) / line.rate_hz;
    let root = |at: usize| window.weight(time_at(before + at) - window.time_s).sqrt();
    let roots: Vec<f64> = (0..count).map(root).collect();
    let sample = |at: usize, _| line.sample(first + at) * phasor(line.carrier[first + at]) * roots[at];
    let samples = DVector::from_fn(count, sample);
    let turned: Vec<[f64; 4]> = (0..before + count).map(|at| turns.at(time_at(at))).collect();
    let mut covariance = DMatrix::from_diagonal_element(count, count, C::new(line.noise, 0.0));
    for (rotor, offset) in offset_rad_s.iter().enumerate() {
        let line_at = |(at, turns): (usize, &[f64; 4])| {
            phasor(line.order * (turns[rotor] + offset * (time_at(at) - window.time_s) / TAU))
        };
        let lines: Vec<C> = turned.iter().enumerate().map(line_at).collect();
        add_covariance(&mut covariance, &lines, &roots, &Echogram::of(line, echoes));
    }
    let Some(cholesky) = covariance.cholesky() else { return 0.0 };
    let determinant: f64 = (0..count).map(|at| 2.0 * cholesky.l_dirty()[(at, at)].re.ln() - line.noise.ln()).sum();
    samples.norm_squared() / line.noise - samples.dotc(&cholesky.solve(&samples)).re - determinant
}

/// The echogram in cells of one sample.
struct Echogram {
    /// Power of the direct sound with the half cell of the echoes behind it.
    at_once: f64,
    /// Power of an echo d samples later: `later · fallsᵈ`.
    later: f64,
    falls: f64,
}

impl Echogram {
    fn of(line: &HeardLine, echoes: &Echoes) -> Self {
        let falls = (-1.0 / (line.rate_hz * echoes.decay_s())).exp();
        let direct = line.amplitude_variance * echoes.direct_share;
        let echoed = line.amplitude_variance - direct;
        Self { at_once: direct + echoed * (1.0 - falls.sqrt()), later: echoed * (1.0 - falls) / falls.sqrt(), falls }
    }
}

/// Adds the covariance of a rotor to the lower triangle. `lines` begins before the window, of which `roots` are the roots of the weights.
fn add_covariance(covariance: &mut DMatrix<C>, lines: &[C], roots: &[f64], echogram: &Echogram) {
    let Echogram { at_once, later, falls } = *echogram;
    let count = roots.len();
    let before = lines.len() - count;
    // the echoes of a pair of samples are those of the pair one sample older, weaker, and a new one: along the diagonals
    for apart in 0..count {
        let pair = |column: usize| lines[column + apart] * lines[column].conj();
        let mut echoes = C::new(0.0, 0.0);
        for column in 0..before + count - apart {
            let own = pair(column);
            if let Some(column) = column.checked_sub(before) {
                let weight = roots[column + apart] * roots[column];
                covariance[(column + apart, column)] += (own * at_once + echoes * later) * weight;
            }
            echoes = (echoes + own) * falls;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_covariance_is_the_sum_over_all_echoes() {
        let (count, before) = (7, 90);
        let lines: Vec<C> = (0..before + count).map(|at| phasor(0.013 * (at * at) as f64)).collect();
        let roots: Vec<f64> = (0..count).map(|at| 0.3 + 0.1 * at as f64).collect();
        let echogram = Echogram { at_once: 0.6, later: 0.25, falls: 0.7 };
        let mut found = DMatrix::zeros(count, count);
        add_covariance(&mut found, &lines, &roots, &echogram);
        for column in 0..count {
            for row in column..count {
                let pair = |back: usize| lines[before + row - back] * lines[before + column - back].conj();
                let echoes: C = (1..=before).map(|back| pair(back) * echogram.falls.powi(back as i32)).sum();
                let expected = (pair(0) * echogram.at_once + echoes * echogram.later) * roots[row] * roots[column];
                assert!((found[(row, column)] - expected).norm() < 1e-9, "{row} {column}");
            }
        }
    }
}
