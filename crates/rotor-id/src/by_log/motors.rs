//! What a log says of each motor: its command or its speed.

use super::evidence::{Evidence, Regression};
use super::log::MotorSignal;
use super::rows::{HeardRows, LogRows};
use super::whitening::{DRIFTS, Nuisances, Whitening, dot, mean_of};
use crate::settings::LabelsConfig;
use hovertone_signal::statistics::{log_sum_exp, mean};

/// Time constants of a motor behind its command that are integrated over: from none, through the AR.Drone's 0.03 s, to large
/// propellers' (PHYSICS section 8; the step responses of thrust stands).
const LAGS_S: [f64; 3] = [0.0, 0.03, 0.08];
/// A measured speed is that of the moment; what its filter delays is the clock's.
const NO_LAG_S: [f64; 1] = [0.0];
/// Rotors of real quadrotors spread over 13 to 22 % from slowest to fastest (PHYSICS section 4): this is their standard deviation
/// where the log says nothing of them.
const UNRELATED_STD_SHARE: f64 = 0.06;

/// The motors of a log.
pub(super) struct Motors<'a> {
    rows: &'a LogRows,
    /// `lagged[lag][motor][row]`.
    lagged: Vec<Vec<Vec<f64>>>,
    /// How well levels agree, where they mean something.
    level_std_share: Option<f64>,
}

/// Products of white series, with one noise and one lag.
struct Products {
    /// ⟨y_i, x_j⟩ of the tracks less their mean, `with_motors[track][motor]`.
    with_motors: Vec<Vec<f64>>,
    motors: Vec<Vec<f64>>,
    tracks_square: f64,
    degrees: f64,
    log_null: f64,
}

impl<'a> Motors<'a> {
    pub(super) fn new(rows: &'a LogRows, signal: MotorSignal, config: &LabelsConfig) -> Self {
        let lags_s: &[f64] = match signal {
            MotorSignal::Command => &LAGS_S,
            MotorSignal::Speed => &NO_LAG_S,
        };
        let lagged = lags_s
            .iter()
            .map(|&lag_s| rows.series.iter().map(|series| behind(lag_s, rows, series)).collect())
            .collect();
        let level_std_share = (signal == MotorSignal::Speed).then_some(config.speed_level_std_share);
        Self { rows, lagged, level_std_share }
    }

    fn products(&self, heard: &HeardRows) -> Vec<Products> {
        let tracks = heard.points.len() as f64;
        let noises = DRIFTS.iter().flat_map(|&drift| {
            let whitening = Whitening::new(heard, drift);
            let mut speeds: Vec<Vec<f64>> = heard
                .points
                .iter()
                .map(|points| whitening.whitened(points.iter().map(|point| point.speed_rad_s)))
                .collect();
            let together = mean_of(&speeds);
            for speed in &mut speeds {
                speed.iter_mut().zip(&together).for_each(|(speed, together)| *speed -= together);
            }
            let time = whitening.whitened(heard.time_s.iter().copied());
            let of_lag = |lagged: &Vec<Vec<f64>>| {
                let motors: Vec<Vec<f64>> =
                    lagged.iter().map(|motor| whitening.whitened(heard.rows.iter().map(|&row| motor[row]))).collect();
                // batteries run down and motors warm up, each in its way, and no two answer alike to what all are told
                let nuisances = Nuisances::of([time.clone(), together.clone(), mean_of(&motors)]);
                let removed = |series: &[Vec<f64>]| -> Vec<Vec<f64>> {
                    series.iter().map(|values| nuisances.removed_from(values.clone())).collect()
                };
                let (speeds, motors) = (removed(&speeds), removed(&motors));
                let tracks_square: f64 = speeds.iter().map(|speed| dot(speed, speed)).sum();
                let degrees = (tracks - 1.0) * (time.len() as f64 - nuisances.count() as f64);
                let log_null = -((tracks - 1.0) * (whitening.log_determinant + nuisances.log_determinant)
                    + degrees * tracks_square.max(f64::MIN_POSITIVE).ln())
                    / 2.0;
                Products {
                    with_motors: speeds.iter().map(|y| motors.iter().map(|x| dot(y, x)).collect()).collect(),
                    motors: motors.iter().map(|a| motors.iter().map(|b| dot(a, b)).collect()).collect(),
                    tracks_square,
                    degrees,
                    log_null,
                }
            };
            self.lagged.iter().map(of_lag).collect::<Vec<Products>>()
        });
        noises.collect()
    }

