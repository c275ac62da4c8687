//! Errors in logs.

use crate::{LogFormat, NoTable, has_thousands_point};
use std::{fmt, io};

/// Why a log cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LogError {
    /// The source of the bytes failed.
    #[error("the log cannot be read: {0}")]
    Read(#[from] io::Error),
    /// The caller could not write the rows.
    #[error("the signals cannot be written: {0}")]
    Write(io::Error),
    /// Neither text nor a known format.
    #[error("this is neither a CSV nor a log of PX4 (ULog), ArduPilot (DataFlash) or Betaflight (blackbox)")]
    UnknownFormat,
    /// No row of any table.
    #[error("this {format} ends, or is damaged, before its data begin")]
    WithoutData {
        /// Format of the log.
        format: LogFormat,
    },
    /// A binary log without signals about rotors.
    #[error("this {format} holds no motor speeds, motor commands or body rates; its tables are: {tables}")]
    WithoutSignal {
        /// Format of the log.
        format: LogFormat,
        /// Names of its tables.
        tables: String,
    },
    /// A version of a format that is not read.
    #[error("this {format} has version {version} of its format, but hovertone reads version {known}")]
    OtherVersion {
        /// Format of the log.
        format: LogFormat,
        /// The version in the log.
        version: String,
        /// The version that is read.
        known: &'static str,
    },
    /// Something else where a table is needed.
    #[error(transparent)]
    NoTable(#[from] NoTable),
    /// No CSV with a header.
    #[error("this is no table with a header: {0}")]
    NotCsv(#[from] csv::Error),
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
    /// No column with times.
    #[error("no header names the time and its unit; the columns are: {columns}")]
    NoTime {
        /// The headers.
        columns: String,
    },
    /// No column about rotors.
    #[error("no header names a motor or a body rate (turning rate of the vehicle); the columns are: {columns}")]
    NoSignal {
        /// The headers.
        columns: String,
    },
    /// Two columns with the same quantity.
    #[error("columns {first} and {second} are read as the same signal")]
    Twice {
        /// The first.
        first: NamedColumn,
        /// The second.
        second: NamedColumn,
    },
    /// Times that decrease.
    #[error("line {line}: its time, {time_s} s, is earlier than the time of the line above")]
    NotInOrder {
        /// Line, counted from 1.
        line: u64,
        /// The time in that line.
        time_s: f64,
    },
    /// A row with more cells than the header has, so that no cell is known to stand in its column.
    #[error("line {line}: the row has {cell_count} cells, but the header has {header_count}")]
    LongRow {
        /// Line, counted from 1.
        line: u64,
        /// Cells of the row, up to the last that is not empty.
        cell_count: usize,
        /// Cells of the header.
        header_count: usize,
    },
    /// A name for a column that is not there.
    #[error("there is no column \"{header}\"; the columns are: {columns}")]
    NoSuchColumn {
        /// The header of the user.
        header: String,
        /// The headers.
        columns: String,
    },
    /// A name for a column that has no meaning.
    #[error("\"{name}\" is no column name that hovertone knows, so it cannot stand for the column \"{header}\"")]
    NameWithoutMeaning {
        /// The header of the user.
        header: String,
        /// The name that the user gave.
        name: String,
    },
    /// Names for the columns of a log that has none.
    #[error("the signals of this {format} have fixed names, which --column cannot change")]
    NoColumns {
        /// Format of the log.
        format: LogFormat,
    },
    /// No signal of this name.
    #[error("the log has no signal \"{name}\"{}", why_no_signal(tables, meant.as_deref()))]
    NoSuchSignal {
        /// The name of the user.
        name: String,
        /// Names of the tables.
        tables: String,
        /// The name with its table, where the table was left out.
        meant: Option<String>,
    },
    /// Signals of several tables, which do not share their times.
    #[error("\"{first}\" and \"{second}\" are signals of two tables with different times")]
    SeveralTables {
        /// A signal.
        first: String,
        /// A signal of another table.
        second: String,
    },
}

/// A column of a CSV in a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedColumn {
    /// Its header.
    pub header: String,
    /// The name that the user gave it.
    pub name: Option<String>,
}

impl fmt::Display for NamedColumn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { header, name } = self;
        write!(f, "\"{header}\"")?;
        name.as_ref().map_or(Ok(()), |name| write!(f, " (with the name {name} from --column)"))
    }
}

