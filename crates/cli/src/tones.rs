//! `hovertone tones`: the tone families of recordings and their possible meanings.

use crate::args::TonesArguments;
use crate::failure::{Ending, Failure};
use crate::jobs::{ending_of, jobs_of};
use crate::progress::Progress;
use crate::recording::{Hearing, Requests, records_of};
use crate::settings::{discovery_of, span_of};
use crate::terminal::Terminal;
use hovertone::speed::Config;
use hovertone_report::{tones_json, tones_text};

/// Analyses all files and prints their families of tones.
pub(crate) fn run(arguments: &TonesArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let (tone, discovery) = discovery_of(&arguments.known, arguments.vehicle.as_deref(), true)?;
    let mut config = Config::for_tone(tone);
    config.span = span_of(arguments.from, arguments.to)?;
    config.check()?;
    let jobs = jobs_of(&arguments.files, &config, Some(discovery), Requests::default())?;
    let hearing = Hearing { wants_hash: arguments.json, ..Hearing::of(&arguments.hearing) };
    let progress = Progress::new("listening to", jobs.len(), !arguments.hearing.no_progress);
    let records = records_of(&jobs, hearing, &progress);
    progress.finish();
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
