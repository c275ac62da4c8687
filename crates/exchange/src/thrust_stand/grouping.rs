//! Which columns of words make groups, and which only name the rows.

use super::column::Column;
use csv::StringRecord;
use std::collections::HashSet;

/// Indices of the columns that make groups. A column whose words all differ within each group of the others names rows, as "no hull", "small hull":
/// groups by it would have one row each. Of several such columns the last one does.
pub(super) fn grouping_columns(columns: &[Column], records: &[StringRecord]) -> Vec<usize> {
    let words: Vec<usize> = columns.iter().filter(|column| column.is_words).map(|column| column.index).collect();
    words.iter().rev().fold(words.clone(), |groups_by, &column| {
        let others: Vec<usize> = groups_by.iter().copied().filter(|&other| other != column).collect();
        let has_groups = different(records, &others) < records.len();
        if has_groups && different(records, &groups_by) == records.len() { others } else { groups_by }
    })
}

/// Number of groups of rows that have the same words in these columns.
fn different(records: &[StringRecord], columns: &[usize]) -> usize {
    let words = |record| columns.iter().map(|&column| StringRecord::get(record, column)).collect::<Vec<_>>();
    records.iter().map(words).collect::<HashSet<_>>().len()
}
