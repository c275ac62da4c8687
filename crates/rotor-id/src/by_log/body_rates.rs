//! What rotors do to the body: their thrusts and torques, integrated, are its rates.

use super::evidence::{Evidence, Regression};
use super::rows::{HeardRows, LogRows};
use super::whitening::{DRIFTS, Drift, Nuisances, Whitening, dot, mean_of};
use hovertone_signal::statistics::log_sum_exp;
use hovertone_vehicle::RotorPlace;

/// Body rates of a log, and the levers of the rotors.
pub(super) struct BodyRates<'a> {
    rows: &'a LogRows,
    /// `levers[axis][rotor]`: how a rotor's square turns the body about an axis, but for a gain of the axis.
    levers: [Vec<f64>; 3],
}

/// Integrals and rates made white with one noise: what every assignment's regressions are put together of.
struct Products {
    /// Of the tracks' integrals with each other.
    with_tracks: Vec<Vec<f64>>,
    degrees: f64,
    axes: [AxisProducts; 3],
}

struct AxisProducts {
    rate_square: f64,
    /// Of each track's integral with the rate.
    with_rate: Vec<f64>,
    /// Logarithm of the likelihood of the rate without any track.
    log_null: f64,
}

impl<'a> BodyRates<'a> {
    pub(super) fn new(rows: &'a LogRows, places: &[RotorPlace]) -> Self {
        // a thrust at (x, y) turns the body by (y, −x), and the air holds a rotor back against its turning
        let levers = [
            places.iter().map(|place| place.y_m).collect(),
            places.iter().map(|place| -place.x_m).collect(),
            places.iter().map(|place| -place.spin).collect(),
        ];
        Self { rows, levers }
    }

    fn products(&self, heard: &HeardRows, drift: Drift) -> Products {
        let whitening = Whitening::new(heard, drift);
        let white: Vec<Vec<f64>> = heard
            .points
            .iter()
            .map(|points| whitening.whitened(points.iter().map(|point| point.excess_rad2_s)))
            .collect();
        // a steady torque that no rotor shows, a wind; and what all rotors do together, which turns a body whose centre of mass is
        // not in the middle, or whose rotors are not alike
        let nuisances = Nuisances::of([whitening.whitened(heard.time_s.iter().copied()), mean_of(&white)]);
        let tracks: Vec<Vec<f64>> = white.into_iter().map(|track| nuisances.removed_from(track)).collect();
        let degrees = tracks.first().map_or(0.0, |track| track.len() as f64) - nuisances.count() as f64;
        let axes = [0, 1, 2].map(|axis| {
            let rate = whitening.whitened(heard.rows.iter().map(|&row| self.rows.series[axis][row]));
            let rate = nuisances.removed_from(rate);
            let rate_square = dot(&rate, &rate);
            let log_null = -(whitening.log_determinant
                + nuisances.log_determinant
                + degrees * rate_square.max(f64::MIN_POSITIVE).ln())
                / 2.0;
            AxisProducts { rate_square, with_rate: tracks.iter().map(|track| dot(track, &rate)).collect(), log_null }
        });
        let with_tracks = tracks.iter().map(|a| tracks.iter().map(|b| dot(a, b)).collect()).collect();
        Products { with_tracks, degrees, axes }
    }
}

impl Products {
    fn regression(&self, axis: &AxisProducts, levers: &[f64], assignment: &[usize]) -> Regression {
        let lever = |track: usize| levers[assignment[track]];
        let tracks = || 0..assignment.len();
        Regression {
            xy: tracks().map(|track| lever(track) * axis.with_rate[track]).sum(),
            xx: tracks()
                .map(|a| lever(a) * tracks().map(|b| lever(b) * self.with_tracks[a][b]).sum::<f64>())
                .sum::<f64>(),
            yy: axis.rate_square,
            degrees: self.degrees,
        }
    }
}

impl Evidence for BodyRates<'_> {
    fn log_ratios(&self, heard: &HeardRows, assignments: &[Vec<usize>]) -> Vec<f64> {
        let mut ratios = vec![0.0; assignments.len()];
        if heard.len() < heard.run_count() + 4 {
            return ratios;
        }
        let noises = DRIFTS.map(|drift| self.products(heard, drift));
        for (axis, levers) in self.levers.iter().enumerate() {
            // propellers may all turn the other way round than is usual
            let is_yaw = axis == 2;
            let log_null = log_sum_exp(noises.iter().map(|noise| noise.axes[axis].log_null));
            for (ratio, assignment) in ratios.iter_mut().zip(assignments) {
                let with_tracks = noises.iter().map(|noise| {
                    let regression = noise.regression(&noise.axes[axis], levers, assignment);
                    let factor = if is_yaw { regression.log_factor() } else { regression.log_factor_of_positive() };
                    noise.axes[axis].log_null + factor
                });
                *ratio += log_sum_exp(with_tracks) - log_null;
            }
        }
        ratios
    }
}
