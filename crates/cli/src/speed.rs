//! `hovertone speed`: rotor speeds of recordings.

use crate::args::SpeedArguments;
use crate::failure::{Ending, Failure};
use crate::jobs::{ending_of, jobs_of};
use crate::labels::{LabelPlan, label, note_if_ambiguous};
use crate::microphones::{ArrayPlan, label_all};
use crate::outputs::{Outputs, written};
use crate::progress::Progress;
use crate::recording::{HeardJobs, Hearing, Job, Requests, hear_all, in_memory};
use crate::settings::{check_tips_heard, check_tips_ruled_out, config_of, idle_mass};
use crate::terminal::Terminal;
use crate::text_file::{TextFormat, TextKind};
use crate::vehicles::preset;
use hovertone::speed::RotorsConfig;
use hovertone_media::Samples;
use hovertone_report::{Notice, SpeedRecord, condition_table, speed_json, speed_table, track_csv};
use std::path::PathBuf;

/// What the columns of the table mean.
const FOOTNOTE: &str = "±: about 95 of 100 true values lie within it; it includes the noise and the clock of the recorder and, where a warning says that rotors could not be separated, the difference between their speeds; spread: standard deviation of the speed over time\n";

const TRACK: TextKind = TextKind { content: "a track", format: TextFormat::Csv, example: "--track track.csv" };

/// The meaning of the arguments.
struct Plan {
    jobs: Vec<Job>,
    hearing: Hearing,
    track: Option<PathBuf>,
    outputs: Outputs,
    labels: Option<LabelPlan>,
    microphones: Option<ArrayPlan>,
}

/// Analyses all files and prints their speeds.
pub(crate) fn run(arguments: &SpeedArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let plan = resolve(arguments)?;
    say_idle_mass(&plan, arguments, terminal);
    let records = hear(&plan, arguments)?;
    terminal.counted_notes(&records.iter().collect::<Vec<_>>());
    if arguments.json {
        for record in &records {
            terminal.data(&(speed_json(record).map_err(Failure::internal)? + "\n"))?;
        }
    } else {
        terminal.text(&speed_table(&records, terminal.fold_width()))?;
        if records.iter().any(|record| record.speed().is_some()) {
            terminal.text(FOOTNOTE)?;
        }
        if let Some(table) = condition_table(&records, terminal.fold_width()) {
            terminal.text(&format!("\n{table}"))?;
        }
    }
    terminal.flush()?;
    say_assumed_number(arguments, &records, terminal);
    if let Some(path) = plan.track {
        let track = track_csv(&records).map_err(Failure::internal)?;
        // a header alone is no track
        if track.lines().nth(1).is_some() {
            plan.outputs.write(&path, track)?;
            terminal.say(&written(&path));
        } else {
            terminal.say("--track wrote no file, because no recording has a speed");
        }
    }
    Ok(ending_of(&records))
}

fn say_idle_mass(plan: &Plan, arguments: &SpeedArguments, terminal: &mut Terminal) {
    let known = plan.jobs.first().map(|job| job.config.known);
    if let Some(notice) = known.and_then(|known| idle_mass(&arguments.known, &known)) {
        terminal.tip(&notice);
    }
}

/// Says that nobody told the number of the rotors that were separated. A warning says so where not all could be.
fn say_assumed_number(arguments: &SpeedArguments, records: &[SpeedRecord], terminal: &mut Terminal) {
    let is_said = arguments.known.rotors.is_some() || arguments.tone.vehicle.is_some();
    let counts: Vec<usize> = records.iter().map(|record| record.rotors().len()).collect();
    let count = counts.iter().copied().max().unwrap_or_default();
    let several = counts.iter().filter(|rotors| **rotors >= RotorsConfig::SEVERAL as usize).count();
    let place = match several {
        all if all == records.len() => String::new(),
        some => format!("in {some} of the recordings, "),
    };
    if !is_said && !arguments.json && count >= RotorsConfig::SEVERAL as usize {
        let up_to = if counts.iter().all(|rotors| *rotors == count) { "" } else { "up to " };
        let what = format!("{place}hovertone found {up_to}{count} rotors by itself, because their number is not given");
        let hint = format!(
            "if your vehicle has {count} rotors, you need to do nothing; if not, give their number, as in --rotors 6, and --rotors 1 \
             where one runs alone"
        );
        terminal.tip(&Notice::new(what, hint));
    }
}

/// The recordings with their answers, for a program that calls. The first recording may be in memory.
pub(crate) fn called(arguments: &SpeedArguments, samples: Option<Samples>) -> Result<HeardJobs, Failure> {
    let mut plan = resolve(arguments)?;
    if samples.is_some() && plan.microphones.is_some() {
        return Err(Failure::usage(
            "--microphones needs a file, but the sound is an array in memory",
            "write the array into an audio file, and give the file",
        ));
    }
    in_memory(&mut plan.jobs, samples);
    let records = hear(&plan, arguments)?;
    Ok(HeardJobs { jobs: plan.jobs, records, hearing: plan.hearing })
}

/// Analyses all files.
fn hear(plan: &Plan, arguments: &SpeedArguments) -> Result<Vec<SpeedRecord>, Failure> {
    let progress = Progress::new("listening to", plan.jobs.len(), !arguments.hearing.no_progress);
    let mut heard = hear_all(&plan.jobs, plan.hearing, &progress);
    progress.finish();
    if plan.labels.is_some() || plan.microphones.is_some() {
        heard.iter_mut().for_each(|heard| note_if_ambiguous(&mut heard.record));
    }
    if let Some(labels) = &plan.labels {
        heard.iter_mut().for_each(|heard| label(heard, labels));
    }
    if let Some(array) = &plan.microphones {
        label_all(&mut heard, &plan.jobs, array, !arguments.hearing.no_progress);
    }
    let records: Vec<SpeedRecord> = heard.into_iter().map(|heard| heard.record).collect();
    check_tips_heard(&arguments.known, &records)?;
    check_tips_ruled_out(&arguments.known, arguments.tone.blades, &records)?;
    Ok(records)
}

fn resolve(arguments: &SpeedArguments) -> Result<Plan, Failure> {
    let (config, discovery) = config_of(&arguments.tone, &arguments.known, &arguments.analysis)?;
    let requests = Requests { condition: arguments.analysis.condition, spin_up: arguments.labels.spin_up.is_some() };
    let jobs = jobs_of(&arguments.files, &config, discovery, requests)?;
    let hearing = Hearing { wants_hash: arguments.json, ..Hearing::of(&arguments.hearing) };
    let vehicle = arguments.tone.vehicle.as_deref().map(preset).transpose()?;
    let labels = crate::labels::resolve(&arguments.labels, vehicle, jobs.len(), config.rotors.count)?;
    let microphones = crate::microphones::resolve(&arguments.labels, vehicle, &jobs, hearing, config.rotors.count)?;
    let of_flight = [&arguments.labels.log, &arguments.labels.microphones].into_iter().flatten();
    let inputs = jobs.iter().map(|job| &job.path).chain(of_flight);
    let outputs = Outputs::beside(inputs, arguments.replace.force);
    let track = arguments.track.clone();
    track.as_deref().map_or(Ok(()), |track| outputs.check_text(track, TRACK))?;
    Ok(Plan { jobs, hearing, track, outputs, labels, microphones })
}
