//! The fit: prediction errors by least squares (Levenberg 1944, Marquardt 1963; Ljung, System Identification, 1999, chapter 7).

use super::information::{Information, information_of};
use super::inputs::LoopInputs;
use super::observation::SpeedObservation;
use super::overlap::overlap_shift;
use super::parameters::{GreyBoxModel, PARAMETER_COUNT, Parameter};
use super::prediction::SpeedPrediction;
use super::problem::Problem;
use super::residuals::{Wander, square_root};
use hovertone_vehicle::{Axis, Ending, Estimate, SOUND_M_S};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Matrix4, Vector4};

/// Fewest observations. *Numeric*: some ten for each parameter that counts.
const OBSERVATIONS_MIN: usize = 200;
/// Share of the observations within the log from which the two clocks are taken to fit: the ends of the log hold none. *Decision.*
const OVERLAP_SHARE_MIN: f64 = 0.8;
/// Standard deviation of an even distribution over its width. *Physics.*
const EVEN_STD: f64 = 0.288_675;
/// Standard deviation of the sine of the elevation of a microphone, where all directions are equally probable: 1/√3. *Physics.*
const SINE_STD: f64 = 0.577_350;

/// Settings of the fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GreyBoxConfig {
    /// Rounds of fit and noise. *Numeric*: the noise settles within three.
    pub rounds: usize,
    /// Most observations: of more, each second, third, … is taken. *Numeric.*
    pub observations_max: usize,
    /// Wander at the first round, as a share of the speed. *Physics*: rotors in flight wander by 0.2 %.
    pub wander_share_first: f64,
    /// Time over which differences from the model count as correlated. *Physics*: gusts and motors wander for half a second.
    pub correlated_s: f64,
    /// A parameter is told if its standard uncertainty is below this share of what was known before the flight. *Decision.*
    pub told_share: f64,
    /// Largest tolerance of the optimiser. *Numeric.*
    pub tolerance: f64,
}

impl Default for GreyBoxConfig {
    fn default() -> Self {
        Self {
            rounds: 3,
            observations_max: 8000,
            wander_share_first: 2e-3,
            correlated_s: 1.0,
            told_share: 0.4,
            tolerance: 1e-6,
        }
    }
}

/// Why there is no fit.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GreyBoxStop {
    /// No loop has both its command and its measurement.
    #[error("the log has no axis (roll, pitch, yaw or climb) with both a command and its measured value")]
    NoLoop,
    /// Too few observations within the log.
    #[error("only {found} speeds lie within the time of the log, but a fit needs {needed}")]
    TooFew {
        /// Number of observations.
        found: usize,
        /// Number needed.
        needed: usize,
    },
    /// Nearly all observations lie within the log, and these are too few.
    #[error(
        "the flight has too few speeds, {found} in {flight_s:.1} s: at this rate, a fit needs a flight of {needed_s:.0} s or longer"
    )]
    TooShort {
        /// Time from the first to the last observation, s.
        flight_s: f64,
        /// Number of observations.
        found: usize,
        /// Time that holds as many as are needed, s.
        needed_s: f64,
    },
    /// The optimiser did not end.
    #[error("the speeds do not follow the commands, so no model fits them")]
    NotConverged,
}

/// The fitted model.
#[derive(Clone, Debug, PartialEq)]
pub struct GreyBoxFit {
    /// The model.
    pub model: GreyBoxModel,
    /// Standard uncertainty of each parameter, in the order of [`Parameter::all`]; `None` where the flight does not tell it, so that the value of
    /// the start is kept.
    pub std_uncertainty: [Option<f64>; PARAMETER_COUNT],
    /// Rank and correlations.
    pub information: Information,
    /// Standard deviation of a rotor's speed about the model that the observations do not explain.
    pub wander_rad_s: f64,
    /// Number of observations.
    pub observations: usize,
    /// Rms of observed less predicted speeds as a share of the speed: of each rotor, by information.
    pub residual_share: f64,
    /// Precision of the wander, for the next round of listening.
    pub(crate) wander_precision: Matrix4<f64>,
}

