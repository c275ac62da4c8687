//! Which rotor is which, by a log of the same flight or by the order in which the motors were started.

use crate::args::{BodyAxes, FrameLayout, LabelArguments};
use crate::failure::Failure;
use crate::inputs::open_stream;
use crate::log::{THE_LOG, log_failure, loss_notice};
use crate::recording::Heard;
use crate::spin_up::names_of;
use hovertone::rotors::{
    FlightLog, LabelSource, LabelsConfig, LogSignals, MotorSignal, RotorLabels, labels_from_log, labels_from_spin_up,
};
use hovertone::speed::TrackPoint;
use hovertone_logs::{ColumnNames, LoggedFlight, LoggedMotors, LoggedRates, RateAxes, flight_from_log};
use hovertone_report::{Notice, SpeedRecord, Wording};
use hovertone_vehicle::{Layout, RotorPlace, RotorSpeed, Vehicle, flight_preset_names};
use std::path::Path;

/// Beside signals whose axes no argument gives.
const WITHOUT_AXES: Wording = Wording::of_phrases(&[(", and check the direction of the axes (--log-axes)", "")]);

/// The meaning of the arguments.
pub(crate) enum LabelPlan {
    /// A log.
    Log {
        /// Its signals, the most informative first.
        logs: Vec<FlightLog>,
        /// Defects of the log.
        notes: Vec<String>,
        /// Whether the axes of its body rates are those of the arguments: a CSV does not define them.
        are_axes_said: bool,
        config: LabelsConfig,
    },
    /// Numbers and names in the order of the motors' start.
    SpinUp(Vec<(usize, String)>),
}

/// Reads the log, or the order of the starts, where the arguments have one. `recordings` and `rotors` are their numbers.
pub(crate) fn resolve(
    arguments: &LabelArguments,
    vehicle: Option<&Vehicle>,
    recordings: usize,
    rotors: u32,
) -> Result<Option<LabelPlan>, Failure> {
    let (what, flag) = match (&arguments.log, &arguments.spin_up) {
        (None, None) => return Ok(None),
        (Some(_), _) => ("a log", "--log"),
        (None, Some(_)) => ("a sequence of motor starts", "--spin-up"),
    };
    if recordings != 1 {
        let what = format!("{what} ({flag}) belongs to one flight, but {recordings} recordings are given");
        return Err(Failure::usage(what, "give only the recording of the same flight"));
    }
    refuse_fewer_than_two(rotors, flag)?;
    let Some(path) = &arguments.log else {
        let typed = arguments.spin_up.as_deref().unwrap_or_default();
        return Ok(Some(LabelPlan::SpinUp(names_of(typed, vehicle, rotors)?)));
    };
    let stream = open_stream(path, THE_LOG)?;
    let mut logged = flight_from_log(stream, &ColumnNames::default()).map_err(|error| log_failure(&error, path))?;
    let (offset_s_low, offset_s_high) = arguments.log_offset_s.unzip();
    let config = LabelsConfig { offset_s_low, offset_s_high, ..LabelsConfig::default() };
    config.check()?;
    let notes = std::mem::take(&mut logged.notes);
    let are_axes_said = logged.rates.as_ref().is_some_and(|rates| rates.axes.is_none());
    let logs = logs_of(logged, arguments, vehicle, path)?;
    Ok(Some(LabelPlan::Log { logs, notes, are_axes_said, config }))
}

/// Refuses a flag that tells which rotor is which, where the number of rotors is not given or is 1.
pub(crate) fn refuse_fewer_than_two(rotors: u32, flag: &str) -> Result<(), Failure> {
    if rotors >= 2 {
        return Ok(());
    }
    Err(Failure::usage(
        format!("to tell by {flag} which rotor is which, hovertone needs the number of rotors, 2 or more"),
        format!("give the number of rotors, as in --rotors 4; if only one rotor turns, leave {flag} out"),
    ))
}

