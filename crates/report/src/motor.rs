//! Constants of motors from a log: tables for people, lines for simulators, a JSON line for programs.

use crate::number::{DASH, expanded, fixed, rounded, significant, with_uncertainty};
use crate::printable::printable;
use crate::quote::counted;
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use crate::version::VERSION;
use hovertone_dynamics::{
    CombinedEstimate, MapOrigin, MapPoint, MotorConstants, MotorModel, MotorStep, StaticMap, StepVerdict, constants_of,
};
use hovertone_vehicle::Estimate;
use serde::Serialize;
use std::f64::consts::TAU;

/// Digits of a speed and of a command.
const DIGITS: usize = 4;
const MS_PER_S: f64 = 1e3;

/// A motor of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedMotor {
    /// Its name in the log.
    pub name: String,
    /// Name of its command in the log, where it has one.
    pub command: Option<String>,
    /// What the log tells about it.
    pub model: MotorModel,
}

/// A log and its motors.
#[derive(Clone, Debug, PartialEq)]
pub struct MotorRecord {
    /// Name of the log as given.
    pub file: String,
    /// Motors that turn.
    pub motors: Vec<LoggedMotor>,
}

impl MotorRecord {
    /// The constants of all motors together.
    pub fn constants(&self) -> MotorConstants {
        let models: Vec<MotorModel> = self.motors.iter().map(|motor| motor.model.clone()).collect();
        constants_of(&models)
    }

    /// Whether any time constant is told.
    pub fn has_time_constant(&self) -> bool {
        let constants = self.constants();
        constants.time_constant_up_s.is_some() || constants.time_constant_down_s.is_some()
    }
}

/// The motors of a log as text.
pub fn motor_text(record: &MotorRecord, width: Option<usize>) -> String {
    let mut text = format!("{}\n", printable(&record.file));
    let Some(first) = record.motors.first() else { return text + "no rotor speed in this log\n" };
    let interval_ms = significant(first.model.interval_s * MS_PER_S, 3);
    text += &format!("{}, log rows every {interval_ms} ms\n", counted(record.motors.len(), "motor"));
    let has_steps = record.motors.iter().any(|motor| !motor.model.steps.is_empty());
    if first.model.is_too_slow {
        text +=
            "too slow for a time constant: a motor reaches its speed within 300 ms, and 3 log rows must lie in that\n";
    } else if !has_steps {
        text += "no step: the speed never changes once between two levels that are held\n";
    }
    if has_steps {
        text += &format!("\n{}", table_text(&steps_table(record), width));
        text += &format!("\n{}", table_text(&constants_table(record), width));
    }
    text += &maps_text(record, width);
    text + &simulator_lines(&record.constants())
}

