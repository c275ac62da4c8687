//! Logs with known content, written here, and real ones; whole, cut and damaged.

// The lints know tests by their attribute, and what tests share has none.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout)]

mod blackbox;
mod control;
mod csv_names;
mod damage;
mod dataflash;
mod listing;
mod oracles;
mod real;
mod ulog;
mod writers;

use hovertone_logs::{ColumnNames, LogError, LogSignals, LoggedFlight, flight_from_log, signals_from_log};

pub(crate) fn flight_of(bytes: &[u8]) -> Result<LoggedFlight, LogError> {
    flight_from_log(bytes, &ColumnNames::default())
}

/// All signals of a log.
pub(crate) fn signals_of(bytes: &[u8]) -> LogSignals {
    signals_from_log(bytes, &ColumnNames::default(), |_, _| true).unwrap()
}
