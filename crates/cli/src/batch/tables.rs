//! The tables of a batch, from the parts of all recordings in the order of their names.

use super::counts::{Counted, Counts};
use super::folder::BatchFolder;
use super::overview::Overview;
use crate::failure::Failure;
use crate::output_file::{OutputFile, remove_written};
use hovertone_archive::{ArchiveError, BatchIdentity, Part, Plan, RecordingsTable, TracksTable};
use hovertone_report::{Notice, counted};
use hovertone_vehicle::in_list;
use serde_json::Value;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// The table of the recordings.
pub(crate) const RECORDINGS: &str = "recordings.parquet";
/// Folder of the tables of tracks.
pub(crate) const TRACKS: &str = "tracks";
/// The page that a person opens.
pub(crate) const OVERVIEW: &str = "overview.html";
/// First letters of the name of a table of tracks.
const TRACKS_BEGIN: &str = "part-";

/// Most recordings that are named where they could not be heard; the table and the page name all.
const FAILED_NAMED_MAX: usize = 10;

/// Most recordings that are named where they have no sure speed.
const UNSURE_NAMED_MAX: usize = 5;

/// What the tables hold.
pub(crate) struct Written {
    pub(crate) counts: Counts,
    /// The first recordings that could not be heard, with the reasons.
    pub(crate) failed: Vec<Notice>,
    /// The names of the first recordings that were heard, and have no sure speed.
    unsure: Vec<String>,
}

impl Written {
    /// Which recordings have no sure speed, and what to do; `None` where all have one.
    pub(crate) fn notice_of_unsure(&self, overview: &Path) -> Option<Notice> {
        let count = self.counts.unsure();
        let has = if count == 1 { "has" } else { "have" };
        let more = if count > self.unsure.len() { ", …" } else { "" };
        let Counts { ambiguous, no_rotor_tone, doubtful, .. } = self.counts;
        let kinds = [
            (no_rotor_tone, "no speed"),
            (ambiguous, "several possible speeds"),
            (doubtful, "a speed that contradicts the given facts"),
        ];
        let kinds: Vec<&str> = kinds.into_iter().filter(|(count, _)| *count > 0).map(|(_, kind)| kind).collect();
        let text = format!(
            "{} {has} {}: {}{more}",
            counted(count, "recording"),
            in_list(&kinds, "or"),
            self.unsure.join(", ")
        );
        let these = if count == 1 { "this recording" } else { "one of these recordings" };
        let hint = format!(
            "run `hovertone speed` with {these} and the same flags: it says why, and what to do; {} shows all recordings",
            overview.display()
        );
        (count > 0).then(|| Notice::new(text, hint))
    }
}

/// Writes the tables and the page; `None` where recordings are missing, which other jobs hear.
pub(crate) fn write_tables(
    plan: &Plan,
    folder: &BatchFolder,
    identity: &BatchIdentity,
) -> Result<Option<Written>, Failure> {
    if !plan.recordings().iter().all(|recording| folder.has(recording)) {
        return Ok(None);
    }
    let _alone = folder.alone()?;
    let mut recordings = Begun::new(folder, RECORDINGS, |into| RecordingsTable::begin(into, &identity.settings))?;
    let mut tracks = Tracks { folder, settings: &identity.settings, current: None, count: 0 };
    let (mut counts, mut failed, mut overview) = (Counts::default(), Vec::new(), Overview::new(identity));
    let mut unsure = Vec::new();
    for recording in plan.recordings() {
        let part = folder.part(recording)?;
        let summary = part.summary().map_err(Failure::internal)?;
        let heard = Counted::from(&summary);
        counts.add(heard);
        if summary.status == Counts::ERROR && failed.len() < FAILED_NAMED_MAX {
            failed
                .push(Notice::new(format!("{}: {}", summary.file, summary.reason.as_deref().unwrap_or_default()), ""));
        }
        if heard.is_unsure() && unsure.len() < UNSURE_NAMED_MAX {
            unsure.push(summary.file.clone());
        }
        recordings.table.push(&part).map_err(|error| cannot_write(error, &recordings.output))?;
        tracks.push(&part)?;
        overview.add(summary, part.picture);
    }
    tracks.end()?;
    folder.write(OVERVIEW, &overview.html()?)?;
    recordings.end(RecordingsTable::finish)?;
    Ok(Some(Written { counts, failed, unsure }))
}

