//! Noise that is white on top of a random walk, made white.

use super::rows::HeardRows;

/// One kind of noise on top of the white one, in variances over that of the white noise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drift {
    /// Of the level, per second: a random walk.
    level_per_s: f64,
    /// Of the slope, per second: what bends smoothly, as speeds and attitudes do.
    slope_per_s: f64,
}

/// The kinds of noise that are integrated over: gyros and gusts, tracks and motors lie in between.
pub(super) const DRIFTS: [Drift; 11] = [
    walk(0.1),
    walk(1.0),
    walk(10.0),
    walk(100.0),
    walk(1e3),
    walk(1e4),
    bend(1.0),
    bend(30.0),
    bend(1e3),
    bend(3e4),
    bend(1e6),
];

const fn walk(level_per_s: f64) -> Drift {
    Drift { level_per_s, slope_per_s: 0.0 }
}

const fn bend(slope_per_s: f64) -> Drift {
    Drift { level_per_s: 0.0, slope_per_s }
}

/// A run may begin with the slope that its noise has after so long.
const SLOPE_S: f64 = 1.0;

/// A linear filter that makes such noise white, and takes away the level that each run begins at: the innovations of the local level
/// and local linear trend models (Harvey, Forecasting, structural time series models and the Kalman filter, 1989, section 2.3), over
/// their standard deviations.
pub(super) struct Whitening<'a> {
    run: &'a [usize],
    steps: Vec<Step>,
    /// Σ ln of the innovations' variances.
    pub(super) log_determinant: f64,
}

/// One row of the filter: time since the row before, gains of level and slope, standard deviation of the innovation.
struct Step {
    step_s: f64,
    level_gain: f64,
    slope_gain: f64,
    std: f64,
}

impl<'a> Whitening<'a> {
    pub(super) fn new(heard: &'a HeardRows, drift: Drift) -> Self {
        let (mut steps, mut log_determinant) = (Vec::with_capacity(heard.len()), 0.0);
        // covariance of level and slope
        let (mut level, mut cross, mut slope) = (0.0, 0.0, 0.0);
        for row in 0..heard.len() {
            if row == 0 || heard.run[row] != heard.run[row - 1] {
                // nothing is known before: the first value is the level, to within the white noise
                (level, cross, slope) = (1.0, 0.0, drift.slope_per_s * SLOPE_S);
                steps.push(Step { step_s: 0.0, level_gain: 1.0, slope_gain: 0.0, std: f64::INFINITY });
                continue;
            }
            let dt = heard.time_s[row] - heard.time_s[row - 1];
            level += dt * (2.0 * cross + dt * slope) + drift.level_per_s * dt + drift.slope_per_s * dt.powi(3) / 3.0;
            cross += dt * slope + drift.slope_per_s * dt * dt / 2.0;
            slope += drift.slope_per_s * dt;
            let variance = level + 1.0;
            let (level_gain, slope_gain) = (level / variance, cross / variance);
            steps.push(Step { step_s: dt, level_gain, slope_gain, std: variance.sqrt() });
            slope -= slope_gain * cross;
            cross -= slope_gain * level;
            level -= level_gain * level;
            log_determinant += variance.ln();
        }
        Self { run: &heard.run, steps, log_determinant }
    }

    /// One value for each row but the first of each run.
    pub(super) fn whitened(&self, series: impl Iterator<Item = f64>) -> Vec<f64> {
        let (mut level, mut slope) = (0.0, 0.0);
        let mut white = Vec::with_capacity(self.steps.len());
        for ((value, step), row) in series.zip(&self.steps).zip(0..) {
            if row == 0 || self.run[row] != self.run[row - 1] {
                (level, slope) = (value, 0.0);
                continue;
            }
            level += step.step_s * slope;
            let innovation = value - level;
            level += step.level_gain * innovation;
            slope += step.slope_gain * innovation;
            white.push(innovation / step.std);
        }
        white
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The mean of series, value by value.
pub(super) fn mean_of(series: &[Vec<f64>]) -> Vec<f64> {
    let length = series.first().map_or(0, Vec::len);
    (0..length).map(|index| series.iter().map(|values| values[index]).sum::<f64>() / series.len() as f64).collect()
}

/// What may be in every series without saying anything of one rotor, taken out of all of them.
pub(super) struct Nuisances {
    /// Perpendicular to each other.
    directions: Vec<Vec<f64>>,
    /// Σ ln of their squares.
    pub(super) log_determinant: f64,
}

impl Nuisances {
    /// Of white series; one that says nothing beyond those before it is none.
    pub(super) fn of(series: impl IntoIterator<Item = Vec<f64>>) -> Self {
        let mut nuisances = Self { directions: Vec::new(), log_determinant: 0.0 };
        for series in series {
            let whole = dot(&series, &series);
            let rest = nuisances.removed_from(series);
            let square = dot(&rest, &rest);
            if square > REST_SHARE_MIN * whole {
                nuisances.log_determinant += square.ln();
                nuisances.directions.push(rest);
            }
        }
        nuisances
    }

    pub(super) fn count(&self) -> usize {
        self.directions.len()
    }

    pub(super) fn removed_from(&self, mut series: Vec<f64>) -> Vec<f64> {
        for direction in &self.directions {
            let share = dot(direction, &series) / dot(direction, direction);
            series.iter_mut().zip(direction).for_each(|(value, along)| *value -= share * along);
        }
        series
    }
}

/// Of a series, less than this is rounding.
const REST_SHARE_MIN: f64 = 1e-12;
