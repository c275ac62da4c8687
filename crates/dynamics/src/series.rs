//! What comes in: the speed of one motor over time, and its command.

use hovertone_signal::statistics::{mean, median, std, std_uncertainty_of_mean};

/// Rows that must reach a speed. *Numeric.*
const REACHED_ROWS: usize = 3;

/// Speed of one motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorSeries<'a> {
    /// Times of the rows, increasing.
    pub time_s: &'a [f64],
    /// Speed without sign; as many values as times.
    pub speed_rev_s: &'a [f64],
}

/// Command of one motor, with times of its own on the same clock. A command holds until the next row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommandSeries<'a> {
    /// Times of the rows, increasing.
    pub time_s: &'a [f64],
    /// Command in any unit; as many values as times.
    pub command: &'a [f64],
}

impl MotorSeries<'_> {
    /// Median time between rows; `None` for fewer than two rows.
    pub(crate) fn interval_s(&self) -> Option<f64> {
        interval_s(self.time_s)
    }

    /// Longest time between rows; 0 for fewer than two.
    pub(crate) fn longest_interval_s(&self) -> f64 {
        self.time_s.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
    }

    /// Largest speed.
    pub(crate) fn speed_rev_s_max(&self) -> f64 {
        self.speed_rev_s.iter().copied().fold(0.0, f64::max)
    }

    /// Largest speed that some rows one after another reach: a single row may be wrong. `None` for fewer rows.
    pub(crate) fn reached_rev_s_max(&self) -> Option<f64> {
        let reached =
            self.speed_rev_s.windows(REACHED_ROWS).map(|rows| rows.iter().copied().fold(f64::INFINITY, f64::min));
        reached.reduce(f64::max)
    }

    /// The rows from a time on, and before another.
    pub(crate) fn between(&self, from_s: f64, to_s: f64) -> Self {
        let rows = rows_between(self.time_s, from_s, to_s);
        Self { time_s: &self.time_s[rows.clone()], speed_rev_s: &self.speed_rev_s[rows] }
    }
}

impl CommandSeries<'_> {
    /// Median time between rows; 0 for fewer than two rows.
    pub(crate) fn interval_s(&self) -> f64 {
        interval_s(self.time_s).unwrap_or(0.0)
    }

    /// The command that holds at a time; `None` before the first.
    pub(crate) fn at(&self, time_s: f64) -> Option<f64> {
        let after = self.time_s.partition_point(|&row_s| row_s <= time_s);
        self.command.get(after.checked_sub(1)?).copied()
    }
}

fn interval_s(time_s: &[f64]) -> Option<f64> {
    let intervals_s: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    median(&intervals_s)
}

/// The rows from a time on, and before another.
pub(crate) fn rows_between(time_s: &[f64], from_s: f64, to_s: f64) -> std::ops::Range<usize> {
    let from = time_s.partition_point(|&row_s| row_s < from_s);
    from..time_s.partition_point(|&row_s| row_s < to_s).max(from)
}

/// Which of several commands belongs to a speed whose names do not say it: the index of the command with the highest correlation, and
/// the correlation. `None` without a command that changes.
pub fn command_of_speed(series: &MotorSeries, commands: &[CommandSeries]) -> Option<(usize, f64)> {
    let correlations = commands.iter().enumerate().filter_map(|(at, command)| {
        let pairs = pairs_of(series, command);
        Some((at, correlation(&pairs)?))
    });
    correlations.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Most values whose correlation is computed: its time grows with the square of their number. *Numeric.*
const CORRELATED_VALUES_MAX: usize = 2000;

/// [`std_uncertainty_of_mean`] of a series of any length: of a long one, means of successive values, which have the same mean.
pub(crate) fn std_uncertainty_of_long_mean(values: &[f64]) -> Option<f64> {
    let length = values.len().div_ceil(CORRELATED_VALUES_MAX).max(1);
    let means: Vec<f64> = values.chunks_exact(length).filter_map(mean).collect();
    std_uncertainty_of_mean(&means)
}

/// A command and the speed at the same time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CommandedSpeed {
    pub(crate) command: f64,
    pub(crate) speed_rev_s: f64,
}

/// All rows of the speed with the command that holds then.
pub(crate) fn pairs_of(series: &MotorSeries, command: &CommandSeries) -> Vec<CommandedSpeed> {
    let rows = series.time_s.iter().zip(series.speed_rev_s);
    let turning = rows.filter(|(_, speed_rev_s)| **speed_rev_s > 0.0);
    let pair =
        |(&time_s, &speed_rev_s): (&f64, &f64)| Some(CommandedSpeed { command: command.at(time_s)?, speed_rev_s });
    turning.filter_map(pair).collect()
}

/// Correlation of commands and speeds; `None` where either does not change.
pub(crate) fn correlation(pairs: &[CommandedSpeed]) -> Option<f64> {
    let commands: Vec<f64> = pairs.iter().map(|pair| pair.command).collect();
    let speeds: Vec<f64> = pairs.iter().map(|pair| pair.speed_rev_s).collect();
    let (command_std, speed_std) = (std(&commands)?, std(&speeds)?);
    let (command, speed) = (mean(&commands)?, mean(&speeds)?);
    let products: f64 = pairs.iter().map(|pair| (pair.command - command) * (pair.speed_rev_s - speed)).sum();
    let covariance = products / (pairs.len() - 1) as f64;
    (command_std > 0.0 && speed_std > 0.0).then(|| covariance / (command_std * speed_std))
}
