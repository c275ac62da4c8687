//! The answers about an archive of recordings as tables: one row for each recording, and the tracks of all. Pure: the caller reads and writes
//! files, and hears.
//!
//! ```text
//! identity   what a batch is of, and what differs from another     shard    one of several jobs on the same archive
//! plan       the recordings in order, each with the name of its part
//! row        a recording as a row                                   track    its track as rows
//! columns    columns from rows: name, unit, meaning, value          part     row, track and picture of one recording as bytes
//! table      parts in order → Parquet                               summary  rows → what pages and comparisons need
//! drift/     two archives → which speeds have changed
//! ```

mod columns;
mod drift;
mod error;
mod identity;
mod part;
mod plan;
mod row;
mod shard;
mod summary;
mod table;
mod track;

pub use columns::{MEANING_KEY, UNIT_KEY};
pub use drift::{
    Archives, Change, Drift, FALSE_ALARM_CHANCE, RecordingChange, RotorChange, Unused, drift_json, drift_of, drift_text,
};
pub use error::ArchiveError;
pub use identity::{BatchIdentity, FORMAT};
pub use part::Part;
pub use plan::{Plan, Planned};
pub use row::ArchiveRow;
pub use shard::Shard;
pub use summary::{RotorSummary, Summary, summaries_of, summaries_of_parquet};
pub use table::{RecordingsTable, TRACK_ROWS_MAX, TracksTable};
