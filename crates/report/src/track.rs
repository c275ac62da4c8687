//! The speed over time as a table.

use crate::csv_text::text_of;
use crate::recording::SpeedRecord;
use hovertone_analysis::TrackPoint;
use serde::Serialize;
use std::borrow::Cow;

/// The tracks of a recording with the numbers of their rotors, from 1 as in its table; 0 for all together. None without a speed, or where several
/// are possible.
pub fn numbered_tracks(record: &SpeedRecord) -> impl Iterator<Item = (usize, Cow<'_, [TrackPoint]>)> {
    let tone = record.tone().filter(|_| !record.is_ambiguous());
    let first = usize::from(!record.rotors().is_empty());
    (first..).zip(tone.into_iter().flat_map(|tone| tone.tracks_beside_log(record.method)))
}

/// The track of every recording as CSV; with several recordings the first column is the file. Separated rotors have lines of their own,
/// with their number in the table in a column `rotor`. One tone of several rotors has their spread in its uncertainty. A recording without a rotor
/// tone has no line.
///
/// # Errors
/// None is known, since the writer writes to memory.
pub fn track_csv(records: &[SpeedRecord]) -> Result<String, csv::Error> {
    #[derive(Serialize)]
    struct Line<'a> {
        #[serde(skip_serializing_if = "Option::is_none")]
        file: Option<&'a str>,
        time_s: f64,
        tone_hz: f64,
        speed_rev_s: f64,
        std_uncertainty_rev_s: f64,
        level_db: f64,
        #[serde(skip_serializing_if = "Option::is_none")]
        rotor: Option<usize>,
        #[serde(skip_serializing_if = "Option::is_none")]
        label: Option<&'a str>,
    }
    let has_rotors = records.iter().any(|record| !record.rotors().is_empty());
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    let mut columns = vec!["time_s", "tone_hz", "speed_rev_s", "std_uncertainty_rev_s", "level_db"];
    if records.len() != 1 {
        columns.insert(0, "file");
    }
    if has_rotors {
        columns.push("rotor");
    }
    let has_labels = records.iter().any(|record| record.labels.is_some());
    if has_rotors && has_labels {
        columns.push("label");
    }
    writer.write_record(&columns)?;
    for record in records {
        let file = (records.len() != 1).then_some(record.file.as_str());
        let line = |point: &TrackPoint, rotor: Option<usize>| {
            let &TrackPoint { time_s, tone_hz, speed_rev_s, std_uncertainty_rev_s, level_db } = point;
            // a rotor without a label has an empty cell
            let name = || rotor.and_then(|number| record.label(number.checked_sub(1)?)).map_or("", |label| &label.name);
            let label = (has_rotors && has_labels).then(name);
            Line { file, time_s, tone_hz, speed_rev_s, std_uncertainty_rev_s, level_db, rotor, label }
        };
        for (rotor, track) in numbered_tracks(record) {
            track.iter().try_for_each(|point| writer.serialize(line(point, has_rotors.then_some(rotor))))?;
        }
    }
    text_of(writer)
}