/// The signals of a log in the order of their information: measured speeds, commands, rates of the body.
fn logs_of(
    logged: LoggedFlight,
    arguments: &LabelArguments,
    vehicle: Option<&Vehicle>,
    path: &Path,
) -> Result<Vec<FlightLog>, Failure> {
    let mut logs = logs_of_motors(&logged, path)?;
    if let Some(LoggedRates { time_s, rates_rad_s: [x, y, z], axes }) = logged.rates {
        match (axes_of(axes, arguments.log_axes)?, places_of(arguments.layout, vehicle)) {
            (Some(axes), Some(places)) => {
                let turned = |rates: Vec<f64>| match axes {
                    BodyAxes::Flu => rates,
                    BodyAxes::Frd => rates.into_iter().map(|rate| -rate).collect(),
                };
                let rates_rad_s = [x, turned(y), turned(z)];
                let signals = LogSignals::BodyRates { places: places.to_vec(), rates_rad_s };
                logs.push(FlightLog::new(time_s, signals).map_err(|error| wrong_log(&error, path))?);
            }
            // speeds or commands are enough
            _ if !logs.is_empty() => {}
            (None, _) => {
                return Err(Failure::usage(
                    "the log has the rates at which the vehicle turns, but the direction of their axes is not known: \
                     front and rear rotors could be swapped",
                    "give --log-axes flu (x forward, y left, z up) or --log-axes frd (x forward, y right, z down, as in \
                     PX4 and ArduPilot)",
                ));
            }
            (_, None) => {
                return Err(Failure::usage(
                    "the log has the rates at which the vehicle turns, but the places of the rotors are not known",
                    format!("give --layout x or --layout plus, or --vehicle with {}", with_known_frame()),
                ));
            }
        }
    }
    Ok(logs)
}

/// The speeds and commands of motors in a log, the more informative first. Electrical speeds tell the names as well: a common factor has no effect.
pub(crate) fn logs_of_motors(logged: &LoggedFlight, path: &Path) -> Result<Vec<FlightLog>, Failure> {
    let electrical = || logged.electrical.as_ref().map(|electrical| electrical.motors.clone());
    let speeds_rev_s = logged.speeds_rev_s.clone().or_else(electrical);
    let motors = |logged: LoggedMotors, signal| {
        let LoggedMotors { time_s, names, values } = logged;
        FlightLog::new(time_s, LogSignals::Motors { signal, names, values }).map_err(|error| wrong_log(&error, path))
    };
    let speeds = speeds_rev_s.map(|speeds| motors(in_rad_s(speeds), MotorSignal::Speed)).transpose()?;
    let commands = logged.commands.clone().map(|commands| motors(commands, MotorSignal::Command)).transpose()?;
    Ok(speeds.into_iter().chain(commands).collect())
}

fn wrong_log(error: &hovertone::rotors::LogError, path: &Path) -> Failure {
    Failure::failed(error.to_string(), "correct the log", path)
}

fn in_rad_s(speeds_rev_s: LoggedMotors) -> LoggedMotors {
    let rad_s = |values: Vec<f64>| values.into_iter().map(|rev_s| RotorSpeed::from_rev_s(rev_s).rad_s()).collect();
    LoggedMotors { values: speeds_rev_s.values.into_iter().map(rad_s).collect(), ..speeds_rev_s }
}

/// The axes of the format where it defines them, else the axes of the arguments.
fn axes_of(of_format: Option<RateAxes>, said: Option<BodyAxes>) -> Result<Option<BodyAxes>, Failure> {
    let of_format = of_format.map(|axes| match axes {
        RateAxes::ForwardLeftUp => BodyAxes::Flu,
        RateAxes::ForwardRightDown => BodyAxes::Frd,
    });
    match (of_format, said) {
        (Some(BodyAxes::Frd), Some(BodyAxes::Flu)) => Err(contradicted("y right and z down", "flu")),
        (Some(BodyAxes::Flu), Some(BodyAxes::Frd)) => Err(contradicted("y left and z up", "frd")),
        (of_format, said) => Ok(of_format.or(said)),
    }
}

