//! Parts in the order of the plan → the tables of the archive as Parquet. Equal parts in equal order give equal bytes.

use crate::error::ArchiveError;
use crate::part::Part;
use crate::row::recordings_batch;
use crate::track::tracks_batch;
use arrow_array::RecordBatch;
use arrow_schema::SchemaRef;
use arrow_select::concat::concat_batches;
use hovertone_report::VERSION;
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use serde_json::Value;
use std::io::Write;

/// Rows that are written together. A row of a recording has about 2 kB.
const RECORDING_ROWS: usize = 512;
/// Points of tracks that are written together. A point has 56 bytes.
const TRACK_ROWS: usize = 65_536;
/// Rows of a group of `recordings.parquet`, which the writer holds in memory.
const RECORDING_GROUP_ROWS: usize = 8192;
/// Points of a group of a file of tracks.
const TRACK_GROUP_ROWS: usize = 262_144;
/// Points after which a file of tracks is full.
pub const TRACK_ROWS_MAX: usize = 4_194_304;
/// Parts that wait to be written together. The columns of one need some 10 kB, whatever its rows.
const WAITING_MAX: usize = 1024;
/// Key of the settings in the metadata of a file.
const SETTINGS_KEY: &str = "hovertone.settings";
/// Key of the version in the metadata of a file.
const VERSION_KEY: &str = "hovertone.version";

/// A table that is being written.
struct Table<W: Write + Send> {
    writer: ArrowWriter<W>,
    schema: SchemaRef,
    waiting: Vec<RecordBatch>,
    waiting_rows: usize,
    /// Rows that are written together.
    together: usize,
    row_count: usize,
}

/// Sizes of the pieces in which a table is written.
#[derive(Clone, Copy)]
struct Pieces {
    together: usize,
    group: usize,
}

impl<W: Write + Send> Table<W> {
    fn new(into: W, schema: SchemaRef, settings: &Value, pieces: Pieces) -> Result<Self, ArchiveError> {
        let facts = [(VERSION_KEY, VERSION.to_owned()), (SETTINGS_KEY, settings.to_string())];
        let facts = facts.into_iter().map(|(key, value)| KeyValue::new(key.to_owned(), value)).collect();
        let properties = WriterProperties::builder()
            .set_created_by(format!("hovertone {VERSION}"))
            .set_compression(Compression::SNAPPY)
            .set_max_row_group_row_count(Some(pieces.group))
            .set_key_value_metadata(Some(facts))
            .build();
        let writer = ArrowWriter::try_new(into, schema.clone(), Some(properties))?;
        Ok(Self { writer, schema, waiting: Vec::new(), waiting_rows: 0, together: pieces.together, row_count: 0 })
    }

    fn push(&mut self, batch: &RecordBatch) -> Result<(), ArchiveError> {
        // a recording without a track would wait for ever
        if batch.num_rows() == 0 {
            return Ok(());
        }
        self.waiting_rows += batch.num_rows();
        self.row_count += batch.num_rows();
        self.waiting.push(batch.clone());
        if self.waiting_rows >= self.together || self.waiting.len() >= WAITING_MAX {
            self.write_waiting()
        } else {
            Ok(())
        }
    }

    fn write_waiting(&mut self) -> Result<(), ArchiveError> {
        let batch = concat_batches(&self.schema, &self.waiting)?;
        self.waiting.clear();
        self.waiting_rows = 0;
        Ok(self.writer.write(&batch)?)
    }

    fn finish(mut self) -> Result<W, ArchiveError> {
        self.write_waiting()?;
        Ok(self.writer.into_inner()?)
    }
}

/// `recordings.parquet`, being written.
pub struct RecordingsTable<W: Write + Send>(Table<W>);

impl<W: Write + Send> RecordingsTable<W> {
    /// Begins the table.
    ///
    /// # Errors
    /// The writer fails.
    pub fn begin(into: W, settings: &Value) -> Result<Self, ArchiveError> {
        let pieces = Pieces { together: RECORDING_ROWS, group: RECORDING_GROUP_ROWS };
        Table::new(into, recordings_batch(&[])?.schema(), settings, pieces).map(Self)
    }

    /// Adds the row of a recording.
    ///
    /// # Errors
    /// The writer fails.
    pub fn push(&mut self, part: &Part) -> Result<(), ArchiveError> {
        self.0.push(&part.row)
    }

    /// Writes the end.
    ///
    /// # Errors
    /// The writer fails.
    pub fn finish(self) -> Result<W, ArchiveError> {
        self.0.finish()
    }
}

/// A file of `tracks/`, being written.
pub struct TracksTable<W: Write + Send>(Table<W>);

impl<W: Write + Send> TracksTable<W> {
    /// Begins a file.
    ///
    /// # Errors
    /// The writer fails.
    pub fn begin(into: W, settings: &Value) -> Result<Self, ArchiveError> {
        let pieces = Pieces { together: TRACK_ROWS, group: TRACK_GROUP_ROWS };
        Table::new(into, tracks_batch(None)?.schema(), settings, pieces).map(Self)
    }

    /// Adds the track of a recording.
    ///
    /// # Errors
    /// The writer fails.
    pub fn push(&mut self, part: &Part) -> Result<(), ArchiveError> {
        self.0.push(&part.tracks)
    }

    /// Whether the next recording goes into another file. The tracks of one recording stay in one file.
    pub fn is_full(&self) -> bool {
        self.0.row_count >= TRACK_ROWS_MAX
    }

    /// Writes the end.
    ///
    /// # Errors
    /// The writer fails.
    pub fn finish(self) -> Result<W, ArchiveError> {
        self.0.finish()
    }
}