/// Largest number of tables that are listed in a message.
const TABLES_LISTED_MAX: usize = 6;

/// Why a log has no such signal: the name of its table is missing; else the tables, where the log has several.
fn why_no_signal(tables: &str, meant: Option<&str>) -> String {
    match meant {
        Some(_) => ": the name of its table is missing".to_owned(),
        None if tables.contains(", ") => few_tables(tables),
        None => String::new(),
    }
}

/// The tables of a log behind a message, where they are few.
fn few_tables(tables: &str) -> String {
    match tables.split(", ").count() {
        1..=TABLES_LISTED_MAX => format!("; its tables are: {tables}"),
        _ => String::new(),
    }
}

impl LogError {
    /// Advice to the user.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::Read(_) => "check the file and its disk",
            Self::Write(_) => "check the disk",
            Self::UnknownFormat => {
                "export the log as CSV with a header, or give PX4's .ulg, ArduPilot's .bin or Betaflight's .bbl"
            }
            Self::WithoutData { .. } => {
                "download the log from the vehicle again; if the new copy has the same fault, log another flight"
            }
            Self::WithoutSignal { format: LogFormat::Ulog, .. } => {
                "let PX4 log esc_status, actuator_motors, actuator_outputs or vehicle_angular_velocity (SDLOG_PROFILE)"
            }
            Self::WithoutSignal { format: LogFormat::DataFlash, .. } => {
                "let ArduPilot log the message ESC (speeds, from ESC telemetry), RCOU (motor commands) or IMU (body rates): LOG_BITMASK chooses"
            }
            Self::WithoutSignal { .. } => {
                "let Betaflight log motors, gyro or, with bidirectional DShot, RPM (blackbox)"
            }
            Self::OtherVersion { .. } => "export the log as CSV with its own program (blackbox_decode)",
            Self::NoTable(NoTable::Json) => {
                "give a log: PX4's .ulg, ArduPilot's .bin, Betaflight's .bbl, or a CSV file whose first line names the \
                 columns"
            }
            Self::NoTable(what) => what.hint(),
            Self::NotCsv(_) => NoTable::Json.hint(),
            Self::NotANumber { cell, .. } if has_thousands_point(cell.as_bytes()) => {
                "in this table the decimal sign is a comma: write thousands without a point, as 1000"
            }
            Self::NotANumber { .. } => "correct the cell, or leave it empty: an empty cell is a gap",
            Self::NoTime { .. } => {
                "rename the header of the time column, for example to time_s, or to timestamp_us for microseconds"
            }
            Self::NoSignal { .. } => {
                "name columns as motor1_pwm, rotor1_speed_rad_s or gyro_x_rad_s, with their units (docs/logs.md)"
            }
            Self::Twice { first, second } if first.name.is_none() && second.name.is_none() => {
                "remove one of the columns"
            }
            Self::Twice { .. } => "give the two columns different names with --column",
            Self::NotInOrder { .. } => {
                "sort the rows by their time; if the log has several flights, give the log of one"
            }
            Self::LongRow { .. } => {
                "correct or remove the row; if the decimal sign is a comma, separate the cells by semicolons: 3,5 is \
                read as two cells"
            }
            Self::NoSuchColumn { .. } => "copy the header exactly from the file",
            Self::NameWithoutMeaning { .. } => {
                "give a name such as time_s, rotor1_rpm, motor1_pwm or gyro_x_rad_s (docs/logs.md)"
            }
            Self::NoColumns { .. } => "leave --column out: it names columns of CSV files only",
            Self::NoSuchSignal { .. } => {
                "`hovertone log FILE --signals` lists all signals; copy a name from there, with its table"
            }
            Self::SeveralTables { .. } => "give the signals of one table; run the command again for the other table",
        }
    }
}
