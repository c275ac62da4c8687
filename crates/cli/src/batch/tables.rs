//! The tables of a batch, from the parts of all recordings in the order of their names.

use super::counts::Counts;
use super::folder::BatchFolder;
use super::overview::Overview;
use crate::failure::Failure;
use crate::output_file::{OutputFile, remove_written};
use hovertone_archive::{ArchiveError, BatchIdentity, Part, Plan, RecordingsTable, TracksTable};
use hovertone_report::Notice;
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

/// What the tables hold.
pub(crate) struct Written {
    pub(crate) counts: Counts,
    /// The first recordings that could not be heard, with the reasons.
    pub(crate) failed: Vec<Notice>,
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
    for recording in plan.recordings() {
        let part = folder.part(recording)?;
        let summary = part.summary().map_err(Failure::internal)?;
        counts.add(&summary.status, summary.is_prefix);
        if summary.status == Counts::ERROR && failed.len() < FAILED_NAMED_MAX {
            failed
                .push(Notice::new(format!("{}: {}", summary.file, summary.reason.as_deref().unwrap_or_default()), ""));
        }
        recordings.table.push(&part).map_err(|error| cannot_write(error, &recordings.output))?;
        tracks.push(&part)?;
        overview.add(summary, part.picture);
    }
    tracks.end()?;
    folder.write(OVERVIEW, &overview.html()?)?;
    recordings.end(RecordingsTable::finish)?;
    Ok(Some(Written { counts, failed }))
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