/// Whether a file in the folder of the tracks was written by a batch.
pub(crate) fn is_of_tracks(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    name.starts_with(TRACKS_BEGIN) && name.ends_with(".parquet")
}

/// A table and the file into which it is written.
struct Begun<Table> {
    table: Table,
    output: OutputFile,
}

impl<Table> Begun<Table> {
    fn new(
        folder: &BatchFolder,
        name: &str,
        begin: impl FnOnce(BufWriter<File>) -> Result<Table, ArchiveError>,
    ) -> Result<Self, Failure> {
        let output = folder.create(name)?;
        let table = begin(BufWriter::new(output.handle()?)).map_err(|error| cannot_write(error, &output))?;
        Ok(Self { table, output })
    }

    fn end(self, finish: impl FnOnce(Table) -> Result<BufWriter<File>, ArchiveError>) -> Result<(), Failure> {
        let Self { table, output } = self;
        let writer = finish(table).map_err(|error| cannot_write(error, &output))?;
        writer.into_inner().map_err(|error| Failure::cannot_write(error.error(), output.place()))?;
        output.keep()
    }
}

/// The tables of tracks, one after the other.
struct Tracks<'a> {
    folder: &'a BatchFolder,
    settings: &'a Value,
    current: Option<Begun<TracksTable<BufWriter<File>>>>,
    count: usize,
}

impl Tracks<'_> {
    fn push(&mut self, part: &Part) -> Result<(), Failure> {
        let begun = match self.current.take() {
            Some(begun) if !begun.table.is_full() => begun,
            full => {
                full.map_or(Ok(()), |full| full.end(TracksTable::finish))?;
                self.next()?
            }
        };
        let begun = self.current.insert(begun);
        begun.table.push(part).map_err(|error| cannot_write(error, &begun.output))
    }

    fn next(&mut self) -> Result<Begun<TracksTable<BufWriter<File>>>, Failure> {
        let name = format!("{TRACKS}/{TRACKS_BEGIN}{:05}.parquet", self.count);
        self.count += 1;
        Begun::new(self.folder, &name, |into| TracksTable::begin(into, self.settings))
    }

    /// Ends the last table, and removes those of an earlier run with more recordings.
    fn end(mut self) -> Result<(), Failure> {
        self.current.take().map_or(Ok(()), |last| last.end(TracksTable::finish))?;
        let mut number = self.count;
        loop {
            let place = self.folder.place(&format!("{TRACKS}/{TRACKS_BEGIN}{number:05}.parquet"));
            if !remove_written(&place)? {
                return Ok(());
            }
            number += 1;
        }
    }
}

fn cannot_write(error: ArchiveError, output: &OutputFile) -> Failure {
    Failure::failed(format!("this table cannot be written: {error}"), "check the disk", output.place())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_recordings_without_a_sure_speed_are_named() {
        let of_status =
            |status: &'static str| Counted { status, is_prefix: false, is_doubtful: false, has_warnings: false };
        let notice = |count: usize| {
            let mut written = Written { counts: Counts::default(), failed: Vec::new(), unsure: Vec::new() };
            for number in 0..count {
                written.counts.add(of_status(["ambiguous", "no_rotor_tone"][number % 2]));
                written.unsure.push(format!("{number}.wav"));
            }
            written.unsure.truncate(UNSURE_NAMED_MAX);
            written.notice_of_unsure(Path::new("out/overview.html"))
        };
        assert_eq!(notice(0), None);
        assert_eq!(
            notice(1).map(|notice| notice.text),
            Some("1 recording has several possible speeds: 0.wav".to_owned())
        );
        let seven = "7 recordings have no speed or several possible speeds: 0.wav, 1.wav, 2.wav, 3.wav, 4.wav, …";
        let said = notice(7).map(|notice| (notice.text, notice.hint));
        assert!(
            said.as_ref().is_some_and(|(text, hint)| text == seven && hint.contains("out/overview.html")),
            "{said:?}"
        );
        assert!(
            !["ok", Counts::ERROR].into_iter().map(of_status).any(Counted::is_unsure)
                && of_status("ambiguous").is_unsure()
                && Counted { is_doubtful: true, ..of_status("ok") }.is_unsure()
        );
    }
}
