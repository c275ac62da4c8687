//! Logs of flights and of thrust stands: PX4's ULog, ArduPilot's DataFlash, Betaflight's blackbox, RCbenchmark's CSV, and any CSV with a header.
//!
//! ```text
//!              ┌ ulog ───────┐
//! bytes ─ log ─┼ dataflash ──┤  rows of tables  ┌ summary  each table with its signals, rate and span; memory does not grow
//!  (streamed)  ├ blackbox ───┼─────────────────▶┼ signals  the chosen signals over time
//!              └ table_text ─┘                  ├ flight   motors and body rates
//!                                               └ control  commands, angles and rates of the embedded controller
//! ```
//!
//! A log is read once, from its beginning. A log that breaks off or is damaged gives what it holds, and [`Loss`] says what is missing and where.

mod blackbox;
mod byte_window;
mod control;
mod dataflash;
mod electrical;
mod error;
mod flight;
mod format;
mod log;
mod loss;
mod no_table;
mod packed;
mod signals;
mod summary;
mod table;
mod table_text;
mod thousands;
mod time_line;
mod ulog;

pub use control::{ControlLoop, LoggedControl, MissingControl, control_from_log};
pub use electrical::ElectricalColumn;
pub use error::{LogError, NamedColumn};
pub use flight::{ElectricalSpeeds, LoggedFlight, LoggedMotors, LoggedRates, RateAxes, flight_from_log};
pub use format::LogFormat;
pub use loss::{Loss, LostPlace};
pub use no_table::NoTable;
pub use signals::{LogSignals, SignalRow, SignalTable, signal_rows, signals_from_log};
pub use summary::{LogSummary, SignalSummary, TableSummary, ValueRange, log_summary};
pub use table::{SignalRole, TableSignal};
pub use table_text::{ColumnNames, CsvCells};
pub use thousands::has_thousands_point;