impl GreyBoxFit {
    /// A parameter with its uncertainty; `None` where the flight does not tell it.
    pub fn estimate(&self, parameter: Parameter) -> Option<Estimate> {
        let at = Parameter::all().iter().position(|other| *other == parameter)?;
        let std_uncertainty = self.std_uncertainty[at]?;
        Some(Estimate {
            value: self.model.to_vector()[at],
            std_uncertainty: Some(std_uncertainty),
            ending: Ending::Solved,
        })
    }

    /// The same with a standard uncertainty of the time of all changes, such as that of echoes, which arrive later than the sound
    /// itself: it is one of the time constant and of the delays, and P times it is one of D.
    #[must_use]
    pub(crate) fn with_time_uncertainty(self, std_s: f64) -> Self {
        let loops = self.model.loops;
        self.with_added_uncertainty(|parameter| match parameter {
            Parameter::TimeConstant | Parameter::CommandDelay | Parameter::MeasuredDelay => std_s,
            Parameter::Derivative(axis) => std_s * loops[axis as usize].proportional,
            _ => 0.0,
        })
    }

    /// The same with the Doppler effect of motion that follows the commands. A roll rate p moves a rotor at the lever y up by p y, so that its
    /// sound rises by `ω p y sin ε / c` at a microphone ε above its plane: this cannot be told from the derivative's gain, nor the effect of the
    /// climb from the gain of the climb. Where the microphone is, is not known.
    #[must_use]
    pub(crate) fn with_doppler_uncertainty(self, lever_m: [f64; 2]) -> Self {
        let per_m_s = self.model.mean_hover_rad_s() * SINE_STD / SOUND_M_S;
        self.with_added_uncertainty(|parameter| match parameter {
            Parameter::Derivative(Axis::Roll) => lever_m[0] * per_m_s,
            Parameter::Derivative(Axis::Pitch) => lever_m[1] * per_m_s,
            Parameter::Proportional(Axis::Climb) => per_m_s,
            _ => 0.0,
        })
    }

    /// The same with another, independent standard uncertainty of each parameter that the flight tells.
    fn with_added_uncertainty(mut self, std_of: impl Fn(Parameter) -> f64) -> Self {
        for (std_uncertainty, parameter) in self.std_uncertainty.iter_mut().zip(Parameter::all()) {
            *std_uncertainty = std_uncertainty.map(|std_uncertainty| std_uncertainty.hypot(std_of(parameter)));
        }
        self
    }

    /// The speeds that the model predicts for a flight.
    pub fn prediction(&self, inputs: &LoopInputs) -> SpeedPrediction {
        SpeedPrediction::new(inputs, &self.model)
    }
}

/// Fits the model to observed speeds. `start` is the vehicle by its numbers: what a flight does not tell stays there.
///
/// # Errors
/// No loop in the log, fewer than ten observations per parameter, no convergence.
pub fn grey_box_from_speeds(
    observations: &[SpeedObservation],
    inputs: &LoopInputs,
    start: &GreyBoxModel,
    config: &GreyBoxConfig,
) -> Result<GreyBoxFit, GreyBoxStop> {
    // a command takes effect at some moment between two log rows
    let between_rows_s = inputs.row_s * EVEN_STD;
    Ok(grey_box_near(observations, inputs, start, start, config)?.with_time_uncertainty(between_rows_s))
}

/// The same from another first guess.
pub(crate) fn grey_box_near(
    observations: &[SpeedObservation],
    inputs: &LoopInputs,
    start: &GreyBoxModel,
    guess: &GreyBoxModel,
    config: &GreyBoxConfig,
) -> Result<GreyBoxFit, GreyBoxStop> {
    let used = used_observations(observations, inputs, config)?;
    let speed = start.mean_hover_rad_s();
    let mut wander = Wander::of_share(&inputs.mixer, config.wander_share_first, speed);
    let mut problem = problem_of(&used, inputs, start, guess);
    for _ in 0..config.rounds {
        let differences = problem.differences();
        problem.roots = roots_of(&used, &differences, &wander);
        let optimiser = LevenbergMarquardt::new().with_tol(config.tolerance).with_patience(30);
        let (solved, report) = optimiser.minimize(problem);
        problem = solved;
        if !report.objective_function.is_finite() {
            return Err(GreyBoxStop::NotConverged);
        }
        wander = wander.updated(&used, &problem.differences(), speed);
    }
    finished(problem, &wander, config)
}

