//! `identify --check`: what would be done, which files were found, and what is missing, without analysis.

use super::logs::FlownLog;
use super::recordings::{FoundRecordings, Missing, found_recordings, refuse_twice};
use super::{ExperimentSource, LoadJob, checked_folder, hearing_of};
use crate::args::IdentifyArguments;
use crate::failure::{Ending, Failure};
use crate::recording::{Hearing, Job};
use crate::terminal::Terminal;
use hovertone::experiment::Experiment;
use hovertone::thrust::{Force, Gravity, ThrustWarning};
use hovertone_report::{
    Notice, PlannedExperiment, PlannedLoad, PlannedRecording, PlannedSound, Wording, counted, planned_experiment_text,
};
use std::path::Path;

/// Before anything is heard there is no constant that a person could use.
const BEFORE_HEARING: Wording = Wording::of_phrases(&[("do not use this constant: ", "")]);
/// Fewest loads that test the square law well.
const LOADS_WANTED: usize = 3;

/// Prints the plan of an experiment and what it lacks. A recording that is missing, or cannot be read, is a failure.
pub(super) fn run(
    source: &ExperimentSource,
    arguments: &IdentifyArguments,
    terminal: &mut Terminal,
) -> Result<Ending, Failure> {
    let FoundRecordings { mut jobs, missing } = found_recordings(source, arguments.data_root.as_deref())?;
    refuse_twice(&mut jobs, source)?;
    checked_folder(source, &jobs, arguments)?;
    let logs = jobs.iter().filter_map(|job| job.log.clone()).filter(|log| log.path.is_file());
    for log in logs {
        FlownLog::read(log, false)?;
    }
    let experiment = &source.experiment;
    let hearing = hearing_of(&arguments.hearing, experiment, false);
    let loads: Vec<PlannedLoad> = experiment
        .loads
        .iter()
        .map(|load| PlannedLoad {
            name: load.name.clone(),
            force: load.force,
            recordings: of_load(&jobs, &load.name).map(|job| planned(job, hearing)).collect(),
        })
        .collect();
    let plan = PlannedExperiment {
        vehicle_name: &experiment.vehicle_name,
        rotor_count: experiment.rotor_count,
        order: experiment.config.tone.order,
        propeller_diameter_m: experiment.propeller_diameter_m,
        method: arguments.method.unwrap_or(experiment.config.method),
        loads,
    };
    terminal.text(&planned_experiment_text(&plan, terminal.fold_width()))?;
    terminal.flush()?;
    let faults = faults_of(&plan, &missing, arguments.data_root.as_deref().unwrap_or(&source.folder));
    faults.iter().for_each(|fault| terminal.error(fault));
    let counts: Vec<usize> = plan.loads.iter().map(|load| load.recordings.len()).collect();
    let warnings = experiment.warnings_before_hearing(&counts);
    let worded = |warning: &ThrustWarning| Notice::from(warning).worded(BEFORE_HEARING).worded(source.wording);
    warnings.iter().for_each(|warning| terminal.warning(&worded(warning), ""));
    wishes_of(experiment, source.typed.is_some()).iter().for_each(|wish| terminal.tip(wish));
    terminal.text(&format!("\n{}", verdict(faults.len(), warnings.len(), arguments.output.as_deref())))?;
    Ok(if faults.is_empty() { Ending::Done } else { Ending::FilesFailed })
}

fn of_load<'a>(jobs: &'a [LoadJob], load: &'a str) -> impl Iterator<Item = &'a Job> {
    jobs.iter().filter(move |job| job.load == load).map(|LoadJob { job, .. }| job)
}

