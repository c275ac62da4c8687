//! The track of a recording as rows of `tracks/`. Names are those of `hovertone speed --track`.

use crate::columns::{Columns, NO_UNIT, head, plain};
use arrow_array::RecordBatch;
use arrow_schema::ArrowError;
use hovertone_analysis::TrackPoint;
use hovertone_report::SpeedRecord;

/// One point of one rotor.
struct TrackRow<'a> {
    file: &'a str,
    rotor: i64,
    point: &'a TrackPoint,
}

/// One row for each frame and rotor: rotors are counted from 1 as in the row of the recording; 0 stands for all rotors together. A recording without
/// a settled speed has none.
pub(crate) fn tracks_batch(record: Option<&SpeedRecord>) -> Result<RecordBatch, ArrowError> {
    let rows = record.map(rows_of).unwrap_or_default();
    Columns::of(&rows)
        .text(plain("file", "name of the recording's file, as it was found"), |row| row.file)
        .whole(head("rotor", NO_UNIT, "number of the rotor: 1 is the fastest, 0 means all rotors together"), |row| {
            Some(row.rotor)
        })
        .number(head("time_s", "s", "middle of the frame"), |row| Some(row.point.time_s))
        .number(head("tone_hz", "Hz", "frequency of the tone"), |row| Some(row.point.tone_hz))
        .number(head("speed_rev_s", "rev/s", "shaft speed"), |row| Some(row.point.speed_rev_s))
        .number(head("std_uncertainty_rev_s", "rev/s", "standard uncertainty of the speed"), |row| {
            Some(row.point.std_uncertainty_rev_s)
        })
        .number(
            head("level_db", "dB", "level of the strongest harmonic; 0 dB is the loudest sine that the file can hold"),
            |row| Some(row.point.level_db),
        )
        .batch()
}

fn rows_of(record: &SpeedRecord) -> Vec<TrackRow<'_>> {
    let Some(tone) = record.tone().filter(|_| !record.is_ambiguous()) else { return Vec::new() };
    let file = record.file.as_str();
    if tone.rotors.is_empty() {
        return tone.track.iter().map(|point| TrackRow { file, rotor: 0, point }).collect();
    }
    let of_rotors = (1..).zip(&tone.rotors);
    of_rotors.flat_map(|(rotor, of)| of.track.iter().map(move |point| TrackRow { file, rotor, point })).collect()
}
