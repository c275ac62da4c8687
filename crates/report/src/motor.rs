//! Constants of motors from a log or a recording: tables for people, and lines for simulators.

use crate::motor_map::maps_text;
use crate::motor_record::{LoggedMotor, MotorRecord, MotorSource};
use crate::number::{DASH, expanded, fixed, rounded, scaled_number, significant, with_uncertainty};
use crate::printable::printable;
use crate::quote::counted;
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use hovertone_dynamics::{
    BenchTorque, CombinedEstimate, LOAD_STEPS_MIN, LoadTerm, MotorConfig, MotorConstants, MotorStep, StepVerdict,
    constants_of,
};
use hovertone_vehicle::{Estimate, flight_preset_names, in_list};
use std::f64::consts::TAU;

/// Digits of a speed and of a command.
const DIGITS: usize = 4;
const MS_PER_S: f64 = 1e3;
/// What to record or to log where no step is found.
pub const BENCH_RUN: &str =
    "a bench run in which the command changes in steps, and hold each level for a second or longer";

/// The motors of a log or a recording as text.
pub fn motor_text(record: &MotorRecord, width: Option<usize>) -> String {
    let mut text = format!("{}\n", printable(&record.file));
    let Some(first) = record.motors.first() else { return text + &nothing_in_words(&record.source) };
    text += &source_in_words(record, first);
    let has_steps = shown_steps(record).next().is_some();
    let other_count = record.motors.iter().flat_map(|motor| &motor.model.steps).count() - shown_steps(record).count();
    if first.model.is_too_slow {
        text += &format!(
            "{}: this is too far for a time constant; log the speeds every 20 ms or faster\n",
            rows_too_far_apart()
        );
    } else if !has_steps {
        text += &no_step_in_words(&record.source);
    }
    if let MotorSource::Sound(sound) = &record.source
        && let Some(number) = sound.given_number().filter(|_| has_steps && !record.has_time_constant())
    {
        text += &format!(
            "if a step is missing, check {number}, because with a wrong number hovertone may follow another tone; check also that the part \
            that is heard contains the step\n"
        );
    }
    if has_steps {
        text += &format!("\n{}", table_text(&steps_table(record), width));
        text += &format!("\n{}", table_text(&constants_table(record), width));
        text += &load_text(&record.constants());
    }
    if other_count > 0 {
        text += &format!(
            "left out: {} of the speed without an exponential approach to a new speed\n",
            counted(other_count, "change")
        );
    }
    text += &maps_text(record, width);
    text += &record.torque.as_ref().map_or(String::new(), torque_text);
    text + &simulator_lines(&record.constants())
}

/// That the rows of a log are too far apart for a time constant, by the default setting.
pub(crate) fn rows_too_far_apart() -> String {
    let interval_ms = significant(MotorConfig::default().interval_s_max * MS_PER_S, 3);
    format!("the rows of this log are more than {interval_ms} ms apart")
}

fn nothing_in_words(source: &MotorSource) -> String {
    match source {
        MotorSource::Log => "no rotor turns in this log\n".to_owned(),
        MotorSource::Sound(sound) => {
            format!("no time constant: {}\n", sound.no_tone.as_deref().unwrap_or("no speed is held for a second"))
        }
    }
}

fn source_in_words(record: &MotorRecord, first: &LoggedMotor) -> String {
    match &record.source {
        MotorSource::Log => {
            let interval_ms = significant(first.model.interval_s * MS_PER_S, 3);
            format!("{}, log rows every {interval_ms} ms\n", counted(record.motors.len(), "motor"))
        }
        MotorSource::Sound(sound) => {
            let frame_ms = significant(sound.frame_s * MS_PER_S, 3);
            let has_steps = shown_steps(record).next().is_some();
            let heard = format!(
                "the speeds come from the sound, each from {frame_ms} ms of it; an echo in the room can make the time constants wrong by some per cent\n"
            );
            let heard = if has_steps { heard } else { String::new() };
            let offset = sound.offset_s.map_or(String::new(), |offset_s| {
                let offset_s = fixed(offset_s, 3);
                format!("offset of the commands: {offset_s} s, found from the steps. So the dead time (from a command to the start of its effect) is not \
                known; if you know the true offset, give --offset\n")
            });
            heard + &offset
        }
    }
}

