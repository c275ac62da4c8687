//! Differences of heard and logged speeds: which of them count, and what the log's rounding adds.

use hovertone_analysis::{ComparedPoint, TrackPoint};
use hovertone_signal::statistics::median;

/// Fewest compared points. *Decision.*
pub(super) const POINTS_MIN: usize = 20;
/// Values of a log that differ by less than this share are equal. *Numeric.*
const SAME_SHARE: f64 = 1e-9;

/// A heard and a logged speed.
pub(super) struct Difference {
    pub(super) point: TrackPoint,
    pub(super) logged_rev_s: f64,
    /// Time to the nearest log row.
    pub(super) row_s: f64,
}

impl Difference {
    /// Heard less logged speed.
    pub(super) fn rev_s(&self) -> f64 {
        self.point.speed_rev_s - self.logged_rev_s
    }
}

/// The points near log rows, where these are enough: between rows the logged speed is a guess.
pub(super) fn near_rows(differences: Vec<Difference>) -> Vec<Difference> {
    let steps_s: Vec<f64> = differences.windows(2).map(|pair| pair[1].point.time_s - pair[0].point.time_s).collect();
    let near_s = 0.5 * median(&steps_s).unwrap_or(0.0);
    let is_near = |difference: &&Difference| difference.row_s <= near_s;
    if differences.iter().filter(is_near).count() < POINTS_MIN {
        return differences;
    }
    differences.into_iter().filter(|difference| is_near(&difference)).collect()
}

/// Standard deviation of the rounding of a series, from the smallest distance of its values.
pub(super) fn rounding_std(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let steps =
        sorted.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > SAME_SHARE * sorted[sorted.len() - 1]);
    let step = steps.fold(f64::INFINITY, f64::min);
    if step.is_finite() { step / 12f64.sqrt() } else { 0.0 }
}

/// The same for figures.
pub(super) fn compared_point(difference: &Difference) -> ComparedPoint {
    let TrackPoint { time_s, speed_rev_s, std_uncertainty_rev_s, .. } = difference.point;
    ComparedPoint { time_s, heard_rev_s: speed_rev_s, std_uncertainty_rev_s, logged_rev_s: difference.logged_rev_s }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_told_from_the_values_and_points_between_rows_do_not_count() {
        let rounded: Vec<f64> = (0..100)
            .map(|row| (7.0 * f64::from(row) / 60.0).sin())
            .map(|value| 60.0 + (6.0 * value).round() / 6.0)
            .collect();
        assert!((rounding_std(&rounded) - 1.0 / 6.0 / 12f64.sqrt()).abs() < 1e-9);
        assert_eq!(rounding_std(&[60.0; 5]), 0.0);
        assert_eq!(rounding_std(&[]), 0.0);
        let difference = |at: u32| {
            let point = TrackPoint {
                time_s: 0.04 * f64::from(at),
                tone_hz: 120.0,
                speed_rev_s: 60.0,
                std_uncertainty_rev_s: 0.1,
                level_db: -40.0,
            };
            Difference { point, logged_rev_s: 60.0, row_s: 0.04 * f64::from(at % 5) }
        };
        assert_eq!(near_rows((0..200).map(difference).collect()).len(), 40);
        // too few of them: all count
        assert_eq!(near_rows((0..50).map(difference).collect()).len(), 50);
    }
}
