//! Rows in the sequence of time, without gaps.

use super::{LoggedMotors, LoggedRates, MOTORS_MAX, RateAxes};
use crate::signals::SignalTable;
use crate::table::SignalRole;

/// A motor and its series.
pub(super) struct Motor<'a> {
    /// Number in the log.
    pub(super) number: u32,
    pub(super) values: &'a [f64],
}

/// Rows of some series.
pub(super) struct Rows {
    pub(super) time_s: Vec<f64>,
    pub(super) values: Vec<Vec<f64>>,
}

/// The rows in the order of time. A row with a missing number is a gap; a row whose time is not between its neighbours is damaged; of rows with
/// equal times the first counts.
pub(super) fn rows_of(times_s: &[f64], columns: &[&[f64]], is_gap: impl Fn(usize) -> bool) -> Rows {
    let mut rows = Rows { time_s: Vec::new(), values: vec![Vec::new(); columns.len()] };
    for (row, &at_s) in times_s.iter().enumerate() {
        let is_late = times_s.get(row + 1).is_some_and(|next_s| at_s > *next_s);
        let is_early = rows.time_s.last().is_some_and(|last_s| at_s <= *last_s);
        let has_gap = || columns.iter().any(|column| column.get(row).is_none_or(|value| !value.is_finite()));
        if is_late || is_early || is_gap(row) || has_gap() {
            continue;
        }
        rows.time_s.push(at_s);
        rows.values.iter_mut().zip(columns).for_each(|(values, column)| values.push(column[row]));
    }
    rows
}

/// The motors of a table in the order of their numbers, with `named` before each number.
pub(super) fn motors_of(
    times_s: &[f64],
    mut motors: Vec<Motor>,
    named: &str,
    is_gap: impl Fn(usize) -> bool,
) -> Option<LoggedMotors> {
    motors.sort_by_key(|motor| motor.number);
    motors.truncate(MOTORS_MAX);
    let columns: Vec<&[f64]> = motors.iter().map(|motor| motor.values).collect();
    let Rows { time_s, values } = rows_of(times_s, &columns, is_gap);
    let names = motors.iter().map(|motor| format!("{named} {}", motor.number)).collect();
    (!motors.is_empty()).then_some(LoggedMotors { time_s, names, values })
}

/// The same speeds without the sense of rotation.
pub(super) fn without_sign(motors: LoggedMotors) -> LoggedMotors {
    let values = motors.values.into_iter().map(|values| values.into_iter().map(f64::abs).collect()).collect();
    LoggedMotors { values, ..motors }
}

/// The series of a role, with the number that `number_of` finds in it.
pub(super) fn with_role(table: &SignalTable, number_of: impl Fn(SignalRole) -> Option<u32>) -> Vec<Motor<'_>> {
    let motors = table.signals.iter().zip(&table.values);
    motors.filter_map(|(signal, values)| Some(Motor { number: number_of(signal.role?)?, values })).collect()
}

pub(super) fn speed_number(role: SignalRole) -> Option<u32> {
    if let SignalRole::RotorSpeed(rotor) = role { Some(rotor) } else { None }
}

pub(super) fn electrical_number(role: SignalRole) -> Option<u32> {
    if let SignalRole::ElectricalSpeed(motor) = role { Some(motor) } else { None }
}

pub(super) fn command_number(role: SignalRole) -> Option<u32> {
    if let SignalRole::Command(motor) = role { Some(motor) } else { None }
}

/// The body rates of a table, where it has all three.
pub(super) fn rates_of(table: &SignalTable, axes: Option<RateAxes>) -> Option<LoggedRates> {
    let axis = |wanted: usize| {
        let at = table.signals.iter().position(|signal| signal.role == Some(SignalRole::BodyRate(wanted)))?;
        Some(table.values[at].as_slice())
    };
    let columns = [axis(0)?, axis(1)?, axis(2)?];
    let Rows { time_s, values } = rows_of(&table.time_s, &columns, |_| false);
    Some(LoggedRates { time_s, rates_rad_s: values.try_into().ok()?, axes })
}