/// The failure of axes that contradict the format of the log.
fn contradicted(of_format: &str, said: &str) -> Failure {
    Failure::usage(
        format!(
            "in a log of this format, the axes are always x forward, {of_format}; --log-axes {said} contradicts the format"
        ),
        "leave --log-axes out: the flag is only for CSV logs",
    )
}

/// "one of ardrone, crazyflie": the vehicles whose rotors have known places.
pub(crate) fn with_known_frame() -> String {
    format!("one of {}", flight_preset_names().join(", "))
}

/// Positions of the rotors with arms of 1 m: only their proportions matter.
fn places_of(layout: Option<FrameLayout>, vehicle: Option<&Vehicle>) -> Option<[RotorPlace; 4]> {
    let known = || Some(vehicle?.flight_parameters()?.layout.value);
    let layout = layout.map(|layout| match layout {
        FrameLayout::X => Layout::X,
        FrameLayout::Plus => Layout::Plus,
    });
    Some(layout.or_else(known)?.places(1.0))
}

/// Says of a recording that no rotor is named, where its shaft speed is ambiguous.
pub(crate) fn note_if_ambiguous(record: &mut SpeedRecord) {
    if record.is_ambiguous() {
        let hint = "find the right shaft speed first: the line \"ambiguous\" says how";
        record.notices.push(Notice::new("no rotor gets a name, because several shaft speeds are possible", hint));
    }
}

/// Labels the rotors of a recording, with a notice where a label is missing.
pub(crate) fn label(heard: &mut Heard, plan: &LabelPlan) {
    let Heard { record, config: heard_with, spin_up, .. } = heard;
    if record.speed().is_none() {
        return;
    }
    let labels = match plan {
        LabelPlan::Log { logs, notes, config, .. } => {
            record.notices.extend(notes.iter().map(|note| loss_notice(note)));
            labels_of_record(record, heard_with.rotors.count, logs, config)
        }
        LabelPlan::SpinUp(names) => spin_up
            .as_ref()
            .map(|spin_up| labels_from_spin_up(spin_up, record.rotors().len(), names, &LabelsConfig::default())),
    };
    let notice = labels.as_ref().and_then(notice_of);
    let is_by_rates = labels.as_ref().is_some_and(|labels| labels.source == LabelSource::BodyRates);
    let has_axes = is_by_rates && matches!(plan, LabelPlan::Log { are_axes_said: true, .. });
    record.notices.extend(notice.map(|notice| if has_axes { notice } else { notice.worded(WITHOUT_AXES) }));
    record.labels = labels;
}

/// That not all rotors have a name, why, and what to do.
pub(crate) fn notice_of(labels: &RotorLabels) -> Option<Notice> {
    Some(Notice::new(labels.why_not_all()?, labels.not_told.as_ref()?.hint()))
}

/// The labels of the separated rotors of a recording by the best of the signals of a log.
pub(crate) fn labels_of_record(
    record: &SpeedRecord,
    rotor_count: u32,
    logs: &[FlightLog],
    config: &LabelsConfig,
) -> Option<RotorLabels> {
    let tracks: Vec<&[TrackPoint]> = record.rotors().iter().map(|rotor| rotor.track.as_slice()).collect();
    best_of(logs.iter().map(|log| labels_from_log(&tracks, rotor_count as usize, log, config)))
}

/// The first set of labels that is complete; else the set with the most labels.
fn best_of(all: impl Iterator<Item = RotorLabels>) -> Option<RotorLabels> {
    let told = |labels: &RotorLabels| labels.rotors.iter().flatten().count();
    let mut best: Option<RotorLabels> = None;
    for labels in all {
        if labels.not_told.is_none() {
            return Some(labels);
        }
        if best.as_ref().is_none_or(|best| told(&labels) > told(best)) {
            best = Some(labels);
        }
    }
    best
}