/// All steps but those of a flight: changes of the speed, without a step of the command, that are no curve of first order.
fn shown_steps(record: &MotorRecord) -> impl Iterator<Item = (&LoggedMotor, &MotorStep)> {
    let steps = record.motors.iter().flat_map(|motor| motor.model.steps.iter().map(move |step| (motor, step)));
    steps.filter(|(_, step)| step.command.is_some() || step.verdict != StepVerdict::OtherCurve)
}

fn steps_table(record: &MotorRecord) -> TextTable {
    let mut shown = TextTable::new(vec![
        Column::words("step"),
        Column::words("motor"),
        Column::numbers("at", "s"),
        Column::numbers("from", "rev/s"),
        Column::numbers("to", "rev/s"),
        Column::numbers("time constant", "ms"),
        Column::numbers("dead time", "ms"),
        Column::words("note"),
    ]);
    for (number, (motor, step)) in (1..).zip(shown_steps(record)) {
        shown.push(vec![
            number.to_string(),
            motor.name.clone(),
            fixed(step.time_s.value, 3),
            significant(step.speed_from_rev_s, DIGITS),
            significant(step.speed_to_rev_s, DIGITS),
            in_ms(step.time_constant_s),
            in_ms(step.dead_time_s),
            verdict_in_words(step.verdict, &record.source).to_owned(),
        ]);
    }
    shown
}

fn constants_table(record: &MotorRecord) -> TextTable {
    let mut shown = TextTable::new(vec![
        Column::words("motor"),
        Column::numbers("time constant up", "ms"),
        Column::numbers("steps", ""),
        Column::numbers("time constant down", "ms"),
        Column::numbers("steps", ""),
        Column::numbers("dead time", "ms"),
        Column::numbers("largest speed", "rev/s"),
    ]);
    let mut push = |name: &str, constants: MotorConstants| {
        let count = |combined: Option<CombinedEstimate>| combined.map_or(0, |combined| combined.step_count).to_string();
        let value = |combined: Option<CombinedEstimate>| in_ms(combined.map(|combined| combined.estimate));
        shown.push(vec![
            name.to_owned(),
            value(constants.time_constant_up_s),
            count(constants.time_constant_up_s),
            value(constants.time_constant_down_s),
            count(constants.time_constant_down_s),
            value(constants.dead_time_s),
            significant(constants.speed_rev_s_max, DIGITS),
        ]);
    };
    for motor in &record.motors {
        push(&motor.name, constants_of(std::slice::from_ref(&motor.model)));
    }
    if record.motors.len() > 1 {
        push("all", record.constants());
    }
    shown
}

pub(crate) fn in_ms(estimate: Option<Estimate>) -> String {
    estimate.map_or(DASH.to_owned(), |estimate| {
        let estimate_ms = estimate.scaled(MS_PER_S);
        with_uncertainty(estimate_ms.value, estimate_ms.std_uncertainty)
    })
}

fn verdict_in_words(verdict: StepVerdict, source: &MotorSource) -> &'static str {
    match verdict {
        StepVerdict::Used => "",
        StepVerdict::TooSlowRows => match source {
            MotorSource::Log => "left out: the log has too few rows for so fast a change",
            MotorSource::Sound(_) => "left out: the change is too fast for pieces of sound of this length",
        },
        StepVerdict::Saturated => "left out: the speed no longer follows the command (saturated)",
        StepVerdict::AtRest => "left out: the motor starts or stops",
        StepVerdict::OtherCurve => "left out: not an exponential approach to the new speed",
        StepVerdict::Uncertain => "left out: too uncertain",
    }
}

/// That no step is found, and what to do. With a wrong number of blades, the tone that is followed may be another one.
fn no_step_in_words(source: &MotorSource) -> String {
    match source {
        MotorSource::Log => {
            format!("no step: the speed never changes from one steady value to another; log {BENCH_RUN}\n")
        }
        MotorSource::Sound(sound) => match sound.given_number() {
            Some(number) => format!(
                "no step is heard: check {number}, because with a wrong number hovertone may follow another tone; if it is right, record {BENCH_RUN}\n"
            ),
            None => format!(
                "no step is heard: the followed tone never changes from one steady value to another; record {BENCH_RUN}\n"
            ),
        },
    }
}

