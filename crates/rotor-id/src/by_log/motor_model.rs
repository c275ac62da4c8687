//! Regression of the tracks on the commands or speeds of the motors.

use super::AssignmentModel;
use super::bayes_factor::{Regression, VALUES_MIN};
use super::flight_log::MotorSignal;
use super::log_rows::{LogRows, MatchedRows};
use super::noise_model::{NOISES, WhiteningFilter};
use super::nuisance::{NuisanceBasis, dot, mean_series};
use crate::settings::LabelsConfig;
use hovertone_signal::statistics::{log_sum_exp, mean};
use hovertone_vehicle::ROTOR_STD_SHARE;

/// Time constants of a motor behind its command, in s, over which the likelihood is averaged: none; that of the AR.Drone (motor parameters
/// of the AuRoRA simulation platform); that of large propellers (step responses on thrust stands). *Physics.*
const COMMAND_LAGS_S: [f64; 3] = [0.0, 0.03, 0.08];
/// Time constant behind a measured speed, in s: none. A filter of the telemetry is part of the offset of the clocks. *Decision.*
const SPEED_LAGS_S: [f64; 1] = [0.0];
/// Nuisance series: time, mean of the tracks, mean of the motors. *Numeric.*
const NUISANCES: usize = 3;

/// The motors of a log.
pub(super) struct MotorModel<'a> {
    rows: &'a LogRows,
    /// Series of the log behind first-order lags: `lagged[lag][motor][row]`.
    lagged: Vec<Vec<Vec<f64>>>,
    /// Standard deviation of the ratio of mean speeds, if the log holds speeds.
    mean_speed_std_share: Option<f64>,
}

/// White series of the tracks, for one noise.
struct WhiteTracks {
    /// `differences[track]`: speed of each track minus the mean of all tracks.
    differences: Vec<Vec<f64>>,
    mean: Vec<f64>,
    time: Vec<f64>,
}

/// Sums of white series for one noise and one lag, after projection: all regressions of all assignments consist of them.
struct RegressionSums {
    /// `track_motor[track][motor]`: ⟨track, motor⟩.
    track_motor: Vec<Vec<f64>>,
    /// `motor_motor[a][b]`: ⟨motor a, motor b⟩.
    motor_motor: Vec<Vec<f64>>,
    /// `Σ ⟨track, track⟩`.
    track_square: f64,
    degrees: f64,
    /// Logarithm of the likelihood of the tracks without motors.
    ln_null: f64,
}

impl<'a> MotorModel<'a> {
    pub(super) fn new(rows: &'a LogRows, signal: MotorSignal, config: &LabelsConfig) -> Self {
        let lags_s: &[f64] = match signal {
            MotorSignal::Command => &COMMAND_LAGS_S,
            MotorSignal::Speed => &SPEED_LAGS_S,
        };
        let lagged = lags_s
            .iter()
            .map(|&lag_s| rows.series.iter().map(|series| lagged(lag_s, rows, series)).collect())
            .collect();
        let mean_speed_std_share = (signal == MotorSignal::Speed).then_some(config.speed_level_std_share);
        Self { rows, lagged, mean_speed_std_share }
    }

    /// The sums for every noise and every lag.
    fn regression_sums(&self, rows: &MatchedRows) -> Vec<RegressionSums> {
        let sums = NOISES.iter().flat_map(|&noise| {
            let filter = WhiteningFilter::new(rows, noise);
            let tracks = WhiteTracks::new(&filter, rows);
            self.lagged.iter().map(|motors| tracks.regression_sums(&filter, rows, motors)).collect::<Vec<_>>()
        });
        sums.collect()
    }

    /// Logarithm of the likelihood ratio of the mean speeds. Each is divided by the mean of all, so that a wrong number of poles, which
    /// multiplies all logged speeds, has no effect.
    fn ln_ratio_of_mean_speeds(&self, std_share: f64, matched: &MatchedRows, assignment: &[usize]) -> f64 {
        let of_tracks: Vec<f64> = matched
            .points
            .iter()
            .map(|points| points.iter().map(|point| point.speed_rad_s).sum::<f64>() / matched.len() as f64)
            .collect();
        let of_motors: Vec<f64> = assignment
            .iter()
            .map(|&motor| {
                matched.rows.iter().map(|&row| self.rows.series[motor][row]).sum::<f64>() / matched.len() as f64
            })
            .collect();
        let (Some(track_mean), Some(motor_mean)) = (mean(&of_tracks), mean(&of_motors)) else { return 0.0 };
        if track_mean <= 0.0 || motor_mean <= 0.0 {
            return 0.0;
        }
        let (mut related, mut unrelated) = (0.0, 0.0);
        for (of_track, of_motor) in of_tracks.iter().zip(&of_motors) {
            related += (of_track / track_mean - of_motor / motor_mean).powi(2);
            unrelated += (of_track / track_mean - 1.0).powi(2);
        }
        let degrees = assignment.len() as f64 - 1.0;
        (unrelated / ROTOR_STD_SHARE.powi(2) - related / std_share.powi(2)) / 2.0
            + degrees * (ROTOR_STD_SHARE / std_share).ln()
    }
}

