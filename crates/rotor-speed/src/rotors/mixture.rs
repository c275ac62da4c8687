//! Amplitudes of lines that overlap in one frame: least squares under the frame's window.

use super::atoms::{PlacedLobe, REACH_CELLS};
use realfft::num_complex::Complex;

/// Added to the diagonal of the Gram matrix: lines much closer than a resolution cell share what is there instead of
/// cancelling each other at great amplitudes. *Numeric.*
const RIDGE: f64 = 0.02;

/// The Gram matrix G of the lines of a frame, ready to be solved: `G[i][j]` is what line i sees of line j at amplitude 1.
///
/// Lines that do not reach each other are solved by themselves: sorted by place, G is a band, and its Cholesky factor
/// stays in it. One mixture serves for one frame after the other.
#[derive(Default)]
pub(super) struct Mixture {
    /// Lines by place.
    order: Vec<usize>,
    rows: Vec<Row>,
    factors: Vec<Complex<f64>>,
    /// Scratch: values in the order of places.
    values: Vec<Complex<f64>>,
    amplitudes: Vec<Complex<f64>>,
}

/// A row of the factor holds its columns from `first` to its diagonal.
#[derive(Clone, Copy)]
struct Row {
    first: usize,
    /// Where that one is among all factors.
    start: usize,
}

impl Row {
    fn place(self, column: usize) -> usize {
        self.start + column - self.first
    }
}

impl Mixture {
    /// Mixes steady lines.
    pub(super) fn mix_steady(&mut self, lines: &[PlacedLobe]) {
        let gram = |a: usize, b: usize| Complex::new(lines[a].at_place_of(lines[b]), 0.0);
        self.mix(lines.len(), |line| lines[line].cells, gram);
    }

    /// Mixes so many lines, each around a place in resolution cells.
    pub(super) fn mix(
        &mut self,
        count: usize,
        place: impl Fn(usize) -> f64,
        gram: impl Fn(usize, usize) -> Complex<f64>,
    ) {
        let Self { order, rows, factors, .. } = self;
        order.clear();
        order.extend(0..count);
        order.sort_unstable_by(|&a, &b| place(a).total_cmp(&place(b)));
        rows.clear();
        factors.clear();
        for i in 0..count {
            let mut first = rows.last().map_or(0, |row| row.first);
            while place(order[i]) - place(order[first]) > REACH_CELLS {
                first += 1;
            }
            let row = Row { first, start: factors.len() };
            for j in first..i {
                let other = rows[j];
                let from = first.max(other.first);
                let own = &factors[row.place(from)..];
                let others = &factors[other.place(from)..other.place(j)];
                let known: Complex<f64> = own.iter().zip(others).map(|(own, other)| own * other.conj()).sum();
                factors.push((gram(order[i], order[j]) - known) / factors[other.place(j)].re);
            }
            let others: f64 = factors[row.place(first)..].iter().map(Complex::norm_sqr).sum();
            factors.push(Complex::new((1.0 + RIDGE - others).max(RIDGE * RIDGE).sqrt(), 0.0));
            rows.push(row);
        }
    }

    /// The amplitudes of lines that see `seen`, but for what the ridge takes of them.
    pub(super) fn amplitudes(&mut self, seen: &[Complex<f64>]) -> &[Complex<f64>] {
        let mut solved = std::mem::take(&mut self.values);
        solved.clear();
        solved.extend(self.order.iter().map(|&line| seen[line]));
        self.eliminate(&mut solved, 0);
        for i in (0..solved.len()).rev() {
            solved[i] /= self.diagonal(i);
            let value = solved[i];
            let first = self.rows[i].first;
            for (other, factor) in solved[first..i].iter_mut().zip(self.columns(i, first)) {
                *other -= value * factor.conj();
            }
        }
        self.amplitudes.resize(seen.len(), Complex::default());
        for (&line, value) in self.order.iter().zip(&solved) {
            self.amplitudes[line] = *value;
        }
        self.values = solved;
        &self.amplitudes
    }

    /// Share of a line's energy that no other line can explain, `1 / (G⁻¹)[line][line]`.
    pub(super) fn share_of_its_own(&mut self, line: usize) -> f64 {
        let Some(place) = self.order.iter().position(|&other| other == line) else { return 0.0 };
        let mut unit = std::mem::take(&mut self.values);
        unit.clear();
        unit.resize(self.order.len(), Complex::default());
        unit[place] = Complex::new(1.0, 0.0);
        self.eliminate(&mut unit, place);
        let seen_by_all: f64 = unit[place..].iter().map(Complex::norm_sqr).sum();
        self.values = unit;
        // two lines in one place leave twice the ridge
        (1.0 / seen_by_all - 2.0 * RIDGE).max(0.0)
    }

    /// Solves with the lower factor; nothing stands before `from`.
    fn eliminate(&self, values: &mut [Complex<f64>], from: usize) {
        for i in from..values.len() {
            let start = self.rows[i].first.max(from).min(i);
            let factors = self.columns(i, start);
            let known: Complex<f64> = values[start..i].iter().zip(factors).map(|(value, factor)| value * factor).sum();
            values[i] = (values[i] - known) / self.diagonal(i);
        }
    }

    /// The factor's row i from a column to before its diagonal.
    fn columns(&self, i: usize, from: usize) -> &[Complex<f64>] {
        let row = self.rows[i];
        &self.factors[row.place(from)..row.place(i)]
    }

    fn diagonal(&self, i: usize) -> f64 {
        self.factors[self.rows[i].place(i)].re
    }
}

#[cfg(test)]
mod tests {
    use super::super::atoms::hann_lobe;
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
        let mut mixture = Mixture::default();
        mixture.mix_steady(&places.map(PlacedLobe::at));
        for (got, wanted) in mixture.amplitudes(&seen).iter().zip(&wanted) {
            assert!((got - wanted).norm() < 1e-9);
        }
        // a line by itself is all its own; two in one place explain each other
        assert!((mixture.share_of_its_own(6) - 1.0 + RIDGE).abs() < 1e-9);
        mixture.mix_steady(&[1.0, 1.0].map(PlacedLobe::at));
        let both = mixture.amplitudes(&[Complex::new(1.0, 0.0); 2]);
        assert!((both[0] - both[1]).norm() < 1e-9 && (both[0].re - 0.5).abs() < 0.02);
        assert!(mixture.share_of_its_own(0) < 0.001);
        mixture.mix_steady(&[]);
        assert!(mixture.amplitudes(&[]).is_empty());
    }
}
