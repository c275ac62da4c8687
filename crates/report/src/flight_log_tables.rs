//! The logs of an experiment as tables: order check, heard rotors, motors.

use crate::flight_log::FlightLogRecord;
use crate::motor::{in_ms, rows_too_far_apart};
use crate::motor_record::MotorRecord;
use crate::number::{DASH, fixed, signed, significant, with_uncertainty};
use crate::results::InputRecord;
use crate::text_table::{Column, TextTable};
use crate::typeset::TitledTable;
use crate::verification::{PPM, failed_check, undecided_check};
use hovertone_analysis::{Verification, VerifiedRotor, percent_in_words};
use hovertone_dynamics::constants_of;

/// The tables of all logs of an experiment; empty where no recording has one. `names` are those of the recordings, for people.
pub fn flight_log_tables(inputs: &[InputRecord], names: &[String]) -> Vec<TitledTable> {
    let logged: Vec<Logged<'_>> = inputs
        .iter()
        .zip(names)
        .filter_map(|(input, name)| Some(Logged { load: &input.load, name, log: input.log.as_ref()? }))
        .collect();
    if logged.is_empty() {
        return Vec::new();
    }
    vec![
        TitledTable::new("Speed check: sound against flight log", checks_table(&logged)),
        TitledTable::new("Heard rotors and the motors of the log", rotors_table(&logged)),
        TitledTable::new("Motors, from the steps in the logs", motors_table(&logged)),
    ]
}

/// A recording with its log.
struct Logged<'a> {
    load: &'a str,
    name: &'a str,
    log: &'a FlightLogRecord,
}

fn checks_table(logged: &[Logged<'_>]) -> TextTable {
    let mut shown = TextTable::new(vec![
        Column::words("load"),
        Column::words("recording"),
        Column::words("log"),
        Column::numbers("offset of the log", "s"),
        Column::numbers("drift of the clocks", "1e-6"),
        Column::numbers("heard over logged", ""),
        Column::words("speed check"),
    ]);
    for Logged { load, name, log } in logged {
        let found = log.verification.as_ref();
        let cell = |value: Option<String>| value.unwrap_or_else(|| DASH.to_owned());
        // where the speeds are steady, another offset fits as well
        let digits = |found: &Verification| if found.is_offset_told { 3 } else { 1 };
        let verdict = match (found, &log.not_verified) {
            (Some(found), _) => {
                let failed = failed_check(found).map(|notice| format!("failed: {}", notice.text));
                let undecided = || undecided_check(found).map(|notice| format!("not decided: {}", notice.text));
                failed.or_else(undecided).unwrap_or_else(|| "passed".to_owned())
            }
            (None, Some(reason)) => format!("none: {}", reason.text),
            (None, None) => "none: the log has no speeds, or no rotor was heard".to_owned(),
        };
        shown.push(vec![
            (*load).to_owned(),
            (*name).to_owned(),
            log.file.clone(),
            cell(found.map(|found| signed(found.offset_s, digits(found)))),
            cell(found.and_then(|found| Some(signed(PPM * found.clock_rate_share?, 0)))),
            cell(found.map(|found| fixed(found.speed_ratio, 5))),
            verdict,
        ]);
    }
    shown
}

fn rotors_table(logged: &[Logged<'_>]) -> TextTable {
    let mut shown = TextTable::new(vec![
        Column::words("recording"),
        Column::words("rotor"),
        Column::words("motor of the log"),
        Column::numbers("probability", ""),
        Column::numbers("heard", "rev/s"),
        Column::numbers("heard − logged", "rev/s"),
        Column::numbers("scatter", "rev/s"),
        Column::numbers("log within ± of the sound", ""),
        Column::numbers("points", ""),
    ]);
    for Logged { name, log, .. } in logged {
        for rotor in log.rotors() {
            let of = |cell: &dyn Fn(&VerifiedRotor) -> String| rotor.verified.map_or(DASH.to_owned(), cell);
            shown.push(vec![
                (*name).to_owned(),
                rotor.number.to_string(),
                rotor.motor.unwrap_or("not named").to_owned(),
                rotor.probability.map_or(DASH.to_owned(), |probability| fixed(probability, 3)),
                of(&|verified| significant(verified.speed_rev_s, 5)),
                of(&|verified| signed(verified.bias_rev_s, 3)),
                of(&|verified| fixed(verified.scatter_rev_s, 3)),
                of(&|verified| percent_in_words(verified.coverage)),
                of(&|verified| verified.point_count.to_string()),
            ]);
        }
        if let Some(reason) = log.reason_of_labels() {
            shown.push_words(
                (*name).to_owned(),
                format!("a rotor without a probability has the name of the motor with the nearest speed: {reason}"),
            );
        }
    }
    shown
}

fn motors_table(logged: &[Logged<'_>]) -> TextTable {
    let mut shown = TextTable::new(vec![
        Column::words("log"),
        Column::words("motor"),
        Column::numbers("time constant up", "ms"),
        Column::numbers("steps", ""),
        Column::numbers("time constant down", "ms"),
        Column::numbers("steps", ""),
        Column::numbers("dead time", "ms"),
        Column::numbers("gain", "rev/s per unit"),
        Column::numbers("largest speed", "rev/s"),
    ]);
    for Logged { log, .. } in logged {
        if log.motors.motors.is_empty() {
            shown.push_words(log.file.clone(), "no rotor speed in this log".to_owned());
        }
        for motor in &log.motors.motors {
            let constants = constants_of(std::slice::from_ref(&motor.model));
            let combined = [constants.time_constant_up_s, constants.time_constant_down_s, constants.dead_time_s];
            let [up, down, dead] = combined.map(|combined| in_ms(combined.map(|combined| combined.estimate)));
            let [up_count, down_count, _] = combined.map(|combined| combined.map_or(0, |combined| combined.step_count));
            let gain = motor.model.static_map.as_ref().and_then(|map| map.gain_rev_s);
            shown.push(vec![
                log.file.clone(),
                motor.name.clone(),
                up,
                up_count.to_string(),
                down,
                down_count.to_string(),
                dead,
                gain.map_or(DASH.to_owned(), |gain| with_uncertainty(gain.value, gain.std_uncertainty)),
                significant(motor.model.speed_rev_s_max, 4),
            ]);
        }
        if let Some(reason) = no_time_constant(&log.motors) {
            shown.push_words(log.file.clone(), format!("no time constant: {reason}"));
        }
    }
    shown
}

/// Why a log tells no time constant.
fn no_time_constant(record: &MotorRecord) -> Option<String> {
    let first = record.motors.first().filter(|_| !record.has_time_constant())?;
    Some(match first.model.is_too_slow {
        true => rows_too_far_apart(),
        false => "no step of the speed from one steady value to another could be used".to_owned(),
    })
}