/// How the load changes the time constant, or why this is not known.
fn load_text(constants: &MotorConstants) -> String {
    let Some(LoadTerm { unloaded_rate_per_s, square_per_rev, .. }) = constants.load_term else {
        let count = constants.time_constant_up_s.map_or(0, |up| up.step_count);
        let why = if count < LOAD_STEPS_MIN {
            let (are, count) = if count == 1 { ("is", "only one".to_owned()) } else { ("are", count.to_string()) };
            format!("rising steps to {LOAD_STEPS_MIN} different speeds are needed, and there {are} {count}")
        } else {
            format!(
                "the ± of the time constants of the {count} rising steps is too large to see a change between these speeds; make more \
                rising steps, to speeds that differ more"
            )
        };
        return format!("not known whether the time constant changes with the speed: {why}\n");
    };
    let rate = with_uncertainty(unloaded_rate_per_s.value, unloaded_rate_per_s.std_uncertainty);
    let square = with_uncertainty(square_per_rev.value, square_per_rev.std_uncertainty);
    format!(
        "change of the time constant τ with the speed ω: 1/τ = 1/τ₀ + 2 k ω, with 1/τ₀ = {rate} 1/s and k = {square} 1/rev\n"
    )
}

fn torque_text(torque: &BenchTorque) -> String {
    let told = match torque {
        BenchTorque::Told { constant_n_m_s2, offset_n_m, level_count } => {
            let offset = significant(*offset_n_m, 2);
            let how = format!(
                " (k = 2, without the calibration error of the torque sensor), the slope of a straight line of the torque against ω², from \
                {level_count} steady speeds. At speed 0, this line is at {offset} N m, probably the zero of the sensor: C_τ does not include it"
            );
            Ok((*constant_n_m_s2, how))
        }
        other => Err(torque_reason(other).unwrap_or_default()),
    };
    format!("\n{}", torque_constant_text(told))
}

/// Why a log does not tell C_τ, with the vehicles of the command that is named.
pub(crate) fn torque_reason(torque: &BenchTorque) -> Option<String> {
    let reason = torque.reason()?;
    if !matches!(torque, BenchTorque::NoTorque) {
        return Some(reason);
    }
    Some(format!("{reason} (for the vehicles {})", in_list(&flight_preset_names(), "and")))
}

/// The line of the torque constant in torque = C_τ ω²: its value with the words behind it, or the reason why it is not known.
pub(crate) fn torque_constant_text(told: Result<(Estimate, String), String>) -> String {
    match told {
        Ok((constant, how)) => {
            let scaled = scaled_number(constant.value, constant.std_uncertainty);
            format!("torque constant C_τ of one rotor: ({}) 1e{} N m s²{how}\n", scaled.digits, scaled.exponent)
        }
        Err(reason) => format!("torque constant C_τ of one rotor (its torque over ω²): not known, because {reason}\n"),
    }
}

/// Lines for models of Gazebo and PX4, where a time constant is told.
fn simulator_lines(constants: &MotorConstants) -> String {
    let line = |name: &str, combined: Option<CombinedEstimate>| {
        combined.map_or(String::new(), |combined| {
            let Estimate { value, std_uncertainty, .. } = combined.estimate;
            format!("<{name}>{}</{name}>\n", rounded(value, expanded(std_uncertainty)))
        })
    };
    let up = line("timeConstantUp", constants.time_constant_up_s);
    let down = line("timeConstantDown", constants.time_constant_down_s);
    if up.is_empty() && down.is_empty() {
        return String::new();
    }
    let missing = match (up.is_empty(), down.is_empty()) {
        (true, _) => "no timeConstantUp, because this file has no step to a higher speed that can be used\n",
        (_, true) => "no timeConstantDown, because this file has no step to a lower speed that can be used\n",
        _ => "",
    };
    let speed_rad_s = significant(constants.speed_rev_s_max * TAU, DIGITS);
    format!(
        "\nlines to copy into a model of Gazebo or PX4, in s and rad/s (maxRotVelocity: the highest speed that the motor held for some time in the given file; perhaps it can turn faster)\n{up}{down}<maxRotVelocity>{speed_rad_s}</maxRotVelocity>\n{missing}"
    )
}
