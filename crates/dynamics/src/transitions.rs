//! Where a step is: windows of the log that hold one change between two levels.

use crate::config::MotorConfig;
use crate::plateaus::HeldCommand;
use crate::search::Interval;
use crate::series::MotorSeries;
use hovertone_signal::statistics::{STD_PER_MEDIAN_DEVIATION, mean, median};

/// Variance of the second differences of independent rows over that of the rows. *Physics.*
const SECOND_DIFFERENCE_VARIANCE: f64 = 6.0;
/// Fewest rows in which a level is averaged. *Numeric.*
const ROWS_MIN: usize = 3;

/// A step of the command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CommandStep {
    /// Time of the first row with the new command.
    pub(crate) time_s: f64,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

/// A window with one change of the speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Transition {
    /// Where the change begins.
    pub(crate) start_s: Interval,
    /// End of the level before, where it begins.
    pub(crate) window_from_s: f64,
    /// End of the level behind.
    pub(crate) window_to_s: f64,
    pub(crate) command: Option<CommandStep>,
}

/// The steps of a command that is held before and behind them.
pub(crate) fn transitions_of_commands(held: &[HeldCommand], interval_s: f64, config: &MotorConfig) -> Vec<Transition> {
    let pairs = held.windows(2).map(|pair| (pair[0], pair[1]));
    let long = pairs.filter(|(before, behind)| before.length_s().min(behind.length_s()) >= config.hold_s_min);
    let transition = |(before, behind): (HeldCommand, HeldCommand)| {
        let time_s = behind.from_s;
        // the speed of the row that names the new command may be measured later than its command
        let latest_s = (time_s + config.dead_time_s_max).min(behind.to_s);
        Transition {
            start_s: Interval { low: time_s - interval_s, high: latest_s },
            window_from_s: before.from_s,
            window_to_s: behind.to_s,
            command: Some(CommandStep { time_s, from: before.command, to: behind.command }),
        }
    };
    long.map(transition).collect()
}

/// A stretch of rows in which the speed rises or falls.
#[derive(Clone, Copy, Debug)]
struct Change {
    first: usize,
    last: usize,
    is_up: bool,
}

/// The changes of a speed between two levels that are held. The level before and behind each row is a mean over `change_s`; where the two differ
/// by more than scatter and wander, the speed changes.
pub(crate) fn transitions_of_speeds(series: &MotorSeries, interval_s: f64, config: &MotorConfig) -> Vec<Transition> {
    let half = ((config.change_s / interval_s).round() as usize).max(ROWS_MIN);
    let scatter = scatter_rev_s(series) / (half as f64).sqrt();
    let threshold = (config.change_share_min * series.speed_rev_s_max()).max(config.step_over_scatter_min * scatter);
    let changes = changes_of(series.speed_rev_s, half, threshold);
    let time_s = |row: usize| series.time_s[row.min(series.time_s.len() - 1)];
    let transition = |at: usize| {
        let change = changes[at];
        let before = at.checked_sub(1).map_or(0, |before| changes[before].last);
        let behind = changes.get(at + 1).map_or(series.time_s.len() - 1, |behind| behind.first);
        let is_held = time_s(change.first) - time_s(before) >= config.hold_s_min
            && time_s(behind) - time_s(change.last) >= config.hold_s_min;
        let start_s = Interval {
            low: time_s(change.first.saturating_sub(half)),
            high: time_s(change.last.min(change.first + 3 * half)),
        };
        // the first rows of a change are below the threshold
        let (window_from_s, window_to_s) = (time_s(before), time_s(behind.saturating_sub(half)));
        is_held.then_some(Transition { start_s, window_from_s, window_to_s, command: None })
    };
    (0..changes.len()).filter_map(transition).collect()
}

/// Stretches in which the means before and behind a row differ by more than a threshold, in one sense. Two of the same sense with fewer rows
/// than a mean between them are one.
fn changes_of(speeds_rev_s: &[f64], half: usize, threshold_rev_s: f64) -> Vec<Change> {
    let mut changes: Vec<Change> = Vec::new();
    for row in half..=speeds_rev_s.len().saturating_sub(half) {
        let levels = [&speeds_rev_s[row - half..row], &speeds_rev_s[row..row + half]].map(mean);
        let [Some(before), Some(behind)] = levels else { continue };
        if (behind - before).abs() < threshold_rev_s {
            continue;
        }
        let is_up = behind > before;
        match changes.last_mut() {
            Some(last) if last.is_up == is_up && row - last.last <= half => last.last = row,
            _ => changes.push(Change { first: row, last: row, is_up }),
        }
    }
    changes
}

/// Scatter of the rows, from second differences, which a steady rise does not change.
pub(crate) fn scatter_rev_s(series: &MotorSeries) -> f64 {
    let differences = series.speed_rev_s.windows(3).map(|rows| (rows[0] - 2.0 * rows[1] + rows[2]).abs());
    let typical = median(&differences.collect::<Vec<_>>()).unwrap_or(0.0);
    STD_PER_MEDIAN_DEVIATION * typical / SECOND_DIFFERENCE_VARIANCE.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_is_found_once_and_wander_is_none() {
        let time_s: Vec<f64> = (0..400).map(|row| f64::from(row) * 0.01).collect();
        let speed = |&at_s: &f64| {
            let up = if at_s > 1.0 { 1.0 - (-(at_s - 1.0) / 0.06).exp() } else { 0.0 };
            let down = if at_s > 2.5 { 1.0 - (-(at_s - 2.5) / 0.1).exp() } else { 0.0 };
            100.0 + 40.0 * (up - down) + 0.3 * (7.0 * at_s).sin()
        };
        let speed_rev_s: Vec<f64> = time_s.iter().map(speed).collect();
        let series = MotorSeries { time_s: &time_s, speed_rev_s: &speed_rev_s };
        let found = transitions_of_speeds(&series, 0.01, &MotorConfig::default());
        assert_eq!(found.len(), 2, "{found:?}");
        for (transition, start_s) in found.iter().zip([1.0, 2.5]) {
            assert!(transition.start_s.low < start_s && start_s < transition.start_s.high, "{transition:?}");
        }
        assert!(found[0].window_to_s < 2.51 && found[1].window_from_s > 1.0);
    }
}
