//! Series with times of their own, and their values on the rows of one of them.

use super::{ControlLoop, LoggedControl, MissingControl};
use crate::flight::LoggedMotors;
use crate::signals::SignalTable;

/// Longest interval over which a measured value is straight, s. *Physics*: an attitude changes within that.
const STRAIGHT_S_MAX: f64 = 0.5;
/// Longest time for which a command is held, s. *Decision*: sticks are logged twice per second or more often.
const HELD_S_MAX: f64 = 1.0;

/// A series with its own times.
#[derive(Clone, Debug)]
pub(super) struct Series<'a> {
    pub(super) time_s: &'a [f64],
    pub(super) values: Vec<f64>,
}

impl<'a> Series<'a> {
    /// A signal of a table, by the first of its names that the table has.
    pub(super) fn of(table: &'a SignalTable, names: &[&str], converted: impl Fn(f64) -> f64) -> Option<Self> {
        let values = names.iter().find_map(|name| table.values_of(name))?;
        Some(Self { time_s: &table.time_s, values: values.iter().map(|value| converted(*value)).collect() })
    }

    /// The last value at or before a time.
    fn held(&self, at_s: f64) -> f64 {
        let behind = self.time_s.partition_point(|time_s| *time_s <= at_s);
        let row = behind.checked_sub(1).filter(|row| at_s - self.time_s[*row] <= HELD_S_MAX);
        row.map_or(f64::NAN, |row| self.values[row])
    }

    /// The value on the straight line between two rows.
    fn straight(&self, at_s: f64) -> f64 {
        let behind = self.time_s.partition_point(|time_s| *time_s < at_s);
        if self.time_s.get(behind) == Some(&at_s) {
            return self.values[behind];
        }
        let Some(before) = behind.checked_sub(1).filter(|_| behind < self.time_s.len()) else { return f64::NAN };
        let interval_s = self.time_s[behind] - self.time_s[before];
        let share = (at_s - self.time_s[before]) / interval_s;
        let value = self.values[before] + share * (self.values[behind] - self.values[before]);
        if interval_s <= STRAIGHT_S_MAX { value } else { f64::NAN }
    }
}

/// All series of a log.
#[derive(Debug, Default)]
pub(super) struct ControlSeries<'a> {
    pub(super) command: [Option<Series<'a>>; 4],
    pub(super) tilt_rad: [Option<Series<'a>>; 2],
    pub(super) rates_rad_s: [Option<Series<'a>>; 3],
    pub(super) climb_m_s: Option<Series<'a>>,
    /// Shaft speeds with the numbers of the motors in the log.
    pub(super) speeds: Option<LoggedMotors>,
    /// Motor of the log at each of our four places.
    pub(super) motor_of_rotor: [u32; 4],
    pub(super) missing: Vec<MissingControl>,
}

impl ControlSeries<'_> {
    /// Drops a command that means something else in the mode of the flight.
    pub(super) fn leave_out(&mut self, control_loop: ControlLoop, hint: &'static str) {
        if self.command[control_loop as usize].take().is_some() {
            let what = "its command (in this flight mode, the stick commands something else)";
            self.missing.push(MissingControl { control_loop, what, hint });
        }
    }

    /// The series on the rows of the attitude, else of the rates.
    pub(super) fn on_rows(self) -> LoggedControl {
        let rows = self.tilt_rad[0].as_ref().or(self.rates_rad_s[2].as_ref()).or(self.climb_m_s.as_ref());
        let time_s = rows.map_or_else(Vec::new, |rows| rows.time_s.to_vec());
        let held = |series: Series<'_>| time_s.iter().map(|at_s| series.held(*at_s)).collect();
        let straight = |series: Series<'_>| time_s.iter().map(|at_s| series.straight(*at_s)).collect();
        LoggedControl {
            command: self.command.map(|series| series.map(held)),
            tilt_rad: self.tilt_rad.map(|series| series.map(straight)),
            rates_rad_s: self.rates_rad_s.map(|series| series.map(straight)),
            climb_m_s: self.climb_m_s.map(straight),
            speeds_rev_s: speeds_on_rows(self.speeds.as_ref(), self.motor_of_rotor, &time_s),
            missing: self.missing,
            loss: None,
            time_s,
        }
    }
}

/// The speeds at the rows next to their reports; all other rows are gaps, since a report between them is none.
fn speeds_on_rows(speeds: Option<&LoggedMotors>, motor_of_rotor: [u32; 4], time_s: &[f64]) -> [Option<Vec<f64>>; 4] {
    motor_of_rotor.map(|number| {
        let speeds = speeds?;
        let motor = speeds.names.iter().position(|name| *name == format!("motor {number}"))?;
        let series = Series { time_s: &speeds.time_s, values: speeds.values[motor].clone() };
        let mut values = vec![f64::NAN; time_s.len()];
        for report_s in &speeds.time_s {
            let behind = time_s.partition_point(|at_s| at_s < report_s);
            let nearest = [behind.checked_sub(1), Some(behind)].into_iter().flatten().filter(|row| *row < time_s.len());
            let distance_s = |row: &usize| (time_s[*row] - report_s).abs();
            if let Some(row) = nearest.min_by(|a, b| distance_s(a).total_cmp(&distance_s(b))) {
                values[row] = series.straight(time_s[row]);
            }
        }
        Some(values)
    })
}