fn used_observations(
    observations: &[SpeedObservation],
    inputs: &LoopInputs,
    config: &GreyBoxConfig,
) -> Result<Vec<SpeedObservation>, GreyBoxStop> {
    if !inputs.has_loop.contains(&true) {
        return Err(GreyBoxStop::NoLoop);
    }
    let is_known = |observation: &&SpeedObservation| {
        let half_s = observation.window_s / 2.0;
        inputs.knows(observation.time_s - half_s, observation.time_s + half_s)
    };
    let known: Vec<&SpeedObservation> = observations.iter().filter(is_known).collect();
    let needed = OBSERVATIONS_MIN;
    if known.len() < needed {
        return Err(too_few(&known, observations.len()));
    }
    let stride = known.len().div_ceil(config.observations_max);
    Ok(known.into_iter().step_by(stride).cloned().collect())
}

/// Why there are too few observations within the log: the flight is too short where nearly all lie in it.
fn too_few(known: &[&SpeedObservation], of: usize) -> GreyBoxStop {
    let (found, needed) = (known.len(), OBSERVATIONS_MIN);
    match (known.first(), known.last()) {
        (Some(first), Some(last)) if found > 1 && found as f64 >= OVERLAP_SHARE_MIN * of as f64 => {
            let flight_s = last.time_s - first.time_s;
            let needed_s = flight_s * needed as f64 / found as f64;
            GreyBoxStop::TooShort { flight_s, found, needed_s: needed_s.ceil() }
        }
        _ => GreyBoxStop::TooFew { found, needed },
    }
}

/// Standard deviations of the priors, in scales of the parameters. *Decision*: gains of controllers within a factor of a few of the vehicle's
/// numbers; the hover speed within 20 %; the delay within 0.1 s.
fn prior_std(parameter: Parameter) -> f64 {
    match parameter {
        Parameter::Proportional(_) | Parameter::Derivative(_) => 5.0,
        Parameter::Limit(_) | Parameter::Load => 1.0,
        Parameter::TimeConstant => 2.0,
        Parameter::CommandDelay | Parameter::MeasuredDelay => 10.0,
        Parameter::Hover(_) => 20.0,
        // motors of one vehicle
        Parameter::MotorGain(_) => 5.0,
    }
}

fn problem_of<'a>(
    used: &'a [SpeedObservation],
    inputs: &'a LoopInputs,
    start: &GreyBoxModel,
    guess: &GreyBoxModel,
) -> Problem<'a> {
    let (scales, from, to) = (start.scales(), start.to_vector(), guess.to_vector());
    let all = Parameter::all();
    let is_free = |at: &usize| all[*at].axis().is_none_or(|axis: Axis| inputs.has_loop[axis as usize]);
    let free: Vec<usize> = (0..PARAMETER_COUNT).filter(is_free).collect();
    Problem {
        inputs,
        observations: used,
        roots: Vec::new(),
        start: *start,
        scales,
        prior_std: all.map(prior_std),
        at: DVector::from_iterator(free.len(), free.iter().map(|&index| (to[index] - from[index]) / scales[index])),
        free,
    }
}

fn roots_of(used: &[SpeedObservation], differences: &[Vector4<f64>], wander: &Wander) -> Vec<Matrix4<f64>> {
    let root = |(observation, difference): (&SpeedObservation, &Vector4<f64>)| {
        square_root(&(wander.huber_weight(observation, difference) * wander.information(observation)))
    };
    used.iter().zip(differences).map(root).collect()
}