fn steps_table(record: &MotorRecord) -> TextTable {
    let mut shown = TextTable::new(vec![
        Column::words("motor"),
        Column::numbers("at", "s"),
        Column::numbers("from", "rev/s"),
        Column::numbers("to", "rev/s"),
        Column::numbers("time constant", "ms"),
        Column::numbers("dead time", "ms"),
        Column::words("note"),
    ]);
    for motor in &record.motors {
        for step in &motor.model.steps {
            shown.push(vec![
                motor.name.clone(),
                fixed(step.time_s.value, 3),
                significant(step.speed_from_rev_s, DIGITS),
                significant(step.speed_to_rev_s, DIGITS),
                in_ms(step.time_constant_s),
                in_ms(step.dead_time_s),
                verdict_in_words(step.verdict).to_owned(),
            ]);
        }
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

fn in_ms(estimate: Option<Estimate>) -> String {
    estimate.map_or(DASH.to_owned(), |estimate| {
        let estimate_ms = estimate.scaled(MS_PER_S);
        with_uncertainty(estimate_ms.value, estimate_ms.std_uncertainty)
    })
}

fn verdict_in_words(verdict: StepVerdict) -> &'static str {
    match verdict {
        StepVerdict::Used => "",
        StepVerdict::TooSlowRows => "log rows too slow for a time constant",
        StepVerdict::Saturated => "saturated: left out",
        StepVerdict::AtRest => "starts or stops: left out",
        StepVerdict::OtherCurve => "not of first order: left out",
        StepVerdict::Uncertain => "too uncertain: left out",
    }
}

/// The static maps: the gain of each motor, and the plateaus behind it.
fn maps_text(record: &MotorRecord, width: Option<usize>) -> String {
    if record.motors.iter().all(|motor| motor.command.is_none()) {
        return "\nno static map: this log has no command that changes\n".to_owned();
    }
    let mut text = format!("\nstatic map\n{}", table_text(&gains_table(record), width));
    let maps = || record.motors.iter().filter_map(|motor| motor.model.static_map.as_ref());
    if maps().any(|map| map.origin == MapOrigin::Rows) {
        text += "from all log rows, since no command is held: the lag of the motor makes the gain too small\n";
    }
    if maps().any(|map| !map.points.is_empty()) {
        text += &format!("\n{}", table_text(&plateaus_table(record), width));
    }
    text
}

fn gains_table(record: &MotorRecord) -> TextTable {
    let mut shown = TextTable::new(vec![
        Column::words("motor"),
        Column::words("command"),
        Column::numbers("gain", "rev/s per unit"),
        Column::numbers("at command 0", "rev/s"),
    ]);
    for motor in &record.motors {
        let told = motor.model.static_map.as_ref().and_then(|map| Some((map.gain_rev_s?, map.offset_rev_s?)));
        match (&motor.command, told) {
            (None, _) => shown.push_words(motor.name.clone(), "no command in this log".to_owned()),
            (Some(command), None) => {
                shown.push_words(motor.name.clone(), format!("the speed does not follow the command {command}"));
            }
            (Some(command), Some((gain, offset_rev_s))) => shown.push(vec![
                motor.name.clone(),
                command.clone(),
                with_uncertainty(gain.value, gain.std_uncertainty),
                significant(offset_rev_s, DIGITS),
            ]),
        }
    }
    shown
}

fn plateaus_table(record: &MotorRecord) -> TextTable {
    let mut shown = TextTable::new(vec![
        Column::words("motor"),
        Column::numbers("command", ""),
        Column::numbers("settled speed", "rev/s"),
        Column::words("note"),
    ]);
    for motor in &record.motors {
        for point in motor.model.static_map.iter().flat_map(|map| &map.points) {
            let note = if point.is_saturated { "saturated: left out of the gain" } else { "" };
            shown.push(vec![
                motor.name.clone(),
                significant(point.command, DIGITS),
                with_uncertainty(point.speed_rev_s, Some(point.speed_std_rev_s)),
                note.to_owned(),
            ]);
        }
    }
    shown
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
    let speed_rad_s = significant(constants.speed_rev_s_max * TAU, DIGITS);
    format!(
        "\nfor Gazebo and PX4 (the largest speed is that of this log)\n{up}{down}<maxRotVelocity>{speed_rad_s}</maxRotVelocity>\n"
    )
}

#[derive(Serialize)]
struct MotorLine<'a> {
    file: &'a str,
    has_rotor_speed: bool,
    time_constant_up_s: Option<CombinedLine>,
    time_constant_down_s: Option<CombinedLine>,
    dead_time_s: Option<CombinedLine>,
    speed_rev_s_max: Option<f64>,
    steps: Vec<StepLine<'a>>,
    motors: Vec<OneMotorLine<'a>>,
    version: &'static str,
}

#[derive(Serialize)]
struct CombinedLine {
    value: f64,
    std_uncertainty: Option<f64>,
    step_count: usize,
}

#[derive(Serialize)]
struct StepLine<'a> {
    motor: &'a str,
    time_s: f64,
    time_std_s: Option<f64>,
    speed_from_rev_s: f64,
    speed_to_rev_s: f64,
    time_constant_s: Option<f64>,
    time_constant_std_s: Option<f64>,
    dead_time_s: Option<f64>,
    dead_time_std_s: Option<f64>,
    command_from: Option<f64>,
    command_to: Option<f64>,
    residual_rms_rev_s: f64,
    verdict: &'static str,
}

#[derive(Serialize)]
struct OneMotorLine<'a> {
    name: &'a str,
    command: Option<&'a str>,
    interval_s: f64,
    is_too_slow: bool,
    time_constant_up_s: Option<CombinedLine>,
    time_constant_down_s: Option<CombinedLine>,
    dead_time_s: Option<CombinedLine>,
    speed_rev_s_max: f64,
    static_map: Option<MapLine>,
}

