//! Amplitudes of lines that overlap in one frame: least squares under the frame's window.

use super::atoms::{REACH_CELLS, hann_lobe};
use realfft::num_complex::Complex;

/// Added to the diagonal of the Gram matrix: lines much closer than a resolution cell share what is there instead of
/// cancelling each other at great amplitudes.
const RIDGE: f64 = 0.02;

/// Solves for the amplitudes of lines at `places` (in resolution cells), of which each sees `seen`: `seen = G a`, G the lobes.
///
/// Lines that do not reach each other are solved by themselves: sorted by place, G is a band, and the elimination
/// stays in it.
pub(super) fn amplitudes(places: &[f64], seen: &[Complex<f64>]) -> Vec<Complex<f64>> {
    let count = places.len();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| places[a].total_cmp(&places[b]));
    // Cholesky of the band: row i holds L[i][j] for j from first[i]
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(count);
    let mut first = vec![0usize; count];
    let mut solved: Vec<Complex<f64>> = Vec::with_capacity(count);
    for i in 0..count {
        let place = places[order[i]];
        first[i] = if i == 0 { 0 } else { first[i - 1] };
        while place - places[order[first[i]]] > REACH_CELLS {
            first[i] += 1;
        }
        let mut row = Vec::with_capacity(i - first[i] + 1);
        for j in first[i]..=i {
            let from = first[i].max(first[j]);
            let mut value = hann_lobe(place - places[order[j]]) + if i == j { RIDGE } else { 0.0 };
            for k in from..j {
                let of_j = if j == i { row[k - first[i]] } else { rows[j][k - first[j]] };
                value -= row[k - first[i]] * of_j;
            }
            if i == j {
                row.push(value.max(RIDGE * RIDGE).sqrt());
            } else {
                row.push(value / rows[j][j - first[j]]);
            }
        }
        let mut y = seen[order[i]];
        for j in first[i]..i {
            y -= solved[j] * row[j - first[i]];
        }
        solved.push(y / row[i - first[i]]);
        rows.push(row);
    }
    for i in (0..count).rev() {
        solved[i] /= rows[i][i - first[i]];
        let value = solved[i];
        for j in first[i]..i {
            solved[j] -= value * rows[i][j - first[i]];
        }
    }
    let mut amplitudes = vec![Complex::default(); count];
    for (&index, value) in order.iter().zip(&solved) {
        amplitudes[index] = *value;
    }
    amplitudes
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
        for (got, wanted) in amplitudes(&places, &seen).iter().zip(&wanted) {
            assert!((got - wanted).norm() < 1e-9);
        }
        assert!(amplitudes(&[], &[]).is_empty());
        // two lines in one place share what is there
        let both = amplitudes(&[1.0, 1.0], &[Complex::new(1.0, 0.0); 2]);
        assert!((both[0] - both[1]).norm() < 1e-9 && (both[0].re - 0.5).abs() < 0.02);
    }
}
