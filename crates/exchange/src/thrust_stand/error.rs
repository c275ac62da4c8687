//! Errors in tables of thrust stands.

use crate::csv_text::CsvError;
use hovertone_vehicle::number_in_words;

/// Error in a table.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// No table, or a cell that is not a number.
    #[error(transparent)]
    Csv(#[from] CsvError),
    /// A column is missing.
    #[error("no column holds {what}; the columns are: {columns}")]
    NoColumn {
        /// The missing quantity.
        what: &'static str,
        /// The headers.
        columns: String,
    },
    /// A column of the missing quantity is there, without its unit.
    #[error("column \"{column}\" has no unit that hovertone knows, and no other column holds a thrust or a mass")]
    NoUnit {
        /// Header of the column.
        column: String,
    },
    /// A row without a standard uncertainty, where other rows have one.
    #[error("line {line}, column \"{column}\": the cell is empty, but other rows have an uncertainty there")]
    EmptyStd {
        /// Line, counted from 1.
        line: u64,
        /// Header of its column.
        column: String,
    },
    /// A number out of range.
    #[error("line {line}, column \"{column}\": {} is {fault}", number_in_words(*value))]
    OutOfRange {
        /// Line, counted from 1.
        line: u64,
        /// Header of its column.
        column: String,
        /// The number, in the unit of the column.
        value: f64,
        /// What is wrong with it, after "is".
        fault: &'static str,
    },
    /// Numbers of several rows that only another unit than that of the header explains.
    #[error("column \"{column}\": {count} of {of} numbers are {fault}; the largest one is {}", number_in_words(*largest))]
    OtherUnit {
        /// Header of the column.
        column: String,
        /// Numbers beyond the limit.
        count: usize,
        /// All numbers of the column.
        of: usize,
        /// The largest of these numbers.
        largest: f64,
        /// What is wrong with them, after "are".
        fault: &'static str,
        /// A header with the unit that is probably meant; absent where none of the known units is.
        header: Option<&'static str>,
    },
    /// A header alone.
    #[error("the table has a header and no row below it")]
    HeaderAlone,
    /// No row with a turning rotor.
    #[error(
        "there is nothing to fit: in every row, the speed or the force (thrust or mass) is missing, is zero, or is far too small"
    )]
    NoRow,
}