#[derive(Serialize)]
struct MapLine {
    from: &'static str,
    gain_rev_s: Option<f64>,
    gain_std_rev_s: Option<f64>,
    offset_rev_s: Option<f64>,
    points: Vec<PointLine>,
}

#[derive(Serialize)]
struct PointLine {
    command: f64,
    speed_rev_s: f64,
    speed_std_rev_s: f64,
    is_saturated: bool,
}

/// The motors of a log as one JSON object on a line.
///
/// # Errors
/// None is known, since all types can be serialised.
pub fn motor_json(record: &MotorRecord) -> Result<String, serde_json::Error> {
    let constants = record.constants();
    let steps =
        record.motors.iter().flat_map(|motor| motor.model.steps.iter().map(|step| step_line(&motor.name, step)));
    let line = MotorLine {
        file: &record.file,
        has_rotor_speed: !record.motors.is_empty(),
        time_constant_up_s: constants.time_constant_up_s.map(combined_line),
        time_constant_down_s: constants.time_constant_down_s.map(combined_line),
        dead_time_s: constants.dead_time_s.map(combined_line),
        speed_rev_s_max: Some(constants.speed_rev_s_max).filter(|speed_rev_s| *speed_rev_s > 0.0),
        steps: steps.collect(),
        motors: record.motors.iter().map(one_motor_line).collect(),
        version: VERSION,
    };
    Ok(serde_json::to_string(&line)? + "\n")
}

fn combined_line(combined: CombinedEstimate) -> CombinedLine {
    let CombinedEstimate { estimate, step_count } = combined;
    CombinedLine { value: estimate.value, std_uncertainty: estimate.std_uncertainty, step_count }
}

fn step_line<'a>(motor: &'a str, step: &MotorStep) -> StepLine<'a> {
    let value = |estimate: Option<Estimate>| estimate.map(|estimate| estimate.value);
    let std = |estimate: Option<Estimate>| estimate.and_then(|estimate| estimate.std_uncertainty);
    StepLine {
        motor,
        time_s: step.time_s.value,
        time_std_s: step.time_s.std_uncertainty,
        speed_from_rev_s: step.speed_from_rev_s,
        speed_to_rev_s: step.speed_to_rev_s,
        time_constant_s: value(step.time_constant_s),
        time_constant_std_s: std(step.time_constant_s),
        dead_time_s: value(step.dead_time_s),
        dead_time_std_s: std(step.dead_time_s),
        command_from: step.command.map(|command| command[0]),
        command_to: step.command.map(|command| command[1]),
        residual_rms_rev_s: step.residual_rms_rev_s,
        verdict: match step.verdict {
            StepVerdict::Used => "used",
            StepVerdict::TooSlowRows => "too_slow_rows",
            StepVerdict::Saturated => "saturated",
            StepVerdict::AtRest => "at_rest",
            StepVerdict::OtherCurve => "other_curve",
            StepVerdict::Uncertain => "uncertain",
        },
    }
}

fn one_motor_line(motor: &LoggedMotor) -> OneMotorLine<'_> {
    let constants = constants_of(std::slice::from_ref(&motor.model));
    OneMotorLine {
        name: &motor.name,
        command: motor.command.as_deref(),
        interval_s: motor.model.interval_s,
        is_too_slow: motor.model.is_too_slow,
        time_constant_up_s: constants.time_constant_up_s.map(combined_line),
        time_constant_down_s: constants.time_constant_down_s.map(combined_line),
        dead_time_s: constants.dead_time_s.map(combined_line),
        speed_rev_s_max: motor.model.speed_rev_s_max,
        static_map: motor.model.static_map.as_ref().map(map_line),
    }
}

fn map_line(map: &StaticMap) -> MapLine {
    let point = |point: &MapPoint| PointLine {
        command: point.command,
        speed_rev_s: point.speed_rev_s,
        speed_std_rev_s: point.speed_std_rev_s,
        is_saturated: point.is_saturated,
    };
    MapLine {
        from: match map.origin {
            MapOrigin::Plateaus => "plateaus",
            MapOrigin::Rows => "rows",
        },
        gain_rev_s: map.gain_rev_s.map(|gain| gain.value),
        gain_std_rev_s: map.gain_rev_s.and_then(|gain| gain.std_uncertainty),
        offset_rev_s: map.offset_rev_s,
        points: map.points.iter().map(point).collect(),
    }
}
