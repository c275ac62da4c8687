//! The formats of logs.

use std::fmt;

/// Format of a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogFormat {
    /// Of PX4, `.ulg`.
    Ulog,
    /// Of ArduPilot, `.bin`.
    DataFlash,
    /// Of Betaflight and INAV, `.bbl` or `.bfl`.
    Blackbox,
    /// CSV of an RCbenchmark thrust stand.
    RcBenchmark,
    /// Other CSV.
    Csv,
}

impl fmt::Display for LogFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ulog => "PX4 ULog",
            Self::DataFlash => "ArduPilot DataFlash log",
            Self::Blackbox => "Betaflight blackbox log",
            Self::RcBenchmark => "RCbenchmark CSV",
            Self::Csv => "CSV",
        })
    }
}
