//! A signal between its samples, at a cost of five multiplications per value.
//!
//! Farrow's structure: the taps of a windowed sinc, as polynomials of the fraction d of a sample,
//! `h_m(d) = Σ_k c_{k,m} d^k`. The sums over the taps, `u_k[n] = Σ_m c_{k,m} x[n+m]`, do not depend on d: they are made once
//! per signal, and each of its many paths only needs `x(n + d) = Σ_k u_k[n] d^k`.

use super::phasors::LANES;
use std::f64::consts::PI;

/// Samples needed on each side of the nearest sample.
pub(crate) const REACH: usize = 8;
/// Terms of the polynomials.
pub(crate) const TERMS: usize = 5;
/// Kaiser's window: ripples of 85 dB, for a band up to a third of the sample rate.
const WINDOW_BETA: f64 = 8.6;

/// The taps. The worst error of a sine at any fraction (the test below) is -80 dB up to
/// 0.21 of the sample rate (10 kHz at 48 kHz), -74 dB up to 0.25 (12 kHz), -62 dB up to 1/3 (16 kHz).
pub(crate) struct Interpolator {
    /// `c_{k,m}` for m = 0…REACH; `c_{k,-m} = (-1)^k c_{k,m}`.
    taps: [[f32; REACH + 1]; TERMS],
}

impl Interpolator {
    pub(crate) fn new() -> Self {
        // Through Chebyshev's points on ±1/2, where the polynomial of an analytic function is near the best one.
        let nodes: [f64; TERMS] = std::array::from_fn(|node| 0.5 * (PI * (node as f64 + 0.5) / TERMS as f64).cos());
        let polynomials: [[f64; TERMS]; REACH + 1] = std::array::from_fn(|offset| {
            polynomial(nodes, nodes.map(|fraction| windowed_sinc(offset as f64 - fraction)))
        });
        let mut taps: [[f32; REACH + 1]; TERMS] =
            std::array::from_fn(|term| polynomials.map(|coefficients| coefficients[term] as f32));
        // Middle tap: even in d; its odd terms are only rounding.
        (taps[1][0], taps[3][0]) = (0.0, 0.0);
        Self { taps }
    }

    /// `u_k` of the samples `REACH..signal.len() - REACH`, appended to `terms[k]`.
    pub(crate) fn append(&self, signal: &[f32], terms: &mut [Vec<f32>; TERMS]) {
        let count = signal.len().saturating_sub(2 * REACH);
        let first = terms[0].len();
        for term in terms.iter_mut() {
            term.resize(first + count, 0.0);
        }
        let mut sums = [[0.0_f32; LANES]; TERMS];
        if count < LANES {
            let mut padded = [0.0_f32; 2 * REACH + LANES];
            padded[..signal.len()].copy_from_slice(signal);
            self.tile(&padded, &mut sums);
            for (term, sum) in terms.iter_mut().zip(&sums) {
                term[first..].copy_from_slice(&sum[..count]);
            }
            return;
        }
        for tile in 0..count.div_ceil(LANES) {
            // The last chunk overlaps the one before and computes the same values again.
            let start = (tile * LANES).min(count - LANES);
            self.tile(&signal[start..start + 2 * REACH + LANES], &mut sums);
            for (term, sum) in terms.iter_mut().zip(&sums) {
                term[first + start..first + start + LANES].copy_from_slice(sum);
            }
        }
    }

    fn tile(&self, signal: &[f32], sums: &mut [[f32; LANES]; TERMS]) {
        let at = |offset: usize| -> [f32; LANES] {
            let mut lanes = [0.0; LANES];
            lanes.copy_from_slice(&signal[offset..offset + LANES]);
            lanes
        };
        let middle = at(REACH);
        *sums = [[0.0; LANES]; TERMS];
        for term in [0, 2, 4] {
            for lane in 0..LANES {
                sums[term][lane] = self.taps[term][0] * middle[lane];
            }
        }
        for offset in 1..=REACH {
            let (after, before) = (at(REACH + offset), at(REACH - offset));
            let c: [f32; TERMS] = std::array::from_fn(|term| self.taps[term][offset]);
            for lane in 0..LANES {
                let (even, odd) = (after[lane] + before[lane], after[lane] - before[lane]);
                sums[0][lane] += c[0] * even;
                sums[1][lane] += c[1] * odd;
                sums[2][lane] += c[2] * even;
                sums[3][lane] += c[3] * odd;
                sums[4][lane] += c[4] * even;
            }
        }
    }
}

