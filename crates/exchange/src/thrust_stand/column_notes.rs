//! Notes about the columns of a table: which are not used, and how uncertainties are read.

use super::column::Column;
use super::header::{Quantity, words_of};
use super::{MeasuredColumns, TableNote, numbers_in, std_of};
use crate::csv_text::CsvText;
use csv::StringRecord;

/// Headers of a column of coverage factors, as words.
const FACTOR_HEADERS: [&[&str]; 4] = [&["k"], &["k", "factor"], &["coverage", "factor"], &["coverage", "factor", "k"]];
/// Largest number in a column of coverage factors; a column "K" has temperatures.
const FACTOR_MAX: f64 = 10.0;

/// The notes about all columns.
pub(super) fn column_notes(
    csv: &CsvText,
    columns: &[Column],
    records: &[StringRecord],
    used: MeasuredColumns<'_>,
) -> Vec<TableNote> {
    let measured = [used.force, used.speed];
    let mut notes: Vec<TableNote> = columns.iter().filter_map(Column::why_unused).collect();
    notes.extend(rivals(csv, columns, records, used));
    notes.extend(std_notes(columns, measured));
    notes.extend(factor_note(csv, columns, records, measured));
    notes.extend(used.speed.is_in_hz().then(|| TableNote::SpeedInHz { column: used.speed.header.clone() }));
    notes
}

/// Notes about columns that could have been the speed or the force as well: one for the speed, one for the force.
fn rivals(csv: &CsvText, columns: &[Column], records: &[StringRecord], used: MeasuredColumns<'_>) -> Vec<TableNote> {
    let note = |(what, chosen): (&'static str, &Column)| {
        let is_rival = |column: &&Column| {
            let is_of_kind = match column.quantity {
                Some(Quantity::Speed) => what == "speed",
                Some(Quantity::Thrust | Quantity::Mass) => what == "force",
                _ => false,
            };
            is_of_kind && column.index != chosen.index && numbers_in(csv, column, records) > 0
        };
        let rivals: Vec<String> = columns.iter().filter(is_rival).map(|column| column.header.clone()).collect();
        (!rivals.is_empty()).then(|| TableNote::Rivals { columns: rivals, what, chosen: chosen.header.clone() })
    };
    [("speed", used.speed), ("force", used.force)].into_iter().filter_map(note).collect()
}

/// How the columns of uncertainties of these columns are read.
fn std_notes(columns: &[Column], measured: [&Column; 2]) -> Vec<TableNote> {
    let mut notes = Vec::new();
    for quantity in measured.into_iter().filter_map(Column::std_quantity) {
        let mut of_quantity = columns.iter().filter(|column| column.quantity == Some(quantity));
        let Some(used) = of_quantity.next() else { continue };
        let expanded = used.coverage_factor().filter(|factor| (factor - 1.0).abs() > 0.0);
        notes.extend(expanded.map(|coverage_factor| TableNote::Expanded {
            column: used.header.clone(),
            coverage_factor,
            stated: used.coverage.parts.clone(),
            is_named_without: used.coverage.is_named_without,
        }));
        notes.extend(of_quantity.map(|other| TableNote::Rivals {
            columns: vec![other.header.clone()],
            what: "uncertainty",
            chosen: used.header.clone(),
        }));
    }
    notes
}

/// A note about a column of coverage factors, where the uncertainties are read with another one.
fn factor_note(
    csv: &CsvText,
    columns: &[Column],
    records: &[StringRecord],
    measured: [&Column; 2],
) -> Option<TableNote> {
    let is_factor = |column: &&Column| {
        let lower = column.header.to_lowercase();
        let words: Vec<&str> = words_of(&lower).collect();
        FACTOR_HEADERS.contains(&words.as_slice())
    };
    let column = columns.iter().find(is_factor)?;
    let factors: Vec<f64> = records.iter().filter_map(|record| column.number(csv, record)).collect();
    if factors.is_empty() || factors.iter().any(|factor| !(*factor > 0.0 && *factor <= FACTOR_MAX)) {
        return None;
    }
    measured.into_iter().filter_map(|measured| std_of(columns, measured)).find_map(|uncertainty| {
        let coverage_factor = uncertainty.coverage_factor()?;
        let is_other = factors.iter().any(|factor| (factor - coverage_factor).abs() > 0.0);
        is_other.then(|| TableNote::FactorColumn {
            column: column.header.clone(),
            uncertainty: uncertainty.header.clone(),
            coverage_factor,
        })
    })
}