fn planned(job: &Job, hearing: Hearing) -> PlannedRecording {
    let opened = job.open(hearing);
    let sound = opened.map_err(|error| error.to_string()).and_then(|recording| {
        let info = recording.info();
        let (from_s, ends_s) =
            (job.config.span.from_s, info.declared_duration_s.map(|length_s| info.start_s + length_s));
        if let Some((from_s, ends_s)) = from_s.zip(ends_s).filter(|(from_s, ends_s)| from_s >= ends_s) {
            return Err(format!(
                "it ends at {ends_s:.1} s, before the chosen part begins at {from_s} s; correct from_s under [[load]]"
            ));
        }
        Ok(PlannedSound {
            length_s: info.declared_duration_s,
            sample_rate_hz: info.sample_rate_hz,
            channel_count: info.channel_count,
            codec: info.codec.clone(),
        })
    });
    PlannedRecording { file: job.name.clone(), sound }
}

/// What makes the analysis impossible.
fn faults_of(plan: &PlannedExperiment<'_>, missing: &[Missing<'_>], root: &Path) -> Vec<Notice> {
    let missing = missing.iter().map(|missing| missing.notice(root));
    let recordings = plan.loads.iter().flat_map(|load| &load.recordings);
    let broken = recordings.filter_map(|recording| {
        let reason = recording.sound.as_ref().err()?;
        Some(Notice::new(format!("{}: {reason}", recording.file), ""))
    });
    missing.chain(broken).collect()
}

/// What would make the answer better, beside what the warnings say. Flags stand in place of the file where the experiment is typed.
fn wishes_of(experiment: &Experiment, is_typed: bool) -> Vec<Notice> {
    let hovers = || experiment.loads.iter().filter(|load| matches!(load.force, Force::Weight { .. }));
    let has_gravity = !hovers().any(|load| {
        matches!(load.force, Force::Weight { gravity_std_m_s2, .. } if gravity_std_m_s2 >= Gravity::UNKNOWN.std_m_s2)
    });
    let loads = experiment.loads.len();
    let is_repeated = experiment.loads.iter().any(|load| load.recordings.len() > 1);
    let few = format!(
        "{} are only a weak test of the law F = C_f ω²: {LOADS_WANTED} loads or more are better",
        counted(loads, "load")
    );
    let by = |flags: &'static str, keys: &'static str| if is_typed { flags } else { keys };
    [
        (
            experiment.propeller_diameter_m.is_some(),
            match experiment.config.known.shaft_speed {
                Some(_) => {
                    "the diameter of the propellers is not given: the thrust coefficient C_T needs it and is \
                     left out; the thrust constant C_f does not need it"
                }
                None => {
                    "the diameter of the propellers is not given: with the diameter, hovertone can rule out half \
                     and double the true speed; C_T needs it too"
                }
            },
            by("measure it from tip to tip, and give --diameter-m", "write propeller_diameter_m under [vehicle]"),
        ),
        (
            has_gravity,
            "the place of the flight is not given, and gravity differs by up to 0.5 % between places on Earth: so the ± is larger",
            by("give --latitude-deg", "write latitude_deg and height_m (the height above sea level) under [vehicle]"),
        ),
        (
            experiment.air.is_some(),
            "the density of the air is not given: the thrust coefficient C_T needs it and is left out; the thrust \
             constant C_f does not need it",
            by(
                "give --height-m and --latitude-deg",
                "write [air] with temperature_c and pressure_hpa into the experiment file",
            ),
        ),
        // with one recording each, a warning says that the law cannot be tested at all
        (
            loads == 1 || loads >= LOADS_WANTED || !is_repeated,
            few.as_str(),
            "add a heavier load: the ± becomes smaller too",
        ),
    ]
    .into_iter()
    .filter(|(is_there, ..)| !is_there)
    .map(|(_, what, hint)| Notice::new(what, hint))
    .collect()
}

fn verdict(faults: usize, warnings: usize, output: Option<&Path>) -> String {
    let first = if warnings > 0 { "See to the warnings above, then run" } else { "Now run" };
    match (faults, output) {
        (0, Some(folder)) => format!(
            "ready: all files are there. {first} the same command without --check; it writes the results into {}\n",
            folder.display()
        ),
        (0, None) => {
            format!(
                "ready: all files are there. {first} the same command without --check, and add -o DIR for the report\n"
            )
        }
        (faults, _) => format!("not ready: {}\n", counted(faults, "error")),
    }
}
