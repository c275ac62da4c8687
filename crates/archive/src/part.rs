//! A finished recording as bytes: its row, its track and its picture. The bytes of a part are exact copies of the rows of the tables.

use crate::error::ArchiveError;
use crate::row::{ArchiveRow, recordings_batch};
use crate::track::tracks_batch;
use arrow_array::RecordBatch;
use arrow_ipc::reader::StreamReader;
use arrow_ipc::writer::StreamWriter;
use arrow_schema::Schema;
use std::io::{Cursor, Read};
use std::sync::Arc;

/// Key of the picture in the metadata of the row.
const PICTURE_KEY: &str = "picture";

/// The mark of the end of a stream of Arrow IPC.
const END: [u8; 8] = [0xff, 0xff, 0xff, 0xff, 0, 0, 0, 0];

/// A finished recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    pub(crate) row: RecordBatch,
    pub(crate) tracks: RecordBatch,
    /// A small spectrogram as the URI of a PNG, where the recording could be read.
    pub picture: Option<String>,
}

impl Part {
    /// The part of a recording.
    ///
    /// # Errors
    /// None is known: the columns of a row have one value each.
    pub fn new(row: &ArchiveRow, picture: Option<String>) -> Result<Self, ArchiveError> {
        let tracks = tracks_batch(Some(&row.record))?;
        Ok(Self { row: recordings_batch(std::slice::from_ref(row))?, tracks, picture })
    }

    /// The bytes: two streams of Arrow IPC, first the row and then the track.
    ///
    /// # Errors
    /// None is known, since the bytes are written to memory.
    pub fn to_bytes(&self) -> Result<Vec<u8>, ArchiveError> {
        let schema = self.row.schema().as_ref().clone();
        let picture = self.picture.iter().map(|picture| (PICTURE_KEY, picture.as_str()));
        let row = RecordBatch::try_new(
            Arc::new(Schema::new_with_metadata(schema.fields, picture.collect::<arrow_schema::Metadata>())),
            self.row.columns().to_vec(),
        )?;
        Ok([stream_of(&row)?, stream_of(&self.tracks)?].concat())
    }

    /// The row of `recordings.parquet` as a stream of Arrow IPC, for engines that write tables of their own.
    ///
    /// # Errors
    /// None is known, since the bytes are written to memory.
    pub fn row_stream(&self) -> Result<Vec<u8>, ArchiveError> {
        stream_of(&self.row)
    }

    /// From its bytes.
    ///
    /// # Errors
    /// Bytes that are no whole part, or a part with other columns.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ArchiveError> {
        // the reader takes the end of the bytes for the end of a stream
        if !bytes.ends_with(&END) {
            return Err(ArchiveError::NoPart);
        }
        let mut from = Cursor::new(bytes);
        let row = batch_of(&mut from)?;
        let tracks = batch_of(&mut from)?;
        let picture = row.schema_ref().metadata().get(PICTURE_KEY).cloned();
        let row = RecordBatch::try_new(recordings_batch(&[])?.schema(), row.columns().to_vec())?;
        if row.num_rows() != 1 || tracks.schema() != tracks_batch(None)?.schema() {
            return Err(ArchiveError::NoPart);
        }
        Ok(Self { row, tracks, picture })
    }
}

fn stream_of(batch: &RecordBatch) -> Result<Vec<u8>, ArchiveError> {
    let mut writer = StreamWriter::try_new(Vec::new(), &batch.schema())?;
    writer.write(batch)?;
    Ok(writer.into_inner()?)
}

fn batch_of(from: &mut impl Read) -> Result<RecordBatch, ArchiveError> {
    let mut stream = StreamReader::try_new(&mut *from, None)?;
    let batch = stream.next().ok_or(ArchiveError::NoPart)??;
    match stream.next() {
        None => Ok(batch),
        Some(_) => Err(ArchiveError::NoPart),
    }
}
