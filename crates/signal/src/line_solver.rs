//! Amplitudes of lines that overlap, by least squares.
//!
//! A stretch of sound x holds lines `Σ a_j φ_j` of known shapes `φ_j` and unknown complex amplitudes `a_j`. The weighted least-squares
//! amplitudes solve the normal equations
//!
//! `G a = s`,  `G_ij = Σ_n w_n φ_i*[n] φ_j[n]`,  `s_i = Σ_n w_n φ_i*[n] x[n]`.
//!
//! In white noise the covariance of `a` is `G⁻¹` times the noise power. Its diagonal times `G_ii` is the variance inflation factor of a
//! line (Marquardt 1970): 1 for a line by itself, large for lines that can hardly be separated.

use nalgebra::DMatrix;
use realfft::num_complex::Complex;

type C = Complex<f64>;

/// Largest variance inflation factor of a line that counts as separated: 10, the usual limit in regression (Marquardt 1970). *Decision.*
pub const INFLATION_MAX: f64 = 10.0;

/// The lines of one stretch, solved together.
#[derive(Clone, Debug)]
pub struct SolvedLines {
    amplitudes: Vec<C>,
    variances: Vec<f64>,
}

impl SolvedLines {
    /// Solves the normal equations of `products.len()` lines. `gram(i, j)` gives `G_ij`, `products` are the `s_i`; units are those of the
    /// caller. `None` where the Gram matrix has no inverse.
    ///
    /// Cost: of the order of n³ for n lines, which is meant for some tens of lines.
    pub fn from_normal_equations(gram: impl Fn(usize, usize) -> C, products: &[C]) -> Option<Self> {
        let count = products.len();
        let inverse = DMatrix::from_fn(count, count, gram).lu().try_inverse()?;
        let amplitude = |line: usize| (0..count).map(|other| inverse[(line, other)] * products[other]).sum();
        Some(Self {
            amplitudes: (0..count).map(amplitude).collect(),
            variances: (0..count).map(|line| inverse[(line, line)].re).collect(),
        })
    }

    /// Complex amplitude of each line.
    pub fn amplitudes(&self) -> &[C] {
        &self.amplitudes
    }

    /// Variance of a line's amplitude over the power of the noise: the diagonal of `G⁻¹`.
    pub fn variance(&self, line: usize) -> f64 {
        self.variances[line]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Three complex exponentials of which two lie 0.7 bins apart, without noise: the amplitudes come out as they went in.
    #[test]
    fn amplitudes_of_overlapping_lines_are_recovered() {
        let (count, cells) = (200_usize, [3.0, 3.7, 9.2]);
        let truth = [C::new(1.0, 0.5), C::new(-0.3, 0.8), C::new(0.02, 0.0)];
        let weight = |n: usize| 0.5 - 0.5 * (TAU * (n as f64 + 0.5) / count as f64).cos();
        let shape = |line: usize, n: usize| C::from_polar(1.0, TAU * cells[line] * n as f64 / count as f64);
        let sound = |n: usize| (0..3).map(|line| truth[line] * shape(line, n)).sum::<C>();
        let gram = |a: usize, b: usize| (0..count).map(|n| shape(a, n).conj() * shape(b, n) * weight(n)).sum::<C>();
        let products: Vec<C> =
            (0..3).map(|line| (0..count).map(|n| shape(line, n).conj() * sound(n) * weight(n)).sum()).collect();
        let solved = SolvedLines::from_normal_equations(gram, &products).unwrap();
        for (amplitude, truth) in solved.amplitudes().iter().zip(truth) {
            assert!((amplitude - truth).norm() < 1e-12, "{amplitude} {truth}");
        }
        let inflation = |line: usize| solved.variance(line) * gram(line, line).re;
        assert!(inflation(0) > 2.0 && inflation(1) > 2.0, "{} {}", inflation(0), inflation(1));
        assert!((inflation(2) - 1.0).abs() < 0.01, "{}", inflation(2));
    }

    #[test]
    fn the_same_line_twice_has_no_solution() {
        let products = [C::new(1.0, 0.0); 2];
        assert!(SolvedLines::from_normal_equations(|_, _| C::new(1.0, 0.0), &products).is_none());
        assert!(SolvedLines::from_normal_equations(|_, _| C::default(), &products).is_none());
    }
}
