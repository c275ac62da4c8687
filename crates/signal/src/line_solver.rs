//! Small matrices.

use realfft::num_complex::Complex;

type C = Complex<f64>;

/// A line whose variance those of other rotors, solved for together with it, widen by more than this factor is not apart from them.
pub const INFLATION_MAX: f64 = 10.0;

/// The inverse of a small matrix by Gauss and Jordan; `None` where there is none.
pub fn inverse(mut matrix: Vec<Vec<C>>) -> Option<Vec<Vec<C>>> {
    let size = matrix.len();
    for (row, values) in matrix.iter_mut().enumerate() {
        values.extend((0..size).map(|column| C::new(f64::from(u8::from(column == row)), 0.0)));
    }
    for pivot in 0..size {
        let best =
            (pivot..size).max_by(|&a, &b| matrix[a][pivot].norm_sqr().total_cmp(&matrix[b][pivot].norm_sqr()))?;
        matrix.swap(pivot, best);
        let scale = matrix[pivot][pivot];
        if scale.norm_sqr() <= f64::MIN_POSITIVE {
            return None;
        }
        matrix[pivot].iter_mut().for_each(|value| *value /= scale);
        let of_pivot = matrix[pivot].clone();
        for (_, values) in matrix.iter_mut().enumerate().filter(|(row, _)| *row != pivot) {
            let factor = values[pivot];
            values.iter_mut().zip(&of_pivot).for_each(|(value, of_pivot)| *value -= factor * of_pivot);
        }
    }
    Some(matrix.into_iter().map(|row| row[size..].to_vec()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_times_its_inverse_is_one() {
        let entry = |a: usize, b: usize| C::new(1.0 / (1.0 + (a + 2 * b) as f64), (a as f64 - b as f64) * 0.3);
        let matrix: Vec<Vec<C>> = (0..4).map(|a| (0..4).map(|b| entry(a, b)).collect()).collect();
        let inverse = inverse(matrix.clone()).unwrap();
        for (a, row) in matrix.iter().enumerate() {
            for b in 0..4 {
                let product: C = row.iter().zip(&inverse).map(|(value, column)| value * column[b]).sum();
                assert!((product - C::new(f64::from(u8::from(a == b)), 0.0)).norm() < 1e-10);
            }
        }
        assert!(super::inverse(vec![vec![C::default(); 2]; 2]).is_none());
    }
}
