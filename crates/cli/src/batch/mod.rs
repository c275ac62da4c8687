//! `hovertone batch`: the speeds of an archive of recordings as Parquet, resumable.

pub(crate) mod called;
pub(crate) mod compare;
mod counts;
mod folder;
mod hearing;
mod inputs;
mod overview;
mod tables;

use crate::args::BatchArguments;
use crate::failure::{Ending, Failure};
use crate::outputs::Outputs;
use crate::recording::{Hearing, Requests};
use crate::settings::{config_of, idle_mass};
use crate::terminal::Terminal;
use counts::Counts;
use folder::{BatchFolder, identity_in};
use hearing::{Manner, hear_missing};
use hovertone_archive::{BatchIdentity, FORMAT, Plan, Shard};
use hovertone_report::{Notice, VERSION, counted, printable};
use inputs::{Names, Recordings, recordings_of, spelled_as_before};
use serde_json::json;
use tables::write_tables;

/// Key of the wish for a condition among the settings.
const CONDITION: &str = "condition";

/// Hears what is missing, and writes the tables where nothing is missing any more.
pub(crate) fn run(arguments: &BatchArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    if arguments.replace.force && arguments.shard.is_some() {
        let what = "--force cannot be used with --shard: it would remove the results of the other jobs";
        return Err(Failure::usage(
            what,
            "leave --force out; to start again, remove the folder before the first job starts",
        ));
    }
    let (config, discovery) = config_of(&arguments.tone, &arguments.known, &arguments.analysis)?;
    if let Some(notice) = idle_mass(&arguments.known, &config.known) {
        terminal.tip(&notice);
    }
    let requests = requests_of(arguments);
    let hearing = Hearing { wants_thumbnail: true, ..hearing_of(arguments) };
    let before = identity_in(&arguments.output).filter(|_| !arguments.replace.force);
    let typed = before.map_or_else(|| arguments.inputs.clone(), |before| spelled_as_before(&arguments.inputs, &before));
    let Recordings { found: recordings, list_from_stdin } = recordings_of(&typed)?;
    let identity = BatchIdentity {
        format: FORMAT,
        version: VERSION.to_owned(),
        inputs: typed.iter().map(|input| input.to_string_lossy().into_owned()).collect(),
        list_from_stdin,
        settings: json!({
            "analysis": config,
            "search": discovery,
            "audio_track": hearing.audio_track,
            "channel": hearing.channel,
            "clock_correction_ppm": hearing.clock_correction_ppm,
            CONDITION: requests.condition,
        }),
    };
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    let outputs = Outputs::beside(&recordings, arguments.replace.force);
    let folder = BatchFolder::open(&arguments.output, outputs, &identity, shard)?;
    let names = Names::of(&recordings)?;
    let plan = names.plan();
    let manner = Manner {
        names,
        config,
        discovery,
        requests,
        hearing,
        shard,
        threads: arguments.threads,
        retries: arguments.retry,
        wants_progress: !arguments.hearing.no_progress,
    };
    let of_run = hear_missing(&plan, &folder, &manner)?;
    let written = write_tables(&plan, &folder, &identity)?;
    if written.is_some() && shard.is_whole() {
        folder.remove_other_parts(&plan)?;
    }
    written.iter().flat_map(|written| &written.failed).for_each(|failed| terminal.error(failed));
    if written.as_ref().is_some_and(|written| !written.failed.is_empty()) {
        terminal.tip(&Notice::new(
            "the next run skips each recording that failed, unless its file has changed",
            "to hear such recordings again in any case, run the same command with --retry",
        ));
    }
    let overview = folder.place(tables::OVERVIEW);
    if let Some(notice) = written.as_ref().and_then(|written| written.notice_of_unsure(&overview)) {
        terminal.warning(&notice, "");
    }
    let counts = written.map(|written| written.counts);
    say(&Said { heard: of_run, all: counts.as_ref(), plan: &plan, shard, folder: &folder }, arguments.json, terminal)?;
    Ok(if counts.unwrap_or(of_run).is_complete() { Ending::Done } else { Ending::Incomplete })
}

fn requests_of(arguments: &BatchArguments) -> Requests {
    Requests { condition: arguments.analysis.condition, spin_up: false }
}

fn hearing_of(arguments: &BatchArguments) -> Hearing {
    Hearing { wants_hash: true, ..Hearing::of(&arguments.hearing) }
}

/// What a run has to say at its end.
struct Said<'a> {
    /// The recordings that this run heard.
    heard: Counts,
    /// All recordings of the tables; absent where other jobs still hear.
    all: Option<&'a Counts>,
    plan: &'a Plan,
    shard: Shard,
    folder: &'a BatchFolder,
}

fn say(said: &Said<'_>, wants_json: bool, terminal: &mut Terminal) -> Result<(), Failure> {
    let recording_count = said.plan.recordings().len();
    if wants_json {
        let line = json!({
            "recording_count": recording_count,
            "heard_count": said.heard.total(),
            "is_complete": said.all.is_some(),
            "counts": said.all,
            "version": VERSION,
        });
        return terminal.data(&format!("{line}\n"));
    }
    let place = |name: &str| printable(&said.folder.place(name).display().to_string());
    let text = match said.all {
        Some(counts) => format!(
            "{}: {counts}\nanalysed in this run: {}{}\ntables: {}, {}\npage: {}{}\n",
            counted(recording_count, "recording"),
            counted(said.heard.total(), "recording"),
            match recording_count.saturating_sub(said.heard.total()) {
                0 => String::new(),
                others => format!("; an earlier run analysed the other {others}"),
            },
            place(tables::RECORDINGS),
            place(tables::TRACKS),
            place(tables::OVERVIEW),
            if counts.with_warnings > 0 { ", with the warnings of each recording" } else { "" }
        ),
        None => format!(
            "job {} has ended; it heard {}: {}\nthe job that ends last writes the tables\n",
            said.shard,
            counted(said.heard.total(), "recording"),
            said.heard
        ),
    };
    terminal.text(&text)
}
