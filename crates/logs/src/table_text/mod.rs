//! From a CSV with a header to rows. The words and units of the headers (`column`), or the names that the user gives them, tell the quantities.

mod cells;
mod column;
#[cfg(test)]
mod tests;

use crate::byte_window::ByteWindow;
use crate::electrical::UNIT_OF_HUNDREDS;
use crate::table::{Findings, RowSink, RowValues, SignalRole, TableSignal};
use crate::{LogError, LogFormat, NamedColumn};
pub use cells::CsvCells;
use column::{LogColumn, are_of_blackbox, column_of, column_of_blackbox, unit_of};
use csv::ByteRecord;
use std::io::Read;

/// Bytes from which separator and decimal commas are told.
const HEAD_BYTES: usize = 1 << 17;
/// Name of the one table.
const TABLE: &str = "table";
/// Columns of RCbenchmark. Its speeds are the shaft's: the program divides the electrical speed by the pole pairs.
const RCBENCHMARK_COMMAND: &str = "ESC signal (µs)";
const RCBENCHMARK_SPEEDS: [&str; 2] = ["Motor Electrical Speed (RPM)", "Motor Optical Speed (RPM)"];

/// Names for columns whose headers do not tell their quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnNames {
    names: Vec<ColumnName>,
}

#[derive(Clone, Debug, PartialEq)]
struct ColumnName {
    header: String,
    name: String,
    meaning: LogColumn,
}

impl ColumnNames {
    /// Whether no column has another name.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// Reads the column with this header as if its header were `name`, such as "time_ms", "rotor1_rpm" or "motor2_pwm".
    ///
    /// # Errors
    /// A name that tells no quantity with its unit.
    pub fn add(&mut self, header: &str, name: &str) -> Result<(), LogError> {
        match column_of(name) {
            Some(meaning) if meaning != LogColumn::TimeWithoutUnit => {
                let (header, name) = (header.trim().to_owned(), name.to_owned());
                self.names.push(ColumnName { header, name, meaning });
                Ok(())
            }
            _ => Err(LogError::NameWithoutMeaning { header: header.to_owned(), name: name.to_owned() }),
        }
    }

    /// Refuses names for columns that are not there.
    fn check(&self, headers: &[String]) -> Result<(), LogError> {
        match self.names.iter().find(|name| !headers.contains(&name.header)) {
            Some(name) => Err(LogError::NoSuchColumn { header: name.header.clone(), columns: names_of(headers) }),
            None => Ok(()),
        }
    }
}

/// A column of the table.
struct Column {
    index: usize,
    header: String,
    /// The name that the user gave it.
    name: Option<String>,
    meaning: Option<LogColumn>,
    signal: TableSignal,
    factor: f64,
}

/// Hands the rows of a CSV over, separated by commas, semicolons or tabs. An empty cell is a gap, and so is a cell without a number in a column
/// without meaning.
pub(crate) fn read<R: Read>(
    bytes: &mut ByteWindow<R>,
    names: &ColumnNames,
    sink: &mut impl RowSink,
) -> Result<(LogFormat, Findings), LogError> {
    let head = bytes.ahead(HEAD_BYTES)?;
    let cells = CsvCells::of_head(&head[..head.len().min(HEAD_BYTES)])?;
    let mut reader = cells.reader().from_reader(bytes);
    let headers: Vec<String> =
        reader.byte_headers()?.iter().map(|header| cells::text_of(header).trim().to_owned()).collect();
    names.check(&headers)?;
    let format = if headers.iter().any(|header| header == RCBENCHMARK_COMMAND) {
        LogFormat::RcBenchmark
    } else {
        LogFormat::Csv
    };
    let columns = columns_of(&headers, names, format)?;
    let Some(time) = columns.iter().find(|column| matches!(column.meaning, Some(LogColumn::Time { .. }))) else {
        return Err(LogError::NoTime { columns: names_of(&headers) });
    };
    let signals: Vec<&Column> = columns.iter().filter(|column| column.is_signal_beside(time)).collect();
    sink.table(TABLE.to_owned(), signals.iter().map(|column| column.signal.clone()).collect());
    let mut record = ByteRecord::new();
    let mut about_rotors = vec![f64::NAN; signals.len()];
    let mut before_s = f64::NEG_INFINITY;
    while reader.read_byte_record(&mut record)? {
        refuse_long(&record, headers.len())?;
        let Some(time_s) = number(&cells, time, &record)? else { continue };
        if time_s < before_s {
            return Err(LogError::NotInOrder { line: line_of(&record), time_s });
        }
        before_s = time_s;
        for (place, column) in about_rotors.iter_mut().zip(&signals) {
            if column.signal.role.is_some() {
                *place = number(&cells, column, &record)?.unwrap_or(f64::NAN);
            }
        }
        sink.row(
            0,
            time_s,
            &TextRow { cells: &cells, signals: &signals, record: &record, about_rotors: &about_rotors },
        )?;
    }
    Ok((format, Findings { headers, ..Findings::default() }))
}

/// The headers, for messages.
pub(crate) fn names_of(headers: &[String]) -> String {
    let headers = headers.iter().map(String::as_str).filter(|header| !header.is_empty());
    headers.collect::<Vec<_>>().join(", ")
}

