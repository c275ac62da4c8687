//! Regression of the body rates on the tracks: the torques of the rotors, integrated over time, are the rates.

use super::AssignmentModel;
use super::bayes_factor::{Regression, VALUES_MIN};
use super::log_rows::{LogRows, MatchedRows};
use super::noise_model::{DriftingNoise, NOISES, WhiteningFilter};
use super::nuisance::{NuisanceBasis, dot, mean_series};
use hovertone_signal::statistics::log_sum_exp;
use hovertone_vehicle::RotorPlace;

/// Index of the yaw axis. *Numeric.*
const YAW: usize = 2;
/// Nuisance series: time, mean of the tracks. *Numeric.*
const NUISANCES: usize = 2;

/// Body rates of a log, and the levers of the rotors.
pub(super) struct BodyRateModel<'a> {
    rows: &'a LogRows,
    /// `levers[axis][rotor]`: torque of a rotor about an axis over the square of its speed, up to a factor of the axis.
    levers: [Vec<f64>; 3],
}

/// Sums of white series for one noise, after projection: the regressions of all assignments consist of them.
struct RegressionSums {
    /// `track_track[a][b]`: ⟨track a, track b⟩, of the integrals of the squared speeds.
    track_track: Vec<Vec<f64>>,
    degrees: f64,
    axes: [AxisSums; 3],
}

struct AxisSums {
    /// ⟨rate, rate⟩.
    rate_square: f64,
    /// `track_rate[track]`: ⟨track, rate⟩.
    track_rate: Vec<f64>,
    /// Logarithm of the likelihood of the rate without tracks.
    ln_null: f64,
}

impl<'a> BodyRateModel<'a> {
    pub(super) fn new(rows: &'a LogRows, places: &[RotorPlace]) -> Self {
        // a thrust at (x, y) has the torque (y, −x) about the axes x and y; the drag of a rotor acts against its direction of rotation
        let levers = [
            places.iter().map(|place| place.y_m).collect(),
            places.iter().map(|place| -place.x_m).collect(),
            places.iter().map(|place| -place.spin).collect(),
        ];
        Self { rows, levers }
    }

    /// The sums for one noise. Time is a nuisance because of steady torques from outside, such as wind. The mean of the tracks is
    /// one because the common thrust turns a vehicle whose centre of mass is off the middle, or whose rotors differ.
    fn regression_sums(&self, matched: &MatchedRows, noise: DriftingNoise) -> RegressionSums {
        let filter = WhiteningFilter::new(matched, noise);
        let white: Vec<Vec<f64>> =
            matched.points.iter().map(|points| filter.white(points.iter().map(|point| point.excess_rad2_s))).collect();
        let nuisances = NuisanceBasis::from_white([filter.white(matched.time_s.iter().copied()), mean_series(&white)]);
        let tracks: Vec<Vec<f64>> = white.into_iter().map(|track| nuisances.projected_out(track)).collect();
        let degrees = tracks.first().map_or(0.0, |track| track.len() as f64) - nuisances.len() as f64;
        let axes = [0, 1, YAW].map(|axis| {
            let rate = filter.white(matched.rows.iter().map(|&row| self.rows.series[axis][row]));
            let rate = nuisances.projected_out(rate);
            let rate_square = dot(&rate, &rate);
            let ln_null =
                -(filter.ln_determinant + nuisances.ln_determinant + degrees * rate_square.max(f64::MIN_POSITIVE).ln())
                    / 2.0;
            AxisSums { rate_square, track_rate: tracks.iter().map(|track| dot(track, &rate)).collect(), ln_null }
        });
        let track_track = tracks.iter().map(|a| tracks.iter().map(|b| dot(a, b)).collect()).collect();
        RegressionSums { track_track, degrees, axes }
    }
}

impl RegressionSums {
    /// The regression of one rate on the tracks, each times the lever of its rotor.
    fn regression(&self, axis: &AxisSums, levers: &[f64], assignment: &[usize]) -> Regression {
        let lever = |track: usize| levers[assignment[track]];
        let tracks = || 0..assignment.len();
        Regression {
            xy: tracks().map(|track| lever(track) * axis.track_rate[track]).sum(),
            xx: tracks()
                .map(|a| lever(a) * tracks().map(|b| lever(b) * self.track_track[a][b]).sum::<f64>())
                .sum::<f64>(),
            yy: axis.rate_square,
            degrees: self.degrees,
        }
    }
}

impl AssignmentModel for BodyRateModel<'_> {
    fn ln_likelihood_ratios(&self, rows: &MatchedRows, assignments: &[Vec<usize>]) -> Vec<f64> {
        let mut ln_ratios = vec![0.0; assignments.len()];
        if rows.len() < rows.run_count() + NUISANCES + VALUES_MIN {
            return ln_ratios;
        }
        let sums = NOISES.map(|noise| self.regression_sums(rows, noise));
        for (axis, levers) in self.levers.iter().enumerate() {
            let ln_null = log_sum_exp(sums.iter().map(|sums| sums.axes[axis].ln_null));
            for (ln_ratio, assignment) in ln_ratios.iter_mut().zip(assignments) {
                let with_tracks = sums.iter().map(|sums| {
                    let regression = sums.regression(&sums.axes[axis], levers, assignment);
                    // all propellers may turn the other way round than on the usual frame
                    let ln_bayes_factor = if axis == YAW {
                        regression.ln_bayes_factor()
                    } else {
                        regression.ln_bayes_factor_of_positive()
                    };
                    sums.axes[axis].ln_null + ln_bayes_factor
                });
                *ln_ratio += log_sum_exp(with_tracks) - ln_null;
            }
        }
        ln_ratios
    }
}
