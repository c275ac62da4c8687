//! The likelihood of the spectra, with beliefs, and one step of Fisher's scoring.

use super::beliefs::Beliefs;
use super::expected::Expectation;
use super::spectra::StepSpectra;
use nalgebra::{Cholesky, DMatrix, DVector};

/// The spectra as one vector, with the weight of each cell: neighbouring frames overlap, so that a cell counts as hop over length of one that
/// is independent (the squared ambiguity function of a window has a volume of one).
pub(super) struct Cells {
    power: DVector<f64>,
    weight: DVector<f64>,
}

impl Cells {
    pub(super) fn of(spectra: &StepSpectra) -> Self {
        let power = spectra.frames.iter().flat_map(|frame| frame.power.iter().copied());
        let weight = spectra.frames.iter().flat_map(|frame| {
            let weight = (spectra.hop_s / frame.length_s).min(1.0);
            frame.power.iter().map(move |_| weight)
        });
        Self {
            power: DVector::from_iterator(power.clone().count(), power),
            weight: DVector::from_iterator(weight.clone().count(), weight),
        }
    }

    /// Minus the logarithm of likelihood (Whittle) times belief.
    pub(super) fn cost(&self, expected: &DVector<f64>, unknowns: &DVector<f64>, beliefs: &Beliefs) -> f64 {
        let cells = self.power.iter().zip(expected).zip(&self.weight);
        let of_sound: f64 = cells.map(|((power, expected), weight)| weight * (power / expected + expected.ln())).sum();
        let off = unknowns - &beliefs.mean;
        of_sound + 0.5 * off.component_mul(&off).dot(&beliefs.precision)
    }
}

/// Gradient and information at some unknowns.
pub(super) struct Scored {
    gradient: DVector<f64>,
    information: DMatrix<f64>,
}

impl Scored {
    pub(super) fn at(expectation: &Expectation, cells: &Cells, unknowns: &DVector<f64>, beliefs: &Beliefs) -> Self {
        let expected = expectation.expected(unknowns);
        let root = cells.weight.map(f64::sqrt).component_div(&expected.power);
        let mut slopes = expected.slopes;
        for mut column in slopes.column_iter_mut() {
            column.component_mul_assign(&root);
        }
        let left = (&cells.power - &expected.power).component_mul(&root);
        let mut information = slopes.transpose() * &slopes;
        let off = unknowns - &beliefs.mean;
        let gradient = slopes.tr_mul(&left) - off.component_mul(&beliefs.precision);
        for at in 0..information.nrows() {
            information[(at, at)] += beliefs.precision[at];
        }
        Self { gradient, information }
    }

    /// Damped step (Marquardt 1963).
    pub(super) fn step(&self, damping: f64) -> Option<DVector<f64>> {
        let mut damped = self.information.clone();
        for at in 0..damped.nrows() {
            damped[(at, at)] *= 1.0 + damping;
        }
        Some(Cholesky::new(damped)?.solve(&self.gradient))
    }

    /// Covariance of the unknowns.
    pub(super) fn covariance(&self) -> Option<DMatrix<f64>> {
        Some(Cholesky::new(self.information.clone())?.inverse())
    }
}