/// Refuses a row with something beyond the last header. A row may be shorter: its other cells are gaps.
fn refuse_long(record: &ByteRecord, header_count: usize) -> Result<(), LogError> {
    if record.len() <= header_count {
        return Ok(());
    }
    let cell_count = record.iter().rposition(|cell| !cell.trim_ascii().is_empty()).map_or(0, |last| last + 1);
    match cell_count > header_count {
        true => Err(LogError::LongRow { line: line_of(record), cell_count, header_count }),
        false => Ok(()),
    }
}

/// Line of a row, counted from 1.
fn line_of(record: &ByteRecord) -> u64 {
    record.position().map_or(0, csv::Position::line)
}

impl Column {
    /// Whether it has values beside the time that is used; a time of another kind ("settling time (s)") is one of them.
    fn is_signal_beside(&self, time: &Self) -> bool {
        self.index != time.index && !self.header.is_empty()
    }
}

fn columns_of(headers: &[String], names: &ColumnNames, format: LogFormat) -> Result<Vec<Column>, LogError> {
    let is_of_blackbox = are_of_blackbox(headers);
    let column = |(index, header): (usize, &String)| {
        let named = names.names.iter().find(|name| name.header == *header);
        let meaning = match named {
            Some(name) => Some(name.meaning),
            None if format == LogFormat::RcBenchmark => meaning_of_rcbenchmark(header),
            None if is_of_blackbox => column_of_blackbox(header),
            None => column_of(header),
        };
        let name = named.map(|name| name.name.clone());
        let (signal, factor) = signal_of(name.as_ref().unwrap_or(header), meaning);
        Column { index, header: header.clone(), name, meaning, signal, factor }
    };
    let columns: Vec<Column> = headers.iter().enumerate().map(column).collect();
    if format != LogFormat::RcBenchmark {
        refuse_twice(&columns)?;
    }
    Ok(columns)
}

fn meaning_of_rcbenchmark(header: &str) -> Option<LogColumn> {
    match header {
        RCBENCHMARK_COMMAND => Some(LogColumn::MotorCommand { motor: 1 }),
        header if RCBENCHMARK_SPEEDS.contains(&header) => Some(LogColumn::MotorSpeed { motor: 1, rev_s: 1.0 / 60.0 }),
        header => {
            column_of(header).filter(|meaning| matches!(meaning, LogColumn::Time { .. } | LogColumn::Torque { .. }))
        }
    }
}

/// The signal of a column, and its unit per unit of the column.
fn signal_of(name: &str, meaning: Option<LogColumn>) -> (TableSignal, f64) {
    let with_role = |role: SignalRole| TableSignal::with_role(name.to_owned(), role);
    match meaning {
        Some(LogColumn::MotorSpeed { motor, rev_s }) => (with_role(SignalRole::RotorSpeed(motor)), rev_s),
        Some(LogColumn::ElectricalSpeed { motor, is_in_hundreds }) => {
            let unit = if is_in_hundreds { UNIT_OF_HUNDREDS } else { "" };
            let signal = with_role(SignalRole::ElectricalSpeed(motor));
            (TableSignal { unit: unit.to_owned(), ..signal }, 1.0)
        }
        Some(LogColumn::MotorCommand { motor }) => (with_role(SignalRole::Command(motor)), 1.0),
        Some(LogColumn::Torque { factor }) => (with_role(SignalRole::Torque), factor),
        Some(LogColumn::Rate { axis, factor }) => (with_role(SignalRole::BodyRate(axis)), factor),
        Some(LogColumn::Time { factor }) => {
            (TableSignal { unit: "s".to_owned(), ..TableSignal::plain(name.to_owned()) }, factor)
        }
        Some(LogColumn::TimeWithoutUnit) | None => {
            (TableSignal { unit: unit_of(name), ..TableSignal::plain(name.to_owned()) }, 1.0)
        }
    }
}

fn refuse_twice(columns: &[Column]) -> Result<(), LogError> {
    for (index, column) in columns.iter().enumerate() {
        let Some(role) = column.signal.role else { continue };
        if let Some(first) = columns[..index].iter().find(|first| first.signal.role == Some(role)) {
            let [first, second] = [first, column]
                .map(|Column { header, name, .. }| NamedColumn { header: header.clone(), name: name.clone() });
            return Err(LogError::Twice { first, second });
        }
    }
    Ok(())
}

/// The finite number of a cell, in the unit of the signal; `None` for an empty cell.
fn number(cells: &CsvCells, column: &Column, record: &ByteRecord) -> Result<Option<f64>, LogError> {
    let cell = record.get(column.index).unwrap_or_default();
    if cells::is_gap(cell) {
        return Ok(None);
    }
    let number = cells.number(cell).map(|number| column.factor * number);
    number.map(Some).ok_or_else(|| LogError::NotANumber {
        line: line_of(record),
        column: column.header.clone(),
        cell: cells::text_of(cell).into_owned(),
    })
}

/// A row of text.
struct TextRow<'a> {
    cells: &'a CsvCells,
    signals: &'a [&'a Column],
    record: &'a ByteRecord,
    /// Numbers that were read already, of the signals with a role.
    about_rotors: &'a [f64],
}

impl RowValues for TextRow<'_> {
    fn value(&self, signal: usize) -> f64 {
        let Some(column) = self.signals.get(signal) else { return f64::NAN };
        if column.signal.role.is_some() {
            return self.about_rotors.get(signal).copied().unwrap_or(f64::NAN);
        }
        let cell = self.record.get(column.index).unwrap_or_default();
        self.cells.number(cell).map_or(f64::NAN, |number| column.factor * number)
    }
}
