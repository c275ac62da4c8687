//! `hovertone greybox`: the low-level model from a flight of doublets.

mod flight;
mod scenario;
mod start;

pub(crate) use flight::{FlightFiles, FlownLog, GreyBoxVehicle, Heard, Speeds, fit_of, speeds_of};
pub(crate) use scenario::{scenario_file, scenario_toml};

use crate::args::{BodyAxes, GreyBoxArguments, HearingArguments};
use crate::failure::{Ending, Failure};
use crate::figure_file::FigureKind;
use crate::log::{column_names, loss_notice};
use crate::of_recording::{flags_of, refuse_of_recording};
use crate::outputs::{Outputs, is_recording, written};
use crate::progress::Progress;
use crate::recording::Hearing;
use crate::terminal::Terminal;
use crate::text_file::{TextFormat, TextKind};
use hovertone_dynamics::{SpeedObservation, YawInertia, advice_of, checked, torque_constant};
use hovertone_figures::{DOTS_PER_INCH, DrawnSpeeds, grey_box_figure};
use hovertone_logs::RateAxes;
use hovertone_report::{CheckedFlight, GreyBoxRecord, Notice, grey_box_json, grey_box_text, grey_box_warnings};
use std::path::PathBuf;

const SCENARIO: TextKind =
    TextKind { content: "a scenario", format: TextFormat::Toml, example: "--scenario scenario.toml" };

/// Fits, prints, and writes what was asked for.
pub(crate) fn run(arguments: &GreyBoxArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let vehicle = GreyBoxVehicle::find(&arguments.vehicle, arguments.mass_kg)?;
    let files = FlightFiles::typed(&arguments.files);
    refuse_unheard(arguments)?;
    let other = (!arguments.check.is_empty()).then(|| FlightFiles::typed(&arguments.check));
    let outputs = Outputs::beside(arguments.files.iter().chain(&arguments.check), arguments.replace.force);
    let kind = checked_outputs(arguments, &outputs)?;
    let reader = LogReader::of(arguments)?;
    let mut flown = reader.read(&files, &vehicle)?;
    let mut other_flown = other.as_ref().map(|files| reader.read(files, &vehicle)).transpose()?;
    let progress = Progress::new("listening to", 1, !arguments.hearing.no_progress);
    let hearing = Hearing::of(&arguments.hearing);
    let heard = fit_of(&files, &mut flown, &vehicle, hearing, &progress)?;
    let checked_speeds = other
        .as_ref()
        .zip(other_flown.as_mut())
        .map(|(files, flown)| speeds_of(files, flown, &heard, &vehicle, hearing, &progress));
    let checked_speeds = checked_speeds.transpose()?;
    progress.finish();
    let moved_s = other_flown.as_ref().map_or(0.0, |flown| flown.moved_s);
    let compared =
        other.as_ref().zip(checked_speeds.as_ref()).map(|(files, speeds)| OtherFlight { files, speeds, moved_s });
    let record = record_of(&files, &flown, &heard, &vehicle, compared);
    let losses: Vec<Notice> = [Some(&flown), other_flown.as_ref()]
        .into_iter()
        .flatten()
        .filter_map(|flown| flown.loss.as_ref())
        .map(|words| loss_notice(words))
        .collect();
    let warnings: Vec<Notice> =
        grey_box_warnings(&record).into_iter().chain(losses.iter().cloned()).chain(flown.left_out.clone()).collect();
    terminal.warning_count(warnings.len());
    warnings.iter().for_each(|notice| terminal.warning(notice, ""));
    match arguments.json {
        true => terminal.data(&grey_box_json(&record, &warnings).map_err(Failure::internal)?)?,
        false => terminal.text(&grey_box_text(&record, terminal.fold_width()))?,
    }
    terminal.flush()?;
    if let Some(place) = &arguments.scenario {
        outputs.write(place, scenario_toml(&heard.fit, &vehicle)?)?;
        terminal.say(&written(place));
    }
    if let (Some(place), Some(kind)) = (&arguments.figure, kind) {
        let own = heard.speeds(&flown);
        let drawn = checked_speeds.as_ref().unwrap_or(&own);
        let drawn = DrawnSpeeds {
            observations: &drawn.observations,
            prediction: &drawn.prediction,
            source: if other.as_ref().unwrap_or(&files).recording.is_some() { "heard" } else { "logged" },
            places: record.places,
        };
        let figure = grey_box_figure(&drawn).map_err(Failure::internal)?;
        outputs.write(place, kind.bytes(figure, DOTS_PER_INCH)?)?;
        terminal.say(&written(place));
    }
    Ok(if losses.is_empty() && !record.is_doubtful() { Ending::Done } else { Ending::Incomplete })
}

