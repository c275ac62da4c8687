//! Motors and body rates of a DataFlash log. Each ESC has a table of its own, with times of its own.

use super::rows::{Motor, command_number, motors_of, rates_of, speed_number, with_role, without_sign};
use super::{LoggedFlight, LoggedMotors, RateAxes};
use crate::signals::SignalTable;
use std::collections::BTreeMap;

/// Distance of two reports of an ESC, in its median steps, between which nothing is known.
const GAP_STEPS: f64 = 3.0;

pub(super) fn flight(tables: &[SignalTable], motor_of_output: &BTreeMap<u32, u32>) -> LoggedFlight {
    let named = |wanted: &'static str| tables.iter().filter(move |table| table.name.split('[').next() == Some(wanted));
    let fullest_rates = named("IMU").filter_map(|table| rates_of(table, Some(RateAxes::ForwardRightDown)));
    // with equal counts the first sensor, which is the one that flies
    let rates = fullest_rates.reduce(|most, next| if next.time_s.len() > most.time_s.len() { next } else { most });
    LoggedFlight {
        speeds_rev_s: speeds_of(tables, motor_of_output),
        commands: named("RCOU").find_map(|table| commands_of(table, motor_of_output)),
        rates: rates.filter(|rates| !rates.time_s.is_empty()),
        ..LoggedFlight::default()
    }
}

/// The outputs that drive motors; all outputs that move where the log does not tell.
fn commands_of(table: &SignalTable, motor_of_output: &BTreeMap<u32, u32>) -> Option<LoggedMotors> {
    let outputs = with_role(table, command_number);
    if motor_of_output.is_empty() {
        let moving = outputs.into_iter().filter(|output| output.values.windows(2).any(|pair| pair[0] != pair[1]));
        let motors = motors_of(&table.time_s, moving.collect(), "output", |_| false);
        return motors.filter(|motors| !motors.time_s.is_empty());
    }
    let motors = outputs.into_iter().filter_map(|output| {
        let number = *motor_of_output.get(&(output.number - 1))?;
        Some(Motor { number, values: output.values })
    });
    motors_of(&table.time_s, motors.collect(), "motor", |_| false).filter(|motors| !motors.time_s.is_empty())
}

/// The speeds of all ESCs that turn, at the times of the one with most reports. ESCs have the numbers of their outputs.
fn speeds_of(tables: &[SignalTable], motor_of_output: &BTreeMap<u32, u32>) -> Option<LoggedMotors> {
    let mut escs: Vec<(u32, &SignalTable, &[f64])> = Vec::new();
    for table in tables {
        for Motor { number, values } in with_role(table, speed_number) {
            if values.iter().any(|speed| *speed != 0.0) {
                escs.push((number, table, values));
            }
        }
    }
    let (_, fullest, _) =
        escs.iter().copied().max_by_key(|(number, table, _)| (table.time_s.len(), u32::MAX - number))?;
    let times_s = &fullest.time_s;
    let numbers: Option<Vec<u32>> =
        escs.iter().map(|(number, ..)| motor_of_output.get(&number.checked_sub(1)?).copied()).collect();
    let at_times: Vec<Vec<f64>> = escs.iter().map(|(_, table, values)| values_at(times_s, table, values)).collect();
    let motors = at_times.iter().enumerate().map(|(at, values)| {
        let number = numbers.as_ref().map_or(escs[at].0, |numbers| numbers[at]);
        Motor { number, values }
    });
    let is_at_rest = |row: usize| at_times.iter().any(|values| values[row] == 0.0);
    let motors = motors_of(times_s, motors.collect(), "motor", is_at_rest);
    motors.filter(|motors| !motors.time_s.is_empty()).map(without_sign)
}

/// A series at other times, on straight lines between its rows; NaN outside and in gaps.
fn values_at(times_s: &[f64], table: &SignalTable, values: &[f64]) -> Vec<f64> {
    let own_s = &table.time_s;
    let mut steps_s: Vec<f64> = own_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps_s.sort_by(f64::total_cmp);
    let gap_s = GAP_STEPS * steps_s.get(steps_s.len() / 2).copied().unwrap_or(0.0);
    let mut after = 0;
    let value_at = |at_s: &f64| {
        while own_s.get(after).is_some_and(|own_s| own_s < at_s) {
            after += 1;
        }
        let (next_s, next) = (*own_s.get(after)?, values[after]);
        if next_s == *at_s {
            return Some(next);
        }
        let before = after.checked_sub(1)?;
        let step_s = next_s - own_s[before];
        (step_s > 0.0 && step_s <= gap_s)
            .then(|| values[before] + (next - values[before]) * (at_s - own_s[before]) / step_s)
    };
    times_s.iter().map(value_at).map(|value| value.unwrap_or(f64::NAN)).collect()
}
