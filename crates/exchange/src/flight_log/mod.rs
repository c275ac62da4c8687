//! From logs of flights to motors and body rates over time, in SI units.
//!
//! ```text
//! csv_log  a CSV with a header, and the quantities of its columns (column)
//! ulog     PX4's ULog: undamaged messages (file), their layout (format), and the topics about rotors
//! ```

mod column;
mod csv_log;
#[cfg(test)]
mod tests;
mod ulog;

pub use csv_log::flight_log_from_csv;

use crate::csv_text::CsvError;

/// A series for each motor.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedMotors {
    /// Times on the clock of the log, increasing.
    pub time_s: Vec<f64>,
    /// Names with the numbers in the log: "motor 1".
    pub names: Vec<String>,
    /// `values[motor][row]`.
    pub values: Vec<Vec<f64>>,
}

/// Axes of body rates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RateAxes {
    /// x forward, y left, z up.
    ForwardLeftUp,
    /// x forward, y right, z down.
    ForwardRightDown,
}

/// Body rates in the axes of the log.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedRates {
    /// Times on the clock of the log, increasing.
    pub time_s: Vec<f64>,
    /// Rates about x, y and z.
    pub rates_rad_s: [Vec<f64>; 3],
    /// The axes, where the format defines them.
    pub axes: Option<RateAxes>,
}

/// Content of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoggedFlight {
    /// Measured speeds, rad/s.
    pub speeds: Option<LoggedMotors>,
    /// Commands, in any unit.
    pub commands: Option<LoggedMotors>,
    /// Body rates.
    pub rates: Option<LoggedRates>,
    /// Defects of the log.
    pub notes: Vec<String>,
}

/// Error in a log.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FlightLogError {
    /// No table, or a cell that is not a number.
    #[error(transparent)]
    Csv(#[from] CsvError),
    /// Neither text nor a ULog.
    #[error("this is neither a CSV nor a PX4 ULog")]
    UnknownFormat,
    /// A ULog without data.
    #[error("this ULog ends, or is damaged, before its data begin")]
    UlogWithoutData,
    /// A ULog without topics about rotors.
    #[error("this ULog holds no motor speeds, motor commands or body rates; its topics are: {topics}")]
    UlogWithoutSignal {
        /// Names of its topics.
        topics: String,
    },
    /// No column with times.
    #[error("no column holds the time with its unit; the columns are: {columns}")]
    NoTime {
        /// The headers.
        columns: String,
    },
    /// No column about rotors.
    #[error("no columns hold motors or body rates; the columns are: {columns}")]
    NoSignal {
        /// The headers.
        columns: String,
    },
    /// Two columns with the same quantity.
    #[error("columns \"{first}\" and \"{second}\" say the same")]
    Twice {
        /// Header of the first.
        first: String,
        /// Header of the second.
        second: String,
    },
    /// Times that decrease.
    #[error("line {line}: its time, {time_s} s, is before that of the line above it")]
    NotInOrder {
        /// Line, counted from 1.
        line: u64,
        /// The time in that line.
        time_s: f64,
    },
}

impl FlightLogError {
    /// Advice to the user.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::Csv(CsvError::NotANumber { .. }) => "correct the cell, or leave it empty: that is a gap",
            Self::Csv(error) => error.hint(),
            Self::UnknownFormat => "export the log as CSV with a header, or give PX4's .ulg",
            Self::UlogWithoutData => "download the log from the vehicle again, or give that of the same flight",
            Self::UlogWithoutSignal { .. } => {
                "let PX4 log esc_status, actuator_motors, actuator_outputs or vehicle_angular_velocity (SDLOG_PROFILE)"
            }
            Self::NoTime { .. } => "name the unit, as in time_s or timestamp_us",
            Self::NoSignal { .. } => {
                "name columns as motor1_pwm, rotor1_speed_rad_s or gyro_x_rad_s, with their units (docs/formats.md)"
            }
            Self::Twice { .. } => "remove one of the columns",
            Self::NotInOrder { .. } => "sort the log by its time, and give the log of one flight",
        }
    }
}

/// Reads a log. The magic bytes at its start identify a ULog of PX4; anything else is CSV.
///
/// From a ULog come the speeds of `esc_status`, the commands of `actuator_motors` (or of the instance of `actuator_outputs` in which most
/// channels move), and the rates of `vehicle_angular_velocity` (or of `sensor_combined`) with x forward, y right and z down. Each topic
/// keeps its own times. A truncated or damaged log is read as far as possible, with a note.
///
/// # Errors
/// The errors of [`flight_log_from_csv`]; bytes that are neither text nor a ULog; a ULog without topics about rotors.
pub fn flight_log_from_bytes(bytes: &[u8]) -> Result<LoggedFlight, FlightLogError> {
    if ulog::is_ulog(bytes) {
        return ulog::flight_log_from_ulog(bytes);
    }
    if bytes.contains(&0) {
        return Err(FlightLogError::UnknownFormat);
    }
    flight_log_from_csv(&String::from_utf8_lossy(bytes))
}
