//! The fit as a problem of least squares.

use super::inputs::LoopInputs;
use super::observation::SpeedObservation;
use super::parameters::{GreyBoxModel, PARAMETER_COUNT};
use super::prediction::SpeedPrediction;
use levenberg_marquardt::LeastSquaresProblem;
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn, Matrix4, Vector4};

/// Step of the differences that make the Jacobian, in scales of the parameters. *Numeric.*
const DIFFERENCE: f64 = 1e-4;

/// Observations, weights and priors; the parameters are in scales of the start.
pub(super) struct Problem<'a> {
    pub(super) inputs: &'a LoopInputs,
    pub(super) observations: &'a [SpeedObservation],
    /// Square root of the weight of each observation.
    pub(super) roots: Vec<Matrix4<f64>>,
    /// Where the priors are centred.
    pub(super) start: GreyBoxModel,
    pub(super) scales: [f64; PARAMETER_COUNT],
    /// Standard deviation of the prior of each parameter, in scales; 0 holds the parameter at its start.
    pub(super) prior_std: [f64; PARAMETER_COUNT],
    /// Indices of the free parameters.
    pub(super) free: Vec<usize>,
    pub(super) at: DVector<f64>,
}

impl Problem<'_> {
    /// The model at some values of the free parameters.
    pub(super) fn model(&self, at: &DVector<f64>) -> GreyBoxModel {
        let mut vector = self.start.to_vector();
        for (value, &index) in at.iter().zip(&self.free) {
            vector[index] += value * self.scales[index];
        }
        GreyBoxModel::from_vector(&vector)
    }

    /// Speeds of the model for every observation.
    fn speeds(&self, at: &DVector<f64>) -> Vec<Vector4<f64>> {
        let prediction = SpeedPrediction::new(self.inputs, &self.model(at));
        self.observations.iter().map(|observation| observation.of_prediction(&prediction)).collect()
    }

    /// The coordinates of four speeds for each observation, times the root of its weight.
    pub(super) fn weighed(&self, speeds: impl IntoIterator<Item = Vector4<f64>>) -> impl Iterator<Item = f64> {
        let weighed = self.roots.iter().zip(speeds).map(|(root, four)| root * four);
        weighed.flat_map(|four| [four[0], four[1], four[2], four[3]])
    }

    /// Observed less predicted speeds.
    pub(super) fn differences(&self) -> Vec<Vector4<f64>> {
        let speeds = self.speeds(&self.at);
        self.observations.iter().zip(speeds).map(|(observation, speed)| observation.speed_rad_s - speed).collect()
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, at: &DVector<f64>) {
        self.at.copy_from(at);
    }

    fn params(&self) -> DVector<f64> {
        self.at.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let of_data = self.weighed(self.differences());
        let of_priors = self.at.iter().zip(&self.free).map(|(value, &index)| value / self.prior_std[index]);
        let all: Vec<f64> = of_data.chain(of_priors).collect();
        all.iter().all(|residual| residual.is_finite()).then(|| DVector::from_vec(all))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let rows = 4 * self.observations.len();
        let mut jacobian = DMatrix::zeros(rows + self.free.len(), self.free.len());
        for column in 0..self.free.len() {
            let moved = |by: f64| {
                let mut at = self.at.clone();
                at[column] += by;
                self.speeds(&at)
            };
            let (above, below) = (moved(DIFFERENCE), moved(-DIFFERENCE));
            for (row, root) in self.roots.iter().enumerate() {
                let change = root * (below[row] - above[row]) / (2.0 * DIFFERENCE);
                jacobian.fixed_view_mut::<4, 1>(4 * row, column).copy_from(&change);
            }
            jacobian[(rows + column, column)] = 1.0 / self.prior_std[self.free[column]];
        }
        Some(jacobian)
    }
}
