//! Speed of each row → rows in which the vehicle manoeuvres: doublets, climbs, fast yaw.

use crate::hover::HoverConfig;
use hovertone_signal::statistics::{STD_PER_MEDIAN_DEVIATION, median};

/// For each row, whether its speed differs from the median speed around it by much more than the wander of the hover. A single row does
/// not count, because noise may have changed its speed.
///
/// - `speeds_rev_s`: speed of each row, where known; `row_s`: length of a row.
/// - The wander is the median absolute deviation, as a standard deviation. A neighbour of a row that counts needs half the difference.
pub(super) fn manoeuvring_rows(speeds_rev_s: &[Option<f64>], row_s: f64, config: &HoverConfig) -> Vec<bool> {
    let reach = (config.manoeuvre_reach_s / row_s).ceil() as usize;
    let off_share: Vec<f64> = speeds_rev_s
        .iter()
        .enumerate()
        .map(|(row, speed)| {
            let around: Vec<f64> = speeds_rev_s[row.saturating_sub(reach)..(row + reach + 1).min(speeds_rev_s.len())]
                .iter()
                .flatten()
                .copied()
                .collect();
            speed.zip(median(&around)).map_or(0.0, |(speed, usual)| speed / usual - 1.0)
        })
        .collect();
    let deviations: Vec<f64> =
        off_share.iter().zip(speeds_rev_s).filter(|(_, speed)| speed.is_some()).map(|(off, _)| off.abs()).collect();
    let wander = STD_PER_MEDIAN_DEVIATION * median(&deviations).unwrap_or_default();
    let limit = config.manoeuvre_share_min.max(config.manoeuvre_wanders * wander);
    let is_off = |row: usize| off_share.get(row).is_some_and(|off| off.abs() > limit);
    let is_near_off = |row: usize| off_share.get(row).is_some_and(|off| off.abs() > limit / 2.0);
    (0..off_share.len()).map(|row| is_off(row) && (row > 0 && is_near_off(row - 1) || is_near_off(row + 1))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(speed_rev_s: impl Fn(usize) -> f64, count: usize) -> Vec<bool> {
        let speeds: Vec<Option<f64>> = (0..count).map(|row| Some(speed_rev_s(row))).collect();
        manoeuvring_rows(&speeds, 0.5, &HoverConfig::default())
    }

    #[test]
    fn a_doublet_is_a_manoeuvre_and_wander_is_none() {
        let wander = |row: usize| 90.0 * (1.0 + 0.006 * (row as f64 * 1.7).sin());
        assert!(rows(wander, 40).iter().all(|is_off| !is_off));
        let flown = |row: usize| match row {
            20 | 21 => 1.05,
            22 | 23 => 0.95,
            _ => 1.0,
        };
        let doublet = |row: usize| wander(row) * flown(row);
        let found = rows(doublet, 40);
        assert_eq!((0..40).filter(|&row| found[row]).collect::<Vec<_>>(), [20, 21, 22, 23]);
    }

    #[test]
    fn a_battery_that_drains_is_no_manoeuvre_and_a_single_odd_row_neither() {
        assert!(rows(|row| 90.0 + 0.03 * row as f64, 200).iter().all(|is_off| !is_off));
        assert!(rows(|row| if row == 20 { 96.0 } else { 90.0 }, 40).iter().all(|is_off| !is_off));
        assert_eq!(manoeuvring_rows(&[], 0.5, &HoverConfig::default()), []);
    }

    #[test]
    fn where_the_speed_itself_scatters_nothing_is_cut() {
        assert!(rows(|row| if row % 2 == 0 { 87.0 } else { 93.0 }, 40).iter().all(|is_off| !is_off));
    }
}