/// `sinc(x)` under Kaiser's window of half width `REACH + 1/2`.
fn windowed_sinc(x: f64) -> f64 {
    let sinc = if x == 0.0 { 1.0 } else { (PI * x).sin() / (PI * x) };
    let share = x / (REACH as f64 + 0.5);
    sinc * bessel_i0(WINDOW_BETA * (1.0 - share * share).max(0.0).sqrt()) / bessel_i0(WINDOW_BETA)
}

/// The modified Bessel function of order zero, by its power series.
fn bessel_i0(x: f64) -> f64 {
    let (mut sum, mut term) = (1.0, 1.0);
    for number in 1..40 {
        term *= (x / 2.0 / f64::from(number)).powi(2);
        sum += term;
    }
    sum
}

/// Coefficients of the polynomial through these points: Newton's divided differences, multiplied out.
fn polynomial(nodes: [f64; TERMS], values: [f64; TERMS]) -> [f64; TERMS] {
    let mut differences = values;
    for order in 1..TERMS {
        for node in (order..TERMS).rev() {
            differences[node] = (differences[node] - differences[node - 1]) / (nodes[node] - nodes[node - order]);
        }
    }
    let mut coefficients = [0.0; TERMS];
    for node in (0..TERMS).rev() {
        for power in (1..TERMS).rev() {
            coefficients[power] = coefficients[power - 1] - nodes[node] * coefficients[power];
        }
        coefficients[0] = differences[node] - nodes[node] * coefficients[0];
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn read(terms: &[Vec<f32>; TERMS], sample: usize, fraction: f64) -> f64 {
        terms.iter().rev().fold(0.0, |sum, term| sum * fraction + f64::from(term[sample]))
    }

    /// Worst error over phases and fractions, relative to the amplitude, dB.
    fn worst_error_db(cycles_per_sample: f64) -> f64 {
        let interpolator = Interpolator::new();
        let count = 400;
        let value = |at: f64| (TAU * cycles_per_sample * at + 0.3).cos();
        let signal: Vec<f32> = (0..count).map(|sample| value(f64::from(sample)) as f32).collect();
        let mut terms = std::array::from_fn(|_| Vec::new());
        interpolator.append(&signal, &mut terms);
        assert_eq!(terms[0].len(), count as usize - 2 * REACH);
        let mut worst = 0.0_f64;
        for sample in 0..terms[0].len() {
            for step in -8..=8 {
                let fraction = f64::from(step) / 16.0;
                let expected = value((sample + REACH) as f64 + fraction);
                worst = worst.max((read(&terms, sample, fraction) - expected).abs());
            }
        }
        20.0 * worst.log10()
    }

    #[test]
    fn between_samples_a_sine_is_the_sine() {
        for (share, limit_db) in
            [(0.0025, -80.0), (0.0865, -80.0), (0.17, -80.0), (0.205, -80.0), (0.25, -74.0), (0.3333, -62.0)]
        {
            let worst = worst_error_db(share);
            assert!(worst < limit_db, "{share} of the sample rate: {worst} dB");
        }
    }

    #[test]
    fn any_number_of_samples_gives_the_same_terms() {
        let interpolator = Interpolator::new();
        let signal: Vec<f32> = (0..200).map(|sample| ((sample * sample) as f32 * 0.01).sin()).collect();
        let mut all = std::array::from_fn(|_| Vec::new());
        interpolator.append(&signal, &mut all);
        let mut parts: [Vec<f32>; TERMS] = std::array::from_fn(|_| Vec::new());
        let mut start = 0;
        for count in [1, 7, 8, 9, 30, 64, 65] {
            interpolator.append(&signal[start..start + count + 2 * REACH], &mut parts);
            start += count;
        }
        assert_eq!(parts[0].len(), 184);
        assert!(all == parts);
    }
}
