//! Noise that drifts: white noise plus a random walk of the value or of the slope, and the filter that makes it white.

use super::log_rows::MatchedRows;

/// Variances of a drifting noise, relative to the variance of its white part.
#[derive(Clone, Copy, Debug)]
pub(super) struct DriftingNoise {
    /// Variance that a random walk of the value gains per second, in 1/s.
    value_walk_per_s: f64,
    /// Variance that a random walk of the slope gains per second, in 1/s³: a smooth drift, as speeds and attitudes have.
    slope_walk_per_s3: f64,
}

/// The noises over which the likelihood is averaged, in steps of 10 (value) and about 30 (slope), with equal prior probabilities. The
/// noises of gyroscopes, gusts, tracks and motors lie between the extremes. *Numeric.*
pub(super) const NOISES: [DriftingNoise; 11] = [
    value_walk(0.1),
    value_walk(1.0),
    value_walk(10.0),
    value_walk(100.0),
    value_walk(1e3),
    value_walk(1e4),
    slope_walk(1.0),
    slope_walk(30.0),
    slope_walk(1e3),
    slope_walk(3e4),
    slope_walk(1e6),
];

const fn value_walk(per_s: f64) -> DriftingNoise {
    DriftingNoise { value_walk_per_s: per_s, slope_walk_per_s3: 0.0 }
}

const fn slope_walk(per_s3: f64) -> DriftingNoise {
    DriftingNoise { value_walk_per_s: 0.0, slope_walk_per_s3: per_s3 }
}

/// The slope at the start of a run has the variance that its random walk gains in this time, in s. *Decision.*
const INITIAL_SLOPE_S: f64 = 1.0;

/// A linear filter from a series with drifting noise to white values of variance 1: the innovations, over their standard deviations, of
/// the Kalman filter for the local level and local linear trend models (Harvey, Forecasting, structural time series models and the Kalman
/// filter, 1989, section 2.3). The first value of each run sets the state and has no innovation: a constant of each run drops out.
pub(super) struct WhiteningFilter<'a> {
    run: &'a [usize],
    steps: Vec<FilterStep>,
    /// `Σ ln` of the innovations' variances.
    pub(super) ln_determinant: f64,
}

/// One row of the filter.
struct FilterStep {
    /// Time since the row before.
    step_s: f64,
    value_gain: f64,
    slope_gain: f64,
    /// Standard deviation of the innovation.
    std: f64,
}

impl<'a> WhiteningFilter<'a> {
    pub(super) fn new(rows: &'a MatchedRows, noise: DriftingNoise) -> Self {
        let (mut steps, mut ln_determinant) = (Vec::with_capacity(rows.len()), 0.0);
        // covariance of value and slope
        let (mut value, mut cross, mut slope) = (0.0, 0.0, 0.0);
        for row in 0..rows.len() {
            if row == 0 || rows.run[row] != rows.run[row - 1] {
                // no knowledge of the value before: the first row is it, with the variance of the white noise
                (value, cross, slope) = (1.0, 0.0, noise.slope_walk_per_s3 * INITIAL_SLOPE_S);
                steps.push(FilterStep { step_s: 0.0, value_gain: 1.0, slope_gain: 0.0, std: f64::INFINITY });
                continue;
            }
            let dt = rows.time_s[row] - rows.time_s[row - 1];
            value += dt * (2.0 * cross + dt * slope)
                + noise.value_walk_per_s * dt
                + noise.slope_walk_per_s3 * dt.powi(3) / 3.0;
            cross += dt * slope + noise.slope_walk_per_s3 * dt * dt / 2.0;
            slope += noise.slope_walk_per_s3 * dt;
            let variance = value + 1.0;
            let (value_gain, slope_gain) = (value / variance, cross / variance);
            steps.push(FilterStep { step_s: dt, value_gain, slope_gain, std: variance.sqrt() });
            slope -= slope_gain * cross;
            cross -= slope_gain * value;
            value -= value_gain * value;
            ln_determinant += variance.ln();
        }
        Self { run: &rows.run, steps, ln_determinant }
    }

    /// White values of a series: one for each row except the first of each run.
    pub(super) fn white(&self, series: impl Iterator<Item = f64>) -> Vec<f64> {
        let (mut value, mut slope) = (0.0, 0.0);
        let mut white = Vec::with_capacity(self.steps.len());
        for ((observed, step), row) in series.zip(&self.steps).zip(0..) {
            if row == 0 || self.run[row] != self.run[row - 1] {
                (value, slope) = (observed, 0.0);
                continue;
            }
            value += step.step_s * slope;
            let innovation = observed - value;
            value += step.value_gain * innovation;
            slope += step.slope_gain * innovation;
            white.push(innovation / step.std);
        }
        white
    }
}