fn finished(mut problem: Problem, wander: &Wander, config: &GreyBoxConfig) -> Result<GreyBoxFit, GreyBoxStop> {
    problem.roots = roots_of(problem.observations, &problem.differences(), wander);
    let (Some(residuals), Some(jacobian)) = (problem.residuals(), problem.jacobian()) else {
        return Err(GreyBoxStop::NotConverged);
    };
    let rows = 4 * problem.observations.len();
    let of_data = jacobian.rows(0, rows).into_owned();
    let data_information = of_data.transpose() * &of_data;
    let prior = DMatrix::from_diagonal(&DVector::from_iterator(
        problem.free.len(),
        problem.free.iter().map(|&index| problem.prior_std[index].powi(-2)),
    ));
    let Some(inverse) = (&data_information + &prior).cholesky().map(|cholesky| cholesky.inverse()) else {
        return Err(GreyBoxStop::NotConverged);
    };
    let lags = lags_of(problem.observations, config.correlated_s);
    let scores = correlated_scores(&of_data, &residuals.rows(0, rows).into_owned(), lags);
    let overlap = overlap_shift(&of_data, &inverse, &problem);
    let sandwich = &inverse * (scores + &prior) * &inverse;
    let parameters = Parameter::all();
    let free: Vec<Parameter> = problem.free.iter().map(|&index| parameters[index]).collect();
    let mut std_uncertainty = [None; PARAMETER_COUNT];
    let mut vector = problem.model(&problem.at).to_vector();
    for (at, &index) in problem.free.iter().enumerate() {
        let variance = sandwich[(at, at)].max(inverse[(at, at)]);
        let std_in_scales = variance.sqrt().hypot(EVEN_STD * overlap[at]);
        if std_in_scales < config.told_share * problem.prior_std[index] {
            std_uncertainty[index] = Some(std_in_scales * problem.scales[index]);
            vector[index] += 0.5 * overlap[at] * problem.scales[index];
        } else {
            vector[index] = problem.start.to_vector()[index];
        }
    }
    Ok(GreyBoxFit {
        model: GreyBoxModel::from_vector(&vector),
        std_uncertainty,
        information: information_of(&data_information, &inverse, &free),
        wander_rad_s: wander.std_rad_s(),
        observations: problem.observations.len(),
        residual_share: residual_share(&problem, wander),
        wander_precision: wander.precision(),
    })
}

/// Number of observations over which differences are correlated.
fn lags_of(observations: &[SpeedObservation], correlated_s: f64) -> usize {
    let span_s =
        observations.last().map_or(0.0, |last| last.time_s) - observations.first().map_or(0.0, |first| first.time_s);
    let interval_s = span_s / observations.len().max(1) as f64;
    if interval_s > 0.0 { ((correlated_s / interval_s).ceil() as usize).min(observations.len() / 4) } else { 0 }
}

/// Covariance of the sum of the scores, with correlation of neighbours by the weights of Bartlett (Newey and West 1987).
fn correlated_scores(jacobian: &DMatrix<f64>, residuals: &DVector<f64>, lags: usize) -> DMatrix<f64> {
    let count = residuals.len() / 4;
    let mut scores = DMatrix::zeros(jacobian.ncols(), count);
    for row in 0..count {
        let score = jacobian.rows(4 * row, 4).transpose() * residuals.rows(4 * row, 4);
        scores.set_column(row, &score);
    }
    // the sum over lags with weights of Bartlett is the mean square of sums over windows of that length
    let length = lags + 1;
    let mut covariance = DMatrix::zeros(jacobian.ncols(), jacobian.ncols());
    let mut sum = DVector::zeros(jacobian.ncols());
    for end in 0..count + length - 1 {
        if end < count {
            sum += scores.column(end);
        }
        if end >= length {
            sum -= scores.column(end - length);
        }
        covariance += &sum * sum.transpose();
    }
    covariance / length as f64
}

/// Rms difference as a share of the speed, where the rotors can be separated: weighed by the information of each observation.
fn residual_share(problem: &Problem, wander: &Wander) -> f64 {
    let (mut squares, mut weights) = (0.0, 0.0);
    for (observation, difference) in problem.observations.iter().zip(problem.differences()) {
        let information = wander.information(observation);
        squares += (difference.transpose() * information * difference)[(0, 0)];
        weights += information.trace();
    }
    if weights > 0.0 { (squares / weights).sqrt() / problem.start.mean_hover_rad_s() } else { f64::NAN }
}
