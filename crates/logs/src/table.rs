//! Tables of a log: signals that share their times, and the rows that a reader hands over one by one.

use crate::LogError;
use crate::loss::Loss;
use std::collections::BTreeMap;

/// Largest number of signals in a log. The largest logs of PX4 have a tenth of it; more are damage.
pub(crate) const SIGNALS_MAX: usize = 1 << 16;

/// What a signal tells about the rotors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalRole {
    /// Shaft speed of a rotor, in rev/s; its number in the log.
    RotorSpeed(u32),
    /// Electrical speed of a motor, in the unit of the log; its number in the log. The log does not name the motor's number of magnetic poles.
    ElectricalSpeed(u32),
    /// Command of a motor, in any unit; its number in the log.
    Command(u32),
    /// Body rate about x, y or z (0, 1, 2), in rad/s.
    BodyRate(usize),
    /// Torque of a test stand on its motor, in N m.
    Torque,
}

/// A signal of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct TableSignal {
    /// Its name in the log.
    pub name: String,
    /// Unit of its values, where the log or its name tells one: "rev/s", "rad/s", "V".
    pub unit: String,
    /// What it tells about the rotors.
    pub role: Option<SignalRole>,
}

impl TableSignal {
    pub(crate) fn plain(name: String) -> Self {
        Self { name, unit: String::new(), role: None }
    }

    /// A signal whose values are in the unit that its role needs.
    pub(crate) fn with_role(name: String, role: SignalRole) -> Self {
        let unit = match role {
            SignalRole::RotorSpeed(_) => "rev/s",
            SignalRole::ElectricalSpeed(_) | SignalRole::Command(_) => "",
            SignalRole::BodyRate(_) => "rad/s",
            SignalRole::Torque => "N m",
        };
        Self { name, unit: unit.to_owned(), role: Some(role) }
    }
}

/// A row of a table. Numbers are decoded when they are asked for, so that a reader of few signals is fast.
pub(crate) trait RowValues {
    /// The value of a signal; NaN is a gap.
    fn value(&self, signal: usize) -> f64;
}

/// What is done with a log while it is read.
pub(crate) trait RowSink {
    /// A table; the first has number 0.
    fn table(&mut self, name: String, signals: Vec<TableSignal>);

    /// A row of a table.
    ///
    /// # Errors
    /// Those of the sink's own work.
    fn row(&mut self, table: usize, time_s: f64, values: &impl RowValues) -> Result<(), LogError>;
}

/// What a reader found beside the rows.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    pub(crate) loss: Loss,
    /// From the number of an output, counted from 0, to the number of its motor, counted from 1, where the log tells it.
    pub(crate) motor_of_output: BTreeMap<u32, u32>,
    /// Headers of the columns of a CSV.
    pub(crate) headers: Vec<String>,
}