/// A flight that was not used for the fit.
pub(crate) struct OtherFlight<'a> {
    pub(crate) files: &'a FlightFiles,
    pub(crate) speeds: &'a Speeds,
    pub(crate) moved_s: f64,
}

/// The record of a fit, with the flight that was not used.
pub(crate) fn record_of(
    files: &FlightFiles,
    flown: &FlownLog,
    heard: &Heard,
    vehicle: &GreyBoxVehicle,
    other: Option<OtherFlight<'_>>,
) -> GreyBoxRecord {
    let body = YawInertia::of(&vehicle.parameters);
    GreyBoxRecord {
        recording: files.recording_name(),
        log: files.log_name(),
        vehicle: vehicle.id().to_owned(),
        are_speeds_logged: files.recording.is_none(),
        length_s: length_s(&heard.observations),
        row_s: flown.inputs.row_s,
        fit: heard.fit.clone(),
        slope_v_s_rad: vehicle.slope_v_s_rad(&heard.fit),
        places: vehicle.parameters.layout.value.place_names(),
        names_nats: heard.names_nats,
        echoes: heard.echoes,
        torque_constant: torque_constant(&flown.log, &flown.inputs, &heard.fit, &body),
        advice: advice_of(&heard.fit, &flown.inputs),
        fitted: checked(&heard.observations, &heard.fit.prediction(&flown.inputs)),
        log_moved_s: flown.moved_s,
        better: heard.better,
        other_hover: heard.other_hover,
        other_flight: other.map(|OtherFlight { files, speeds, moved_s }| CheckedFlight {
            recording: files.recording_name(),
            log: files.log_name(),
            log_moved_s: moved_s,
            result: checked(&speeds.observations, &speeds.prediction),
        }),
    }
}

/// Time from the first to the last observation.
fn length_s(observations: &[SpeedObservation]) -> f64 {
    let ends = observations.first().zip(observations.last());
    ends.map_or(0.0, |(first, last)| last.time_s - first.time_s)
}

/// Checks, before any work, that all outputs can be written.
fn checked_outputs(arguments: &GreyBoxArguments, outputs: &Outputs) -> Result<Option<FigureKind>, Failure> {
    let kind = |place: &PathBuf| FigureKind::of(place, "use --figure check.png or --figure check.svg");
    let kind = arguments.figure.as_ref().map(kind).transpose()?;
    arguments.scenario.as_deref().map_or(Ok(()), |place| outputs.check_text(place, SCENARIO))?;
    arguments.figure.as_deref().map_or(Ok(()), |place| outputs.check(place))?;
    Ok(kind)
}

/// Refuses flags about a recording where logs alone are given.
fn refuse_unheard(arguments: &GreyBoxArguments) -> Result<(), Failure> {
    match (arguments.files.as_slice(), arguments.check.len()) {
        ([log], 0 | 1) => {
            let of_log = ["--log-offset-s".to_owned()];
            refuse_of_recording(&[&of_log[..], &flags_of::<HearingArguments>()].concat(), log)
        }
        _ => Ok(()),
    }
}

/// How logs are read.
struct LogReader {
    names: hovertone_logs::ColumnNames,
    axes: RateAxes,
    offset_s: f64,
}

impl LogReader {
    fn of(arguments: &GreyBoxArguments) -> Result<Self, Failure> {
        let offset_s = arguments.log_offset_s.unwrap_or(0.0);
        let axes = match arguments.log_axes {
            Some(BodyAxes::Frd) => RateAxes::ForwardRightDown,
            _ => RateAxes::ForwardLeftUp,
        };
        Ok(Self { names: column_names(&arguments.column)?, axes, offset_s })
    }

    fn read(&self, files: &FlightFiles, vehicle: &GreyBoxVehicle) -> Result<FlownLog, Failure> {
        if files.recording.as_deref().is_some_and(|recording| !is_recording(recording)) && is_recording(&files.log) {
            return Err(Failure::failed(
                "the recording and the log are swapped",
                "give the recording first, then the log",
                &files.log,
            ));
        }
        // logged speeds have the clock of the log
        let offset_s = if files.recording.is_some() { self.offset_s } else { 0.0 };
        FlownLog::read(&files.log, &self.names, self.axes, offset_s, vehicle)
    }
}
