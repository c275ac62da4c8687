//! `hovertone tones`: the tone families of recordings and their possible meanings.

use crate::args::TonesArguments;
use crate::failure::{Ending, Failure};
use crate::jobs::{ending_of, jobs_of};
use crate::progress::Progress;
use crate::recording::{HeardJobs, Hearing, Job, Requests, in_memory, opened, records_of};
use crate::settings::{check_tips_ruled_out, idle_mass, search_of, span_of};
use crate::terminal::Terminal;
use hovertone::speed::Config;
use hovertone_media::{Recording, Samples};
use hovertone_report::{SpeedRecord, tones_json, tones_text};
use hovertone_workflow::set_rotors;

/// Analyses all files and prints their families of tones.
pub(crate) fn run(arguments: &TonesArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let plan = resolve(arguments)?;
    let known = plan.jobs.first().and_then(|job| Some(job.discovery.as_ref()?.known));
    if let Some(notice) = known.and_then(|known| idle_mass(&arguments.known, &known)) {
        terminal.tip(&notice);
    }
    let records = hear(&plan, arguments)?;
    terminal.counted_notes(&records.iter().collect::<Vec<_>>());
    if arguments.json {
        for record in &records {
            terminal.data(&(tones_json(record).map_err(Failure::internal)? + "\n"))?;
        }
    } else {
        let blocks: Vec<String> = records.iter().map(|record| tones_text(record, terminal.fold_width())).collect();
        terminal.text(&blocks.join("\n"))?;
    }
    terminal.flush()?;
    Ok(ending_of(&records))
}

/// The recordings with their families of tones, for a program that calls. The first recording may be in memory.
pub(crate) fn called(arguments: &TonesArguments, samples: Option<Samples>) -> Result<HeardJobs, Failure> {
    let mut plan = resolve(arguments)?;
    in_memory(&mut plan.jobs, samples);
    let records = hear(&plan, arguments)?;
    Ok(HeardJobs { jobs: plan.jobs, records, hearing: plan.hearing })
}

/// The first recording, open, for a program that calls.
pub(crate) fn first_recording(arguments: &TonesArguments) -> Result<Recording, Failure> {
    let plan = resolve(arguments)?;
    let Some(job) = plan.jobs.first() else { return Err(Failure::internal("there is no recording")) };
    opened(job, plan.hearing)
}

/// The meaning of the arguments.
struct Plan {
    jobs: Vec<Job>,
    hearing: Hearing,
}

fn resolve(arguments: &TonesArguments) -> Result<Plan, Failure> {
    let (tone, discovery) = search_of(arguments)?;
    let mut config = Config::for_tone(tone);
    config.span = span_of(arguments.from, arguments.to)?;
    config.method = set_rotors(&mut config, discovery.known.rotor_count, false);
    config.check()?;
    let jobs = jobs_of(&arguments.files, &config, Some(discovery), Requests::default())?;
    Ok(Plan { jobs, hearing: Hearing { wants_hash: arguments.json, ..Hearing::of(&arguments.hearing) } })
}

fn hear(plan: &Plan, arguments: &TonesArguments) -> Result<Vec<SpeedRecord>, Failure> {
    let progress = Progress::new("listening to", plan.jobs.len(), !arguments.hearing.no_progress);
    let records = records_of(&plan.jobs, plan.hearing, &progress);
    progress.finish();
    check_tips_ruled_out(&arguments.known, arguments.blades, &records)?;
    Ok(records)
}
