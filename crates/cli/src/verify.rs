//! `hovertone verify`: sound against telemetry.

use crate::args::VerifyArguments;
use crate::failure::{Ending, Failure};
use crate::figure_file::FigureKind;
use crate::inputs::name_of;
use crate::jobs::jobs_of;
use crate::log::{column_names, notices_of, without_speeds};
use crate::motor::flight_of;
use crate::outputs::{Outputs, written};
use crate::progress::Progress;
use crate::recording::{Hearing, Requests, records_of};
use crate::settings::{config_of, idle_mass, refuse_of_table};
use crate::terminal::Terminal;
use crate::which_speed::which_is_right;
use crate::wording::IN_VERIFY;
use hovertone::rotors::{LoggedSpeeds, NotVerified, Verification, verification_of_heard};
use hovertone::speed::TrackPoint;
use hovertone_figures::{DOTS_PER_INCH, verification_figure};
use hovertone_report::{
    Notice, SpeedRecord, VerificationRecord, small_plus_minus, verification_json, verification_text,
};
use std::path::Path;

/// Hears the recording and compares it with the log.
pub(crate) fn run(arguments: &VerifyArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let names = column_names(&arguments.column)?;
    let outputs = Outputs::beside([&arguments.recording, &arguments.log], arguments.replace.force);
    let figure = arguments.figure.as_deref().map(|place| FigureFile::of(place, &outputs)).transpose()?;
    refuse_of_table(&arguments.analysis, "the comparison uses the speed of each moment, without the ± of the mean")?;
    let (config, discovery) = config_of(&arguments.tone, &arguments.known, &arguments.analysis)?;
    if let Some(notice) = idle_mass(&arguments.known, &config.known) {
        terminal.tip(&notice);
    }
    let which_is_right = which_is_right(&config, discovery.as_ref());
    let jobs = jobs_of(std::slice::from_ref(&arguments.recording), &config, discovery, Requests::default())?;
    if jobs.len() > 1 {
        let what = format!("the log belongs to one flight, but {} recordings match the name", jobs.len());
        return Err(Failure::usage(what, "give the recording of this flight"));
    }
    let log = &arguments.log;
    let Some(flight) = flight_of(log, &names)? else {
        return Err(Failure::failed(
            "this is no log",
            "give the recording first, then the log of the same flight (PX4, ArduPilot, Betaflight or CSV)",
            log,
        ));
    };
    let Some(speeds) = &flight.speeds_rev_s else {
        return Err(without_speeds(log, &flight));
    };
    let progress = Progress::new("listening to", 1, !arguments.hearing.no_progress);
    let heard = records_of(&jobs, Hearing::of(&arguments.hearing), &progress).into_iter();
    let records: Vec<SpeedRecord> = heard.map(|record| record.worded(IN_VERIFY)).collect();
    progress.finish();
    let Some(record) = records.first() else { return Err(Failure::internal("a recording without a record")) };
    if let Some(reason) = record.reason().filter(|_| record.has_failed()) {
        return Err(Failure::failed(reason, "", &arguments.recording));
    }
    terminal.counted_notes_and(&notices_of(&flight), &[record]);
    if record.speed().is_none() {
        let or_vehicle = if arguments.tone.vehicle.is_none() { ", or give --vehicle NAME" } else { "" };
        terminal.say(&match record.is_ambiguous() {
            true => format!(
                "nothing was compared, because several speeds are possible; to find the right speed, {which_is_right}{or_vehicle}"
            ),
            false => "nothing was compared, because no speed was heard in the recording".to_owned(),
        });
        return Ok(Ending::Incomplete);
    }
    let logged = LoggedSpeeds { time_s: &speeds.time_s, names: &speeds.names, speeds_rev_s: &speeds.values };
    let offsets_s = arguments.log_offset_s.map(|(low_s, high_s)| [low_s, high_s]);
    let verification = verification_of(record, logged, offsets_s).map_err(|reason| {
        let blamed = if reason == NotVerified::NoTrack { &arguments.recording } else { log };
        Failure::failed(reason.to_string(), reason.hint(), blamed)
    })?;
    let passes = verification.passes();
    let is_unknown = !verification.is_offset_told && !verification.is_offset_given;
    if let Some([low_s, high_s]) = offsets_s.filter(|_| is_unknown) {
        let what = format!("the limits {low_s}:{high_s} of --log-offset-s are too wide to count as a known offset");
        terminal.warning(&Notice::new(what, "give limits at most 2 s apart"), "");
    }
    // the text says it in its last line
    if let Some(notice) = small_plus_minus(&verification).filter(|_| arguments.json) {
        terminal.warning(&notice, "");
    }
    let told = VerificationRecord { file: record.file.clone(), log: name_of(log), verification };
    if arguments.json {
        terminal.data(&verification_json(&told).map_err(Failure::internal)?)?;
    } else {
        terminal.text(&verification_text(&told, terminal.fold_width()))?;
    }
    if let Some(FigureFile { place, kind }) = figure
        && let Some(drawn) = verification_figure(&told.verification).map_err(Failure::internal)?
    {
        terminal.flush()?;
        outputs.write(place, kind.bytes(drawn, DOTS_PER_INCH)?)?;
        terminal.say(&written(place));
    }
    Ok(if passes && flight.notes.is_empty() { Ending::Done } else { Ending::Incomplete })
}

/// Where the figure goes.
struct FigureFile<'a> {
    place: &'a Path,
    kind: FigureKind,
}

impl<'a> FigureFile<'a> {
    /// Checks, before any work, that the figure can be written.
    fn of(place: &'a Path, outputs: &Outputs) -> Result<Self, Failure> {
        let kind = FigureKind::of(place, "use --figure check.png or --figure check.svg")?;
        outputs.check(place)?;
        Ok(Self { place, kind })
    }
}

/// Compares a recording with a log.
pub(crate) fn verification_of(
    record: &SpeedRecord,
    logged: LoggedSpeeds<'_>,
    offsets_s: Option<[f64; 2]>,
) -> Result<Verification, NotVerified> {
    let tracks = record.tone().map_or_else(Vec::new, |tone| tone.tracks_beside_log(record.method));
    let tracks: Vec<&[TrackPoint]> = tracks.iter().map(AsRef::as_ref).collect();
    verification_of_heard(&tracks, record.rotors_heard(), logged, offsets_s)
}
