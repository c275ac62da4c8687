//! Noise that is white on top of a random walk, made white.

use super::rows::HeardRows;

/// Variances of the random walk per second over that of the white noise, that are integrated over: gyros and gusts, tracks and motors
/// lie in between.
pub(super) const WALKS_PER_S: [f64; 6] = [0.1, 1.0, 10.0, 100.0, 1e3, 1e4];

/// A linear filter that makes such noise white, and takes away the level that each run begins at: the innovations of the local level
/// model (Harvey, Forecasting, structural time series models and the Kalman filter, 1989, section 2.3), over their standard
/// deviations.
pub(super) struct Whitening<'a> {
    run: &'a [usize],
    /// Gain of the filter and standard deviation of the innovation, of each row.
    steps: Vec<(f64, f64)>,
    /// Σ ln of the innovations' variances.
    pub(super) log_determinant: f64,
}

impl<'a> Whitening<'a> {
    pub(super) fn new(heard: &'a HeardRows, walk_per_s: f64) -> Self {
        let (mut steps, mut variance, mut log_determinant) = (Vec::with_capacity(heard.len()), 1.0, 0.0);
        for row in 0..heard.len() {
            if row == 0 || heard.run[row] != heard.run[row - 1] {
                // nothing is known before: the first value is the level, to within the white noise
                steps.push((1.0, f64::INFINITY));
                variance = 1.0;
                continue;
            }
            variance += walk_per_s * (heard.time_s[row] - heard.time_s[row - 1]);
            let of_innovation = variance + 1.0;
            let gain = variance / of_innovation;
            steps.push((gain, of_innovation.sqrt()));
            variance *= 1.0 - gain;
            log_determinant += of_innovation.ln();
        }
        Self { run: &heard.run, steps, log_determinant }
    }

    /// One value for each row but the first of each run.
    pub(super) fn whitened(&self, series: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut level = 0.0;
        let mut white = Vec::with_capacity(self.steps.len());
        for ((value, &(gain, std)), row) in series.zip(&self.steps).zip(0..) {
            if row == 0 || self.run[row] != self.run[row - 1] {
                level = value;
                continue;
            }
            let innovation = value - level;
            level += gain * innovation;
            white.push(innovation / std);
        }
        white
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Takes the part along `direction` away.
pub(super) fn without(direction: &[f64], series: &mut [f64]) {
    let square = dot(direction, direction);
    if square > 0.0 {
        let share = dot(direction, series) / square;
        series.iter_mut().zip(direction).for_each(|(value, along)| *value -= share * along);
    }
}
