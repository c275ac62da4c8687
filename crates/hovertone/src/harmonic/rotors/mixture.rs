//! Amplitudes of lines that overlap in one frame: least squares under the frame's window.

use super::atoms::{REACH_CELLS, hann_lobe};
use realfft::num_complex::Complex;

/// Added to the diagonal of the Gram matrix: lines much closer than a resolution cell share what is there instead of
/// cancelling each other at great amplitudes.
const RIDGE: f64 = 0.02;

/// The Gram matrix G of the lines of a frame, ready to be solved: `G[i][j]` is what line i sees of line j at amplitude 1.
///
/// Lines that do not reach each other are solved by themselves: sorted by place, G is a band, and its Cholesky factor
/// stays in it.
pub(super) struct Mixture {
    /// Lines by place.
    order: Vec<usize>,
    /// Row i of the factor holds its columns from `first[i]` to i.
    first: Vec<usize>,
    rows: Vec<Vec<Complex<f64>>>,
}

impl Mixture {
    /// Of steady lines at `places`, in resolution cells.
    pub(super) fn of_steady(places: &[f64]) -> Self {
        Self::new(places, |a, b| Complex::new(hann_lobe(places[a] - places[b]), 0.0))
    }

    /// Of lines around `places`, in resolution cells.
    pub(super) fn new(places: &[f64], gram: impl Fn(usize, usize) -> Complex<f64>) -> Self {
        let count = places.len();
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&a, &b| places[a].total_cmp(&places[b]));
        let mut rows: Vec<Vec<Complex<f64>>> = Vec::with_capacity(count);
        let mut first = vec![0usize; count];
        for i in 0..count {
            first[i] = if i == 0 { 0 } else { first[i - 1] };
            while places[order[i]] - places[order[first[i]]] > REACH_CELLS {
                first[i] += 1;
            }
            let mut row = Vec::with_capacity(i - first[i] + 1);
            for j in first[i]..i {
                let mut value = gram(order[i], order[j]);
                for k in first[i].max(first[j])..j {
                    value -= row[k - first[i]] * rows[j][k - first[j]].conj();
                }
                row.push(value / rows[j][j - first[j]].re);
            }
            let others: f64 = row.iter().map(Complex::norm_sqr).sum();
            row.push(Complex::new((1.0 + RIDGE - others).max(RIDGE * RIDGE).sqrt(), 0.0));
            rows.push(row);
        }
        Self { order, first, rows }
    }

    /// The amplitudes of lines that see `seen`, but for what the ridge takes of them.
    pub(super) fn amplitudes(&self, seen: &[Complex<f64>]) -> Vec<Complex<f64>> {
        let mut solved: Vec<Complex<f64>> = self.order.iter().map(|&line| seen[line]).collect();
        self.eliminate(&mut solved, 0);
        for i in (0..solved.len()).rev() {
            solved[i] /= self.diagonal(i);
            let value = solved[i];
            for (other, factor) in solved[self.first[i]..i].iter_mut().zip(&self.rows[i]) {
                *other -= value * factor.conj();
            }
        }
        let mut amplitudes = vec![Complex::default(); seen.len()];
        for (&line, value) in self.order.iter().zip(&solved) {
            amplitudes[line] = *value;
        }
        amplitudes
    }

    /// Share of a line's energy that no other line can explain, `1 / (G⁻¹)[line][line]`.
    pub(super) fn share_of_its_own(&self, line: usize) -> f64 {
        let Some(place) = self.order.iter().position(|&other| other == line) else { return 0.0 };
        let mut unit = vec![Complex::default(); self.order.len()];
        unit[place] = Complex::new(1.0, 0.0);
        self.eliminate(&mut unit, place);
        // two lines in one place leave twice the ridge
        (1.0 / unit[place..].iter().map(Complex::norm_sqr).sum::<f64>() - 2.0 * RIDGE).max(0.0)
    }

    /// Solves with the lower factor; nothing stands before `from`.
    fn eliminate(&self, values: &mut [Complex<f64>], from: usize) {
        for i in from..values.len() {
            let start = self.first[i].max(from);
            let factors = &self.rows[i][start.min(i) - self.first[i]..];
            let known: Complex<f64> =
                values[start.min(i)..i].iter().zip(factors).map(|(value, factor)| value * factor).sum();
            values[i] = (values[i] - known) / self.diagonal(i);
        }
    }

    fn diagonal(&self, i: usize) -> f64 {
        self.rows[i][i - self.first[i]].re
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlapping_lines_get_their_own_amplitudes_back() {
        let places = [30.0, 3.2, -1.0, 0.3, 1.9, 29.0, 100.0];
        let wanted: Vec<Complex<f64>> =
            (0..places.len()).map(|k| Complex::from_polar(1.0 + k as f64 / 3.0, 1.7 * k as f64)).collect();
        let seen: Vec<Complex<f64>> = places
            .iter()
            .zip(&wanted)
            .map(|(place, own)| {
                let others: Complex<f64> = places.iter().zip(&wanted).map(|(p, a)| a * hann_lobe(place - p)).sum();
                others + own * RIDGE
            })
            .collect();
        let mixture = Mixture::of_steady(&places);
        for (got, wanted) in mixture.amplitudes(&seen).iter().zip(&wanted) {
            assert!((got - wanted).norm() < 1e-9);
        }
        // a line by itself is all its own; two in one place explain each other
        assert!((mixture.share_of_its_own(6) - 1.0 + RIDGE).abs() < 1e-9);
        let twice = Mixture::of_steady(&[1.0, 1.0]);
        let both = twice.amplitudes(&[Complex::new(1.0, 0.0); 2]);
        assert!((both[0] - both[1]).norm() < 1e-9 && (both[0].re - 0.5).abs() < 0.02);
        assert!(twice.share_of_its_own(0) < 0.001);
        assert!(Mixture::of_steady(&[]).amplitudes(&[]).is_empty());
    }
}
