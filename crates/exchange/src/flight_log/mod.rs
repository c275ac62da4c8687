//! Logs of flights → motors and body rates over time, in SI.
//!
//! ```text
//! csv_log  a CSV with a header; what its columns are called (column)
//! ulog     PX4's ULog: messages and what damage leaves of them (file), their layout (format), the topics that tell rotors
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
    /// On the log's clock, increasing.
    pub time_s: Vec<f64>,
    /// Names with the numbers that the log has for them: "motor 1".
    pub names: Vec<String>,
    /// `values[motor][row]`.
    pub values: Vec<Vec<f64>>,
}

/// How the axes of body rates point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RateAxes {
    /// x forward, y left, z up.
    ForwardLeftUp,
    /// x forward, y right, z down.
    ForwardRightDown,
}

/// Rates at which the body turns, as the log has its axes.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedRates {
    /// On the log's clock, increasing.
    pub time_s: Vec<f64>,
    /// About x, y and z.
    pub rates_rad_s: [Vec<f64>; 3],
    /// How they point, where the format says it.
    pub axes: Option<RateAxes>,
}

/// What a log says of its rotors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoggedFlight {
    /// Measured speeds, rad/s.
    pub speeds: Option<LoggedMotors>,
    /// Commands, in whatever unit.
    pub commands: Option<LoggedMotors>,
    /// Body rates.
    pub rates: Option<LoggedRates>,
    /// What is wrong with it.
    pub notes: Vec<String>,
}

/// A log that cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FlightLogError {
    /// No table, or a cell that is no number.
    #[error(transparent)]
    Csv(#[from] CsvError),
    /// Neither text nor a ULog.
    #[error("this is neither a CSV nor a PX4 ULog")]
    UnknownFormat,
    /// A ULog without data.
    #[error("this ULog ends, or is damaged, before its data begin")]
    UlogWithoutData,
    /// A ULog that tells nothing of rotors.
    #[error("this ULog holds no motor speeds, motor commands or body rates; its topics are: {topics}")]
    UlogWithoutSignal {
        /// What it holds.
        topics: String,
    },
    /// No times.
    #[error("no column holds the time with its unit; the columns are: {columns}")]
    NoTime {
        /// The headers.
        columns: String,
    },
    /// Nothing that tells rotors.
    #[error("no columns hold motors or body rates; the columns are: {columns}")]
    NoSignal {
        /// The headers.
        columns: String,
    },
    /// Two columns for one thing.
    #[error("columns \"{first}\" and \"{second}\" say the same")]
    Twice {
        /// The one.
        first: String,
        /// The other.
        second: String,
    },
    /// Times that go back.
    #[error("line {line}: its time, {time_s} s, is before that of the line above it")]
    NotInOrder {
        /// Line, counted from 1.
        line: u64,
        /// Its time.
        time_s: f64,
    },
}

impl FlightLogError {
    /// What to do about it.
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

/// Reads a log of either kind, which its first bytes tell: PX4's ULog by its magic, else CSV.
///
/// From a ULog come the speeds of `esc_status`, the commands of `actuator_motors` (else of that instance of `actuator_outputs` that
/// moves most channels), and the rates of `vehicle_angular_velocity` (else of `sensor_combined`), x forward, y right and z down. Each
/// keeps its own times. A log that breaks off or is damaged is read as far as it can be, with a note.
///
/// # Errors
/// As [`flight_log_from_csv`]; bytes that are neither; a ULog in which nothing tells of rotors.
pub fn flight_log_from_bytes(bytes: &[u8]) -> Result<LoggedFlight, FlightLogError> {
    if ulog::is_ulog(bytes) {
        return ulog::flight_log_from_ulog(bytes);
    }
    if bytes.contains(&0) {
        return Err(FlightLogError::UnknownFormat);
    }
    flight_log_from_csv(&String::from_utf8_lossy(bytes))
}
