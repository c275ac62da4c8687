//! From a ULog of PX4 to motors and body rates over time, in SI units.

mod file;
mod format;
#[cfg(test)]
mod tests;

pub(super) use file::is_ulog;

use super::{FlightLogError, LoggedFlight, LoggedMotors, LoggedRates, RateAxes};
use file::{Topic, UlogFile};
use std::f64::consts::TAU;

/// Largest number of channels, motors or ESCs in a topic of PX4.
const CHANNELS_MAX: usize = 16;
/// A channel whose values differ by less than this share of the largest one drives no motor: rounding, or a servo at rest.
const MOVING_SHARE_MIN: f64 = 0.01;
/// Share of values at either end that are ignored in that comparison: a servo is at 0, too, when everything is switched off.
const RARE_SHARE: f64 = 0.02;
/// `actuator_function` of motor 1; the numbers of the other motors follow.
const FUNCTION_OF_MOTOR_1: f64 = 101.0;

/// Reads a ULog, as described at [`super::flight_log_from_bytes`].
pub(super) fn flight_log_from_ulog(bytes: &[u8]) -> Result<LoggedFlight, FlightLogError> {
    let file = UlogFile::read(bytes);
    if file.topics.iter().all(|topic| topic.messages.is_empty()) {
        return Err(FlightLogError::UlogWithoutData);
    }
    let speeds = file.fullest("esc_status").and_then(|topic| speeds_of(&file, topic));
    let of_motors = file.fullest("actuator_motors").and_then(|topic| commands_of(&file, topic, "control", "motor"));
    let commands = of_motors.or_else(|| {
        let instances = file.topics.iter().filter(|topic| topic.name == "actuator_outputs");
        let commands = instances.filter_map(|topic| commands_of(&file, topic, "output", "output"));
        // with equal counts the last instance wins, since servos come first
        commands.max_by_key(|commands| commands.names.len())
    });
    let rates = [("vehicle_angular_velocity", "xyz"), ("sensor_combined", "gyro_rad")]
        .into_iter()
        .find_map(|(name, field)| rates_of(&file, file.fullest(name)?, field));
    if speeds.is_none() && commands.is_none() && rates.is_none() {
        let mut topics: Vec<&str> = file.topics.iter().map(|topic| topic.name.as_str()).collect();
        topics.sort_unstable();
        topics.dedup();
        return Err(FlightLogError::UlogWithoutSignal { topics: topics.join(", ") });
    }
    let (lost, places, all) = (file.lost_bytes, file.lost_places, bytes.len());
    let damage = (lost > 0).then(|| {
        format!("the log is damaged or breaks off: {lost} of its {all} bytes, in {places} places, mean nothing")
    });
    Ok(LoggedFlight { speeds, commands, rates, notes: damage.into_iter().collect() })
}

impl<'a> UlogFile<'a> {
    /// The instance of a topic with most messages; with equal counts the first.
    fn fullest(&self, name: &str) -> Option<&Topic<'a>> {
        let instances = self.topics.iter().filter(|topic| topic.name == name && !topic.messages.is_empty());
        instances.max_by_key(|topic| (topic.messages.len(), u8::MAX - topic.instance))
    }

    /// A value of every message of a topic.
    fn series(&self, topic: &Topic, path: &str) -> Option<Vec<f64>> {
        let place = self.place(topic, path)?;
        topic.messages.iter().map(|message| place.read(message)).collect()
    }

    /// Times at which the messages were sampled, or published where the log has no sampling time.
    fn times_s(&self, topic: &Topic) -> Option<Vec<f64>> {
        let sampled = self.series(topic, "timestamp_sample").filter(|times| times.iter().all(|time| *time > 0.0));
        let times_us = sampled.or_else(|| self.series(topic, "timestamp"))?;
        Some(times_us.into_iter().map(|time| time * 1e-6).collect())
    }
}

/// Rows of numbers in the order of time. A row with a missing number is a gap; a row whose time is not between its neighbours is damaged.
fn rows_of(times_s: &[f64], columns: &[Vec<f64>], is_gap: impl Fn(usize) -> bool) -> (Vec<f64>, Vec<Vec<f64>>) {
    let (mut time_s, mut values) = (Vec::new(), vec![Vec::new(); columns.len()]);
    for (row, &at_s) in times_s.iter().enumerate() {
        let is_late = times_s.get(row + 1).is_some_and(|next_s| at_s > *next_s);
        let is_early = time_s.last().is_some_and(|last_s| at_s <= *last_s);
        if is_late || is_early || is_gap(row) || columns.iter().any(|column| !column[row].is_finite()) {
            continue;
        }
        time_s.push(at_s);
        values.iter_mut().zip(columns).for_each(|(values, column)| values.push(column[row]));
    }
    (time_s, values)
}

