//! Rows that are exact copies of earlier ones, as in a table that was pasted twice.

use super::{StandGroup, TableNote};
use crate::csv_text::line_of;
use csv::StringRecord;
use std::collections::{HashMap, HashSet};

/// Some rows of a long table are equal by chance, because their numbers are rounded. From this share of the rows on, this is no chance.
const COPIES_SHARE_MIN: f64 = 0.5;

/// A note for each group in which most rows, or half of them, are copies.
pub(super) fn copies_notes(groups: &[StandGroup], records: &[StringRecord]) -> Vec<TableNote> {
    let by_line: HashMap<u64, &StringRecord> = records.iter().map(|record| (line_of(record), record)).collect();
    let note = |group: &StandGroup| {
        let records = group.rows.iter().filter_map(|row| by_line.get(&row.line_number));
        let rows = || records.clone().map(|record| record.iter().collect::<Vec<&str>>());
        let (of, different) = (rows().count(), rows().collect::<HashSet<_>>().len());
        let count = of - different;
        let are_many = count > 0 && count as f64 >= COPIES_SHARE_MIN * of as f64;
        are_many.then(|| TableNote::Copies { group: group.name.clone(), count, of })
    };
    groups.iter().filter_map(note).collect()
}
