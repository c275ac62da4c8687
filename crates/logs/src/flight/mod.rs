//! From a log to motors and body rates over time.
//!
//! ```text
//! px4        the topic of each quantity with most messages      ardupilot     a table for each ESC and each sensor
//! one_table  CSV and blackbox: all signals in one table         rows          rows in the sequence of time, without gaps
//! ```

mod ardupilot;
mod one_table;
mod px4;
mod rows;

use crate::electrical::ElectricalColumn;
use crate::signals::{CollectedSignals, SignalTable, collected};
use crate::table::{Findings, TableSignal};
use crate::table_text::names_of;
use crate::{ColumnNames, LogError, LogFormat};
use std::io::Read;

/// Largest number of motors in a log.
const MOTORS_MAX: usize = 16;

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

/// Electrical speeds of motors whose number of magnetic poles the log does not name. All have one unit, so their ratios are true.
#[derive(Clone, Debug, PartialEq)]
pub struct ElectricalSpeeds {
    /// The speeds, without their signs.
    pub motors: LoggedMotors,
    /// Their columns.
    pub columns: Vec<ElectricalColumn>,
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

/// Torque of a test stand on its motor.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedTorque {
    /// Times on the clock of the log, increasing.
    pub time_s: Vec<f64>,
    /// Torque, with the sign of the stand.
    pub torque_n_m: Vec<f64>,
}

/// Content of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoggedFlight {
    /// Measured speeds, rev/s.
    pub speeds_rev_s: Option<LoggedMotors>,
    /// Electrical speeds of a log that does not name the number of magnetic poles.
    pub electrical: Option<ElectricalSpeeds>,
    /// Commands, in any unit.
    pub commands: Option<LoggedMotors>,
    /// Body rates.
    pub rates: Option<LoggedRates>,
    /// Torque of a test stand.
    pub torque: Option<LoggedTorque>,
    /// Defects of the log.
    pub notes: Vec<String>,
}

impl LoggedFlight {
    /// The columns of electrical speeds that name no number of magnetic poles.
    pub fn electrical_columns(&self) -> &[ElectricalColumn] {
        self.electrical.as_ref().map_or(&[], |electrical| &electrical.columns)
    }
}

/// Reads motors and body rates from a log. Its first bytes tell its format.
///
/// - *PX4 ULog*: the speeds of `esc_status`, the commands of `actuator_motors` (or of the instance of `actuator_outputs` in which most channels
///   move), the rates of `vehicle_angular_velocity` (or of `sensor_combined`), x forward, y right, z down.
/// - *ArduPilot DataFlash*: the speeds of `ESC`, the commands of `RCOU`, the rates of `IMU`, with the same axes.
/// - *Betaflight blackbox*: `eRPM`, `motor` and `gyroADC` of the longest log in the file, x forward, y left, z up.
/// - *CSV*: what its headers tell, or the names that `names` gives to its columns; also the torque of a test stand.
///
/// Each table keeps its own times. A log that breaks off or is damaged is read as far as possible, with a note.
///
/// # Errors
/// Those of [`crate::log_summary`]; a log without signals about rotors.
pub fn flight_from_log(source: impl Read, names: &ColumnNames) -> Result<LoggedFlight, LogError> {
    let is_wanted = |table: &str, signal: &TableSignal| signal.role.is_some() || px4::is_helper(table, &signal.name);
    let CollectedSignals { signals: log, findings } = collected(source, names, is_wanted)?;
    let format = log.format;
    let is_text = matches!(format, LogFormat::Csv | LogFormat::RcBenchmark);
    if log.table_names.is_empty() && !is_text {
        return Err(LogError::WithoutData { format });
    }
    let mut flight = flight_of_tables(format, &log.tables, &findings);
    let has_speeds = flight.speeds_rev_s.is_some() || flight.electrical.is_some();
    if !has_speeds && flight.commands.is_none() && flight.rates.is_none() {
        return Err(match is_text {
            true => LogError::NoSignal { columns: names_of(&findings.headers) },
            false => LogError::WithoutSignal { format, tables: log.table_names.join(", ") },
        });
    }
    flight.notes = log.loss.in_words().into_iter().collect();
    Ok(flight)
}

/// Motors and body rates of the tables of a log.
pub(crate) fn flight_of_tables(format: LogFormat, tables: &[SignalTable], findings: &Findings) -> LoggedFlight {
    match format {
        LogFormat::Ulog => px4::flight(tables),
        LogFormat::DataFlash => ardupilot::flight(tables, &findings.motor_of_output),
        LogFormat::Blackbox => one_table::flight(tables, Some(RateAxes::ForwardLeftUp)),
        LogFormat::RcBenchmark | LogFormat::Csv => one_table::flight(tables, None),
    }
}
