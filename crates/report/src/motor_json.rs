//! Constants of motors from a log as a JSON line for programs.

use crate::motor::torque_reason;
use crate::motor_record::{LoggedMotor, MotorRecord, MotorSource};
use crate::version::VERSION;
use hovertone_dynamics::{
    BenchTorque, CombinedEstimate, LoadTerm, MapOrigin, MapPoint, MotorStep, StaticMap, StepVerdict, constants_of,
};
use hovertone_vehicle::Estimate;
use serde::Serialize;

#[derive(Serialize)]
struct MotorLine<'a> {
    file: &'a str,
    source: &'static str,
    has_rotor_speed: bool,
    frame_s: Option<f64>,
    offset_s: Option<f64>,
    reason: Option<&'a str>,
    time_constant_up_s: Option<CombinedLine>,
    time_constant_down_s: Option<CombinedLine>,
    dead_time_s: Option<CombinedLine>,
    load_term: Option<LoadLine>,
    speed_rev_s_max: Option<f64>,
    torque_constant_n_m_s2: Option<f64>,
    torque_constant_std_n_m_s2: Option<f64>,
    torque_constant_reason: Option<String>,
    steps: Vec<StepLine<'a>>,
    motors: Vec<OneMotorLine<'a>>,
    version: &'static str,
}

/// A combined estimate for programs.
#[derive(Serialize)]
pub(crate) struct CombinedLine {
    value: f64,
    std_uncertainty: Option<f64>,
    step_count: usize,
}

#[derive(Serialize)]
struct LoadLine {
    unloaded_rate_per_s: f64,
    unloaded_rate_std_per_s: Option<f64>,
    square_per_rev: f64,
    square_std_per_rev: Option<f64>,
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
    let sound = match &record.source {
        MotorSource::Log => None,
        MotorSource::Sound(sound) => Some(sound),
    };
    let torque = record.torque.and_then(|torque| match torque {
        BenchTorque::Told { constant_n_m_s2, .. } => Some(constant_n_m_s2),
        _ => None,
    });
    let line = MotorLine {
        file: &record.file,
        source: if sound.is_some() { "sound" } else { "log" },
        frame_s: sound.map(|sound| sound.frame_s).filter(|frame_s| *frame_s > 0.0),
        offset_s: sound.and_then(|sound| sound.offset_s),
        reason: sound.and_then(|sound| sound.no_tone.as_deref()),
        has_rotor_speed: !record.motors.is_empty(),
        time_constant_up_s: constants.time_constant_up_s.map(combined_line),
        time_constant_down_s: constants.time_constant_down_s.map(combined_line),
        dead_time_s: constants.dead_time_s.map(combined_line),
        load_term: constants.load_term.map(load_line),
        speed_rev_s_max: Some(constants.speed_rev_s_max).filter(|speed_rev_s| *speed_rev_s > 0.0),
        torque_constant_n_m_s2: torque.map(|constant| constant.value),
        torque_constant_std_n_m_s2: torque.and_then(|constant| constant.std_uncertainty),
        torque_constant_reason: record.torque.as_ref().and_then(torque_reason),
        steps: steps.collect(),
        motors: record.motors.iter().map(one_motor_line).collect(),
        version: VERSION,
    };
    Ok(serde_json::to_string(&line)? + "\n")
}

pub(crate) fn combined_line(combined: CombinedEstimate) -> CombinedLine {
    let CombinedEstimate { estimate, step_count } = combined;
    CombinedLine { value: estimate.value, std_uncertainty: estimate.std_uncertainty, step_count }
}

fn load_line(load: LoadTerm) -> LoadLine {
    LoadLine {
        unloaded_rate_per_s: load.unloaded_rate_per_s.value,
        unloaded_rate_std_per_s: load.unloaded_rate_per_s.std_uncertainty,
        square_per_rev: load.square_per_rev.value,
        square_std_per_rev: load.square_per_rev.std_uncertainty,
    }
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
