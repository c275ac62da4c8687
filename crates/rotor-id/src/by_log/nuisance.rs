//! Nuisance series: common to all rotors, so without information about a single one. They are projected out of all series.

/// Rest of a nuisance series after projection, as a share of its square, below which it is a rounding error. *Numeric.*
const REST_SHARE_MIN: f64 = 1e-12;

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The mean of several series, value by value.
pub(super) fn mean_series(series: &[Vec<f64>]) -> Vec<f64> {
    let length = series.first().map_or(0, Vec::len);
    (0..length).map(|index| series.iter().map(|values| values[index]).sum::<f64>() / series.len() as f64).collect()
}

/// An orthogonal basis of white nuisance series.
pub(super) struct NuisanceBasis {
    directions: Vec<Vec<f64>>,
    /// `Σ ln` of the directions' squares: what the integral over the nuisance coefficients, with flat priors, adds to the determinant.
    pub(super) ln_determinant: f64,
}

impl NuisanceBasis {
    /// The basis of white series (Gram-Schmidt); a series that depends linearly on the earlier ones adds no direction.
    pub(super) fn from_white(series: impl IntoIterator<Item = Vec<f64>>) -> Self {
        let mut basis = Self { directions: Vec::new(), ln_determinant: 0.0 };
        for series in series {
            let whole = dot(&series, &series);
            let rest = basis.projected_out(series);
            let square = dot(&rest, &rest);
            if square > REST_SHARE_MIN * whole {
                basis.ln_determinant += square.ln();
                basis.directions.push(rest);
            }
        }
        basis
    }

    pub(super) fn len(&self) -> usize {
        self.directions.len()
    }

    /// A series minus its projection on the basis.
    pub(super) fn projected_out(&self, mut series: Vec<f64>) -> Vec<f64> {
        for direction in &self.directions {
            let share = dot(direction, &series) / dot(direction, direction);
            series.iter_mut().zip(direction).for_each(|(value, along)| *value -= share * along);
        }
        series
    }
}