    /// Logarithm of the likelihood ratio of the mean speeds, against each other.
    fn log_ratio_of_levels(&self, std_share: f64, heard: &HeardRows, assignment: &[usize]) -> f64 {
        let speeds: Vec<f64> = heard
            .points
            .iter()
            .map(|points| points.iter().map(|point| point.speed_rad_s).sum::<f64>() / heard.len() as f64)
            .collect();
        let of_log: Vec<f64> = assignment
            .iter()
            .map(|&motor| heard.rows.iter().map(|&row| self.rows.series[motor][row]).sum::<f64>() / heard.len() as f64)
            .collect();
        let (Some(heard_mean), Some(log_mean)) = (mean(&speeds), mean(&of_log)) else { return 0.0 };
        if heard_mean <= 0.0 || log_mean <= 0.0 {
            return 0.0;
        }
        // shares of the mean: a wrong number of poles does not matter
        let (mut apart, mut alone) = (0.0, 0.0);
        for (speed, of_log) in speeds.iter().zip(&of_log) {
            apart += (speed / heard_mean - of_log / log_mean).powi(2);
            alone += (speed / heard_mean - 1.0).powi(2);
        }
        let degrees = assignment.len() as f64 - 1.0;
        (alone / UNRELATED_STD_SHARE.powi(2) - apart / std_share.powi(2)) / 2.0
            + degrees * (UNRELATED_STD_SHARE / std_share).ln()
    }
}

impl Products {
    fn regression(&self, assignment: &[usize]) -> Regression {
        let count = assignment.len() as f64;
        let own: f64 = assignment.iter().map(|&motor| self.motors[motor][motor]).sum();
        let all: f64 = assignment.iter().map(|&a| assignment.iter().map(|&b| self.motors[a][b]).sum::<f64>()).sum();
        Regression {
            xy: assignment.iter().enumerate().map(|(track, &motor)| self.with_motors[track][motor]).sum(),
            // of the motors less the mean of those that have a track
            xx: own - all / count,
            yy: self.tracks_square,
            degrees: self.degrees,
        }
    }
}

impl Evidence for Motors<'_> {
    fn log_ratios(&self, heard: &HeardRows, assignments: &[Vec<usize>]) -> Vec<f64> {
        if heard.len() < heard.run_count() + 5 {
            return vec![0.0; assignments.len()];
        }
        let products = self.products(heard);
        let log_null = log_sum_exp(products.iter().map(|noise| noise.log_null));
        assignments
            .iter()
            .map(|assignment| {
                let moving =
                    products.iter().map(|noise| noise.log_null + noise.regression(assignment).log_factor_of_positive());
                let of_levels =
                    self.level_std_share.map_or(0.0, |share| self.log_ratio_of_levels(share, heard, assignment));
                log_sum_exp(moving) - log_null + of_levels
            })
            .collect()
    }
}

/// A series behind a first-order lag; each stretch begins where the series does.
fn behind(lag_s: f64, rows: &LogRows, series: &[f64]) -> Vec<f64> {
    let mut value = 0.0;
    (0..series.len())
        .map(|row| {
            let is_first = row == 0 || rows.stretch[row] != rows.stretch[row - 1];
            if is_first || lag_s <= 0.0 {
                value = series[row];
            } else {
                // the command holds from one row to the next
                let keep = (-(rows.time_s[row] - rows.time_s[row - 1]) / lag_s).exp();
                value = keep * value + (1.0 - keep) * series[row - 1];
            }
            value
        })
        .collect()
}
