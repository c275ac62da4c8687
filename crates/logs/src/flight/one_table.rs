//! Logs with all signals in one table: CSV, and blackbox.

use super::rows::{
    Motor, Rows, command_number, electrical_number, motors_of, rates_of, rows_of, speed_number, with_role, without_sign,
};
use super::{ElectricalSpeeds, LoggedFlight, LoggedTorque, RateAxes};
use crate::electrical::electrical_columns;
use crate::signals::SignalTable;
use crate::table::SignalRole;

/// Motors and rates of the table with most rows: a blackbox file has one for each arming.
pub(super) fn flight(tables: &[SignalTable], axes: Option<RateAxes>) -> LoggedFlight {
    let Some(table) = tables.iter().rev().max_by_key(|table| table.time_s.len()) else {
        return LoggedFlight::default();
    };
    let speeds = motors_of(&table.time_s, one_of_each(with_role(table, speed_number)), "motor", |_| false);
    let electrical = motors_of(&table.time_s, with_role(table, electrical_number), "motor", |_| false);
    let commands = motors_of(&table.time_s, with_role(table, command_number), "motor", |_| false);
    LoggedFlight {
        speeds_rev_s: speeds.map(without_sign),
        electrical: electrical.map(|motors| ElectricalSpeeds {
            motors: without_sign(motors),
            columns: electrical_columns(table.signals.iter()),
        }),
        commands,
        rates: rates_of(table, axes),
        torque: torque_of(table),
        notes: Vec::new(),
    }
}

fn torque_of(table: &SignalTable) -> Option<LoggedTorque> {
    let at = table.signals.iter().position(|signal| signal.role == Some(SignalRole::Torque))?;
    let Rows { time_s, values } = rows_of(&table.time_s, &[&table.values[at]], |_| false);
    Some(LoggedTorque { time_s, torque_n_m: values.into_iter().next()? })
}

/// Of two sensors for one motor, the one that sees it turn more often: a stand may have no optical one.
fn one_of_each(motors: Vec<Motor>) -> Vec<Motor> {
    let turning = |motor: &Motor| motor.values.iter().filter(|value| **value > 0.0).count();
    let mut kept: Vec<Motor> = Vec::new();
    for motor in motors {
        match kept.iter_mut().find(|other| other.number == motor.number) {
            Some(other) if turning(&motor) > turning(other) => *other = motor,
            Some(_) => {}
            None => kept.push(motor),
        }
    }
    kept
}
