//! CSV text: a header, then rows, separated by commas, semicolons or tabs.

use csv::StringRecord;
use hovertone_logs::{CsvCells, NoTable, has_thousands_point};

/// An error in CSV text.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CsvError {
    /// Something else.
    #[error(transparent)]
    NoTable(#[from] NoTable),
    /// No CSV with a header.
    #[error("this is no table with a header: {0}")]
    NotCsv(#[from] csv::Error),
    /// A row with more or fewer cells than the header.
    #[error("line {line}: the row has {cells} {}, but the header has {columns}", if *cells == 1 { "cell" } else { "cells" })]
    RaggedRow {
        /// Line, counted from 1.
        line: u64,
        /// Number of its cells.
        cells: usize,
        /// Number of columns.
        columns: usize,
    },
    /// A cell that is not a number.
    #[error("line {line}, column \"{column}\": \"{cell}\" is no number")]
    NotANumber {
        /// Line, counted from 1.
        line: u64,
        /// Header of the column.
        column: String,
        /// Text of the cell.
        cell: String,
    },
}

impl CsvError {
    /// Advice to the user.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::NoTable(what) => what.hint(),
            Self::NotCsv(_) => NoTable::Json.hint(),
            Self::RaggedRow { cells, columns, .. } if cells > columns => {
                "correct or remove the row; if the decimal sign is a comma, separate the cells by semicolons: 3,5 is \
                 read as two cells"
            }
            Self::RaggedRow { .. } => "complete or remove the row",
            Self::NotANumber { cell, .. } if has_thousands_point(cell.as_bytes()) => {
                "in this table the decimal sign is a comma: write thousands without a point, as 1000"
            }
            Self::NotANumber { cell, .. } if cell.split_once(',').is_some_and(|(_, part)| part.len() == 3) => {
                "a comma before three digits may mean thousands or decimals: for thousands leave it out, for decimals write a point"
            }
            Self::NotANumber { .. } => "correct the cell, or remove the row",
        }
    }
}

/// A CSV with a parsed header. Each call of `records` reads the rows again, so that a long log is never held in memory.
pub(crate) struct CsvText<'a> {
    text: &'a str,
    cells: CsvCells,
    pub(crate) headers: StringRecord,
}

impl<'a> CsvText<'a> {
    /// Opens a CSV.
    pub(crate) fn open(text: &'a str) -> Result<Self, CsvError> {
        let text = text.trim_start_matches('\u{feff}');
        NoTable::check(text)?;
        let cells = CsvCells::of_text(text);
        let headers = reader(text, cells).headers()?.clone();
        Ok(Self { text, cells, headers })
    }

    /// The rows.
    pub(crate) fn records(&self) -> impl Iterator<Item = Result<StringRecord, CsvError>> + use<'a> {
        let text = self.text.as_bytes();
        reader(self.text, self.cells).into_records().map(move |record| Ok(after_line_breaks(record?, text)))
    }

    /// Refuses a row that ends before the last of the columns that are used, or has more cells than the header that are not empty: its
    /// cells may stand in the wrong columns. RCbenchmark leaves out empty cells at the end of a row.
    pub(crate) fn check_length(&self, record: &StringRecord, last_used: usize) -> Result<(), CsvError> {
        let (cells, columns) = (record.len(), self.headers.len());
        if cells > last_used && record.iter().skip(columns).all(str::is_empty) {
            return Ok(());
        }
        Err(CsvError::RaggedRow { line: line_of(record), cells, columns })
    }

    /// The headers, for messages.
    pub(crate) fn names(&self) -> String {
        self.headers.iter().filter(|header| !header.is_empty()).collect::<Vec<_>>().join(", ")
    }

    /// The finite number in a cell; `None` otherwise.
    pub(crate) fn number(&self, cell: &str) -> Option<f64> {
        self.cells.number(cell.as_bytes())
    }

    /// The number in a column of a row; `None` where the cell is empty or missing.
    pub(crate) fn number_at(&self, column: usize, record: &StringRecord) -> Result<Option<f64>, CsvError> {
        let cell = record.get(column).unwrap_or_default();
        if cell.is_empty() {
            return Ok(None);
        }
        self.number(cell).map(Some).ok_or_else(|| CsvError::NotANumber {
            line: line_of(record),
            column: self.headers.get(column).unwrap_or_default().to_owned(),
            cell: cell.to_owned(),
        })
    }
}

/// Line of a row, counted from 1.
pub(crate) fn line_of(record: &StringRecord) -> u64 {
    record.position().map_or(0, csv::Position::line)
}

/// The row, whose position is after the line breaks before it: the reader takes LF of CR LF, and empty lines, for the beginning of the row.
fn after_line_breaks(mut record: StringRecord, text: &[u8]) -> StringRecord {
    if let Some(mut position) = record.position().cloned() {
        let rest = usize::try_from(position.byte()).ok().and_then(|byte| text.get(byte..)).unwrap_or_default();
        let breaks = rest.iter().take_while(|byte| matches!(byte, b'\r' | b'\n'));
        position.set_line(position.line() + breaks.filter(|byte| **byte == b'\n').count() as u64);
        record.set_position(Some(position));
    }
    record
}

fn reader(text: &str, cells: CsvCells) -> csv::Reader<&[u8]> {
    cells.reader().trim(csv::Trim::All).from_reader(text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_parted_by_what_the_header_has_most_of() {
        for text in ["a,b\n1,2.5\n", "a;b\n1;2,5\n", "\u{feff}a\tb\n1\t2.5\n", "# x,y;z;w\na,b\n1,\"2,5\"\n"] {
            let csv = CsvText::open(text).unwrap();
            assert_eq!(csv.names(), "a, b", "{text:?}");
            let record = csv.records().next().unwrap().unwrap();
            let numbers = [0, 1, 2].map(|column| csv.number_at(column, &record).unwrap());
            assert_eq!(numbers, [Some(1.0), Some(2.5), None], "{text:?}");
        }
    }

    #[test]
    fn lines_have_their_numbers_with_all_line_breaks() {
        for line_break in ["\n", "\r\n"] {
            let text = ["a,b", "1,2", "", "3,4", "\"5\",6"].join(line_break);
            let lines: Vec<u64> = CsvText::open(&text).unwrap().records().map(|row| line_of(&row.unwrap())).collect();
            assert_eq!(lines, [2, 4, 5], "{line_break:?}");
        }
    }

    #[test]
    fn what_is_no_number_is_named_with_its_place() {
        for cell in ["fast", "inf", "NaN", "1,000"] {
            let text = format!("a;b\n1;{cell}\n");
            let csv = CsvText::open(&text).unwrap();
            let record = csv.records().next().unwrap().unwrap();
            let message = csv.number_at(1, &record).unwrap_err().to_string();
            assert_eq!(message, format!("line 2, column \"b\": \"{cell}\" is no number"));
        }
    }
}