impl WhiteTracks {
    fn new(filter: &WhiteningFilter<'_>, rows: &MatchedRows) -> Self {
        let mut differences: Vec<Vec<f64>> =
            rows.points.iter().map(|points| filter.white(points.iter().map(|point| point.speed_rad_s))).collect();
        let mean = mean_series(&differences);
        for difference in &mut differences {
            difference.iter_mut().zip(&mean).for_each(|(speed, mean)| *speed -= mean);
        }
        Self { differences, mean, time: filter.white(rows.time_s.iter().copied()) }
    }

    /// The sums with the motors behind one lag. Time is a nuisance because batteries run down and motors warm up, each at its own rate;
    /// the two means are nuisances because no two motors respond alike to a common command.
    fn regression_sums(&self, filter: &WhiteningFilter<'_>, rows: &MatchedRows, lagged: &[Vec<f64>]) -> RegressionSums {
        let motors: Vec<Vec<f64>> =
            lagged.iter().map(|motor| filter.white(rows.rows.iter().map(|&row| motor[row]))).collect();
        let nuisances = NuisanceBasis::from_white([self.time.clone(), self.mean.clone(), mean_series(&motors)]);
        let projected_out = |series: &[Vec<f64>]| -> Vec<Vec<f64>> {
            series.iter().map(|values| nuisances.projected_out(values.clone())).collect()
        };
        let (tracks, motors) = (projected_out(&self.differences), projected_out(&motors));
        let track_square: f64 = tracks.iter().map(|track| dot(track, track)).sum();
        // the differences of n tracks from their mean are n − 1 independent series
        let independent = tracks.len() as f64 - 1.0;
        let degrees = independent * (self.time.len() as f64 - nuisances.len() as f64);
        let ln_null = -(independent * (filter.ln_determinant + nuisances.ln_determinant)
            + degrees * track_square.max(f64::MIN_POSITIVE).ln())
            / 2.0;
        RegressionSums {
            track_motor: tracks.iter().map(|y| motors.iter().map(|x| dot(y, x)).collect()).collect(),
            motor_motor: motors.iter().map(|a| motors.iter().map(|b| dot(a, b)).collect()).collect(),
            track_square,
            degrees,
            ln_null,
        }
    }
}

impl RegressionSums {
    /// The regression of the tracks on the assigned motors minus the mean of these motors.
    fn regression(&self, assignment: &[usize]) -> Regression {
        let count = assignment.len() as f64;
        let own: f64 = assignment.iter().map(|&motor| self.motor_motor[motor][motor]).sum();
        let all: f64 =
            assignment.iter().map(|&a| assignment.iter().map(|&b| self.motor_motor[a][b]).sum::<f64>()).sum();
        Regression {
            xy: assignment.iter().enumerate().map(|(track, &motor)| self.track_motor[track][motor]).sum(),
            xx: own - all / count,
            yy: self.track_square,
            degrees: self.degrees,
        }
    }
}

impl AssignmentModel for MotorModel<'_> {
    fn ln_likelihood_ratios(&self, rows: &MatchedRows, assignments: &[Vec<usize>]) -> Vec<f64> {
        if rows.len() < rows.run_count() + NUISANCES + VALUES_MIN {
            return vec![0.0; assignments.len()];
        }
        let sums = self.regression_sums(rows);
        let ln_null = log_sum_exp(sums.iter().map(|sums| sums.ln_null));
        assignments
            .iter()
            .map(|assignment| {
                let of_changes =
                    sums.iter().map(|sums| sums.ln_null + sums.regression(assignment).ln_bayes_factor_of_positive());
                let of_means = self
                    .mean_speed_std_share
                    .map_or(0.0, |share| self.ln_ratio_of_mean_speeds(share, rows, assignment));
                log_sum_exp(of_changes) - ln_null + of_means
            })
            .collect()
    }
}

/// A series behind a first-order lag; the first value of each stretch stays. A command holds from one row to the next.
fn lagged(lag_s: f64, rows: &LogRows, series: &[f64]) -> Vec<f64> {
    let mut value = 0.0;
    (0..series.len())
        .map(|row| {
            let is_first = row == 0 || rows.stretch[row] != rows.stretch[row - 1];
            if is_first || lag_s <= 0.0 {
                value = series[row];
            } else {
                let keep = (-(rows.time_s[row] - rows.time_s[row - 1]) / lag_s).exp();
                value = keep * value + (1.0 - keep) * series[row - 1];
            }
            value
        })
        .collect()
}
