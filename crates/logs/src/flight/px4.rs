//! Motors and body rates of a ULog.

use super::rows::{Motor, command_number, motors_of, rates_of, speed_number, with_role, without_sign};
use super::{LoggedFlight, LoggedMotors, MOTORS_MAX, RateAxes};
use crate::signals::SignalTable;

/// A channel whose values differ by less than this share of the largest one drives no motor: rounding, or a servo at rest.
const MOVING_SHARE_MIN: f64 = 0.01;
/// Share of values at either end that are ignored in that comparison: a servo is at 0, too, when everything is switched off.
const RARE_SHARE: f64 = 0.02;
/// `actuator_function` of motor 1; the numbers of the other motors follow.
const FUNCTION_OF_MOTOR_1: f64 = 101.0;

/// Whether a signal says which ESC reported when, and whose it is.
pub(super) fn is_helper(table: &str, signal: &str) -> bool {
    let is_of_esc = signal.ends_with(".timestamp") || signal.ends_with(".actuator_function");
    topic_of(table) == "esc_status" && (signal == "counter" || is_of_esc)
}

/// "actuator_outputs" of "actuator_outputs[1]".
fn topic_of(table: &str) -> &str {
    table.split('[').next().unwrap_or(table)
}

pub(super) fn flight(tables: &[SignalTable]) -> LoggedFlight {
    let speeds = fullest(tables, "esc_status").and_then(speeds_of);
    let of_motors = fullest(tables, "actuator_motors").and_then(|table| commands_of(table, "motor"));
    let commands = of_motors.or_else(|| {
        let instances = instances(tables, "actuator_outputs");
        // with equal counts the last instance wins, since servos come first
        instances.filter_map(|table| commands_of(table, "output")).max_by_key(|commands| commands.names.len())
    });
    let topics = ["vehicle_angular_velocity", "sensor_combined"];
    let rates = topics.into_iter().find_map(|topic| {
        rates_of(fullest(tables, topic)?, Some(RateAxes::ForwardRightDown)).filter(|rates| !rates.time_s.is_empty())
    });
    LoggedFlight { speeds_rev_s: speeds, commands, rates, ..LoggedFlight::default() }
}

/// The instances of a topic, in the order of their numbers.
fn instances<'a>(tables: &'a [SignalTable], topic: &str) -> impl Iterator<Item = &'a SignalTable> {
    let mut instances: Vec<&SignalTable> = tables.iter().filter(|table| topic_of(&table.name) == topic).collect();
    instances.sort_by(|a, b| a.name.cmp(&b.name));
    instances.into_iter()
}

/// The instance of a topic with most messages; with equal counts the first.
fn fullest<'a>(tables: &'a [SignalTable], topic: &str) -> Option<&'a SignalTable> {
    let filled = instances(tables, topic).filter(|table| !table.time_s.is_empty());
    filled.reduce(|most, next| if next.time_s.len() > most.time_s.len() { next } else { most })
}

/// The ESCs that report rotation at all. A row in which one of them reports none, or repeats itself, is a gap.
fn speeds_of(table: &SignalTable) -> Option<LoggedMotors> {
    let turns = |motor: &Motor| motor.values.iter().any(|speed| *speed != 0.0);
    let turning: Vec<Motor> = with_role(table, speed_number).into_iter().filter(turns).collect();
    let of_esc = |motor: &Motor, field: &str| table.values_of(&format!("esc[{}].{field}", motor.number - 1));
    // ESCs are wired in any order, so the function that PX4 states for each ESC has priority
    let function = |motor: &Motor| Some(of_esc(motor, "actuator_function")?.last()? - FUNCTION_OF_MOTOR_1);
    let is_motor = |motor: &f64| (0.0..MOTORS_MAX as f64).contains(motor);
    let functions: Option<Vec<u32>> =
        turning.iter().map(|motor| function(motor).filter(is_motor).map(|number| number as u32 + 1)).collect();
    let are_distinct = |motors: &Vec<u32>| (1..motors.len()).all(|at| !motors[..at].contains(&motors[at]));
    let numbers = functions.filter(are_distinct);
    let counter = table.values_of("counter");
    let reported: Vec<&[f64]> = turning.iter().filter_map(|motor| of_esc(motor, "timestamp")).collect();
    let is_stale = |row: usize| {
        let is_same = |series: &[f64]| row > 0 && series[row] == series[row - 1];
        // many ESCs leave their time at 0
        counter.is_some_and(is_same) || reported.iter().any(|times| times[row] > 0.0 && is_same(times))
    };
    let is_at_rest = |row: usize| turning.iter().any(|motor| motor.values[row] == 0.0);
    let motors = turning.iter().enumerate().map(|(at, motor)| {
        let number = numbers.as_ref().map_or(motor.number, |numbers| numbers[at]);
        Motor { number, values: motor.values }
    });
    let motors = motors_of(&table.time_s, motors.collect(), "motor", |row| is_stale(row) || is_at_rest(row));
    motors.filter(|motors| !motors.time_s.is_empty()).map(without_sign)
}

/// The channels of a topic that move.
fn commands_of(table: &SignalTable, named: &str) -> Option<LoggedMotors> {
    let moving = with_role(table, command_number).into_iter().filter(|motor| moves(motor.values)).collect();
    motors_of(&table.time_s, moving, named, |_| false).filter(|motors| !motors.time_s.is_empty())
}

/// Whether a channel moves, without the few rows before and after a flight.
fn moves(values: &[f64]) -> bool {
    let mut values: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let rare = 1 + (RARE_SHARE * values.len() as f64) as usize;
    let (Some(&low), Some(&high)) = (values.get(rare), values.iter().rev().nth(rare)) else { return false };
    high - low > MOVING_SHARE_MIN * low.abs().max(high.abs())
}
