//! `hovertone batch-compare`: which rotors have changed between two archives.

use super::CONDITION;
use super::folder::IDENTITY;
use super::tables::RECORDINGS;
use crate::args::BatchCompareArguments;
use crate::failure::{Ending, Failure};
use crate::terminal::Terminal;
use hovertone_archive::{Archives, BatchIdentity, Summary, drift_json, drift_of, drift_text, summaries_of_parquet};
use hovertone_report::{Notice, printable, shared_folder};
use std::fs::{self, File};
use std::io;
use std::path::Path;

/// What to give in place of a folder without results.
const GIVE_TWO: &str =
    "run `hovertone batch ARCHIVE -o OUT` for each of the two archives, then give the two OUT folders";
/// What writes the table of a folder, where its recordings are heard already.
const RUN_AGAIN: &str =
    "run the same `hovertone batch` command again: it hears only the other recordings, and writes the table";

/// Compares two folders of results.
pub(crate) fn run(arguments: &BatchCompareArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    refuse_same(&arguments.earlier, &arguments.later)?;
    let (earlier, later) = (Results::read(&arguments.earlier)?, Results::read(&arguments.later)?);
    if let Some(notice) = earlier.other_settings(&later, [&arguments.earlier, &arguments.later]) {
        terminal.warning(&notice, "");
    }
    let drift = drift_of(Archives { earlier: &earlier.summaries, later: &later.summaries });
    if arguments.json {
        terminal.data(&(drift_json(&drift) + "\n"))?;
    } else if !drift.rotors.is_empty() {
        terminal.text(&drift_text(&drift, terminal.fold_width()))?;
    }
    if drift.rotors.is_empty() {
        let notice = Notice::new(
            "the two archives cannot be compared: no recording of the same name has a speed in both folders, and to \
             compare the means, each folder needs two recordings with a speed",
            "open overview.html in both folders: it shows which recordings have no speed",
        );
        terminal.warning(&notice, "");
        return Ok(Ending::Incomplete);
    }
    Ok(Ending::Done)
}

/// Refuses a folder that is compared with itself.
fn refuse_same(earlier: &Path, later: &Path) -> Result<(), Failure> {
    match (earlier.canonicalize(), later.canonicalize()) {
        (Ok(one), Ok(other)) if one == other => {
            let what = format!(
                "{} is given twice: a folder does not differ from itself",
                printable(&later.display().to_string())
            );
            Err(Failure::usage(what, "give the folder of the earlier batch, and that of the later one"))
        }
        _ => Ok(()),
    }
}

/// The results of a batch, with names of recordings below the folder that was heard.
struct Results {
    identity: BatchIdentity,
    summaries: Vec<Summary>,
}

impl Results {
    fn read(folder: &Path) -> Result<Self, Failure> {
        let is_none = |what: &str| Failure::failed(what, GIVE_TWO, folder);
        let text = fs::read_to_string(folder.join(IDENTITY)).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound if !folder.exists() => is_none("there is no such folder"),
            _ => is_none("`hovertone batch` did not write this folder"),
        })?;
        let identity: BatchIdentity = serde_json::from_str(&text).map_err(|_| {
            let what = "batch.json in this folder, the list of its recordings and settings, is damaged";
            Failure::failed(what, "run `hovertone batch` for this folder again, with --force", folder)
        })?;
        let place = folder.join(RECORDINGS);
        let file = File::open(&place).map_err(|_| {
            let what = "the table recordings.parquet is missing in this folder, so its batch has not ended";
            Failure::failed(what, RUN_AGAIN, folder)
        })?;
        let read = summaries_of_parquet(file);
        let mut summaries = read.map_err(|error| {
            Failure::failed(format!("this file is not a table of recordings: {error}"), RUN_AGAIN, &place)
        })?;
        name_below_inputs(&mut summaries, &identity.inputs);
        Ok(Self { identity, summaries })
    }

    /// The warning that the recordings were heard in another way.
    fn other_settings(&self, later: &Self, folders: [&Path; 2]) -> Option<Notice> {
        let mut there = BatchIdentity {
            inputs: later.identity.inputs.clone(),
            list_from_stdin: later.identity.list_from_stdin.clone(),
            ..self.identity.clone()
        };
        // the condition is told beside the speed, and changes nothing in it
        if let (Some(own), Some(other)) = (there.settings.get_mut(CONDITION), later.identity.settings.get(CONDITION)) {
            other.clone_into(own);
        }
        let places = folders.map(|folder| format!("in {}", printable(&folder.to_string_lossy())));
        let shown = there.differences(&later.identity, places.each_ref().map(String::as_str))?;
        let text = format!(
            "the two archives were heard with different settings ({shown}): the settings alone may explain a change"
        );
        Some(Notice::new(text, "run `hovertone batch` for both archives with the same settings"))
    }
}

/// Names each recording below the folder that was typed; below the folder that all share where the typed names are no folders above it.
fn name_below_inputs(summaries: &mut [Summary], inputs: &[String]) {
    let files: Vec<String> = summaries.iter().map(|summary| summary.file.clone()).collect();
    let shared = shared_folder(&files.iter().map(String::as_str).collect::<Vec<_>>()).to_owned();
    for summary in summaries {
        let of_input = |input: &String| Path::new(&summary.file).strip_prefix(input).ok();
        let below = inputs.iter().find_map(of_input).filter(|below| !below.as_os_str().is_empty());
        summary.file = match below {
            Some(below) => below.to_string_lossy().into_owned(),
            None => summary.file.strip_prefix(&shared).unwrap_or(&summary.file).to_owned(),
        };
    }
}