/// Motors with the given numbers and series, where they have rows.
fn motors_of(time_s: Vec<f64>, names: Vec<String>, values: Vec<Vec<f64>>) -> Option<LoggedMotors> {
    (!time_s.is_empty() && !names.is_empty()).then_some(LoggedMotors { time_s, names, values })
}

/// The ESCs that report rotation at all. A row in which one of them reports none, or repeats itself, is a gap.
fn speeds_of(file: &UlogFile, topic: &Topic) -> Option<LoggedMotors> {
    let times_s = file.times_s(topic)?;
    let of_esc = |esc: usize, field: &str| file.series(topic, &format!("esc[{esc}].{field}"));
    let turning: Vec<(usize, Vec<f64>)> = (0..CHANNELS_MAX)
        .map_while(|esc| Some((esc, of_esc(esc, "esc_rpm")?)))
        .filter(|(_, rpm)| rpm.iter().any(|rpm| *rpm != 0.0))
        .collect();
    // ESCs are wired in any order, so the function that PX4 states for each ESC has priority
    let function = |esc: usize| Some(of_esc(esc, "actuator_function")?.last()? - FUNCTION_OF_MOTOR_1);
    let functions: Option<Vec<usize>> = turning
        .iter()
        .map(|(esc, _)| {
            function(*esc).filter(|motor| (0.0..CHANNELS_MAX as f64).contains(motor)).map(|motor| motor as usize)
        })
        .collect();
    let are_distinct = |motors: &Vec<usize>| (1..motors.len()).all(|at| !motors[..at].contains(&motors[at]));
    let numbers = functions.filter(are_distinct).unwrap_or_else(|| turning.iter().map(|(esc, _)| *esc).collect());
    let counter = file.series(topic, "counter");
    let reported: Vec<Option<Vec<f64>>> = turning.iter().map(|(esc, _)| of_esc(*esc, "timestamp")).collect();
    let is_stale = |row: usize| {
        let is_same = |series: &Vec<f64>| row > 0 && series[row] == series[row - 1];
        // many ESCs leave their time at 0
        counter.as_ref().is_some_and(is_same)
            || reported.iter().flatten().any(|times| times[row] > 0.0 && is_same(times))
    };
    let is_at_rest = |row: usize| turning.iter().any(|(_, rpm)| rpm[row] == 0.0);
    let mut motors: Vec<(usize, Vec<f64>)> = numbers
        .into_iter()
        .zip(&turning)
        .map(|(number, (_, rpm))| (number, rpm.iter().map(|rpm| rpm.abs() * TAU / 60.0).collect()))
        .collect();
    motors.sort_by_key(|(number, _)| *number);
    let (numbers, columns): (Vec<usize>, Vec<Vec<f64>>) = motors.into_iter().unzip();
    let (time_s, values) = rows_of(&times_s, &columns, |row| is_stale(row) || is_at_rest(row));
    motors_of(time_s, numbers.into_iter().map(|number| format!("motor {}", number + 1)).collect(), values)
}

/// The channels of a topic that move.
fn commands_of(file: &UlogFile, topic: &Topic, field: &str, named: &str) -> Option<LoggedMotors> {
    let times_s = file.times_s(topic)?;
    let channels: Vec<(usize, Vec<f64>)> = (0..CHANNELS_MAX)
        .map_while(|channel| Some((channel, file.series(topic, &format!("{field}[{channel}]"))?)))
        .filter(|(_, values)| moves(values))
        .collect();
    let (channels, columns): (Vec<usize>, Vec<Vec<f64>>) = channels.into_iter().unzip();
    let (time_s, values) = rows_of(&times_s, &columns, |_| false);
    motors_of(time_s, channels.into_iter().map(|channel| format!("{named} {}", channel + 1)).collect(), values)
}

/// Whether a channel moves, without the few rows before and after a flight.
fn moves(values: &[f64]) -> bool {
    let mut values: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let rare = 1 + (RARE_SHARE * values.len() as f64) as usize;
    let (Some(&low), Some(&high)) = (values.get(rare), values.iter().rev().nth(rare)) else { return false };
    high - low > MOVING_SHARE_MIN * low.abs().max(high.abs())
}

fn rates_of(file: &UlogFile, topic: &Topic, field: &str) -> Option<LoggedRates> {
    let times_s = file.times_s(topic)?;
    let axes: Vec<Vec<f64>> =
        (0..3).map(|axis| file.series(topic, &format!("{field}[{axis}]"))).collect::<Option<_>>()?;
    let (time_s, values) = rows_of(&times_s, &axes, |_| false);
    let rates_rad_s = values.try_into().ok().filter(|_| !time_s.is_empty())?;
    Some(LoggedRates { time_s, rates_rad_s, axes: Some(RateAxes::ForwardRightDown) })
}
