//! Arguments of `log`.

use super::groups::{ReplaceArguments, typed_path};
use clap::Args;
use std::path::PathBuf;

const LOG_EXAMPLES: &str = "\
A log may come from PX4 (.ulg), ArduPilot (.bin), Betaflight or INAV (.bbl, .bfl), or RCbenchmark (.csv). It may also be any CSV whose \
headers name the time and the quantities with their units, as in time_s, rotor1_rpm, motor1_pwm, gyro_x_rad_s. From a damaged log, \
hovertone reads the undamaged parts. Speeds are printed in rev/s (turns per second).

Examples:
  hovertone log flight.ulg
  hovertone log flight.csv --signals
  hovertone log flight.ulg --signal esc_status -o speeds.csv
  hovertone log bench.csv --column Zeit=time_ms --column Drehzahl=rotor1_rpm
  hovertone log --json *.ulg | jq '.tables[].name'";

/// Contents of a log of a flight or a thrust stand: its signals, their rates and times
#[derive(Args, Debug)]
#[command(after_help = LOG_EXAMPLES)]
pub(crate) struct LogArguments {
    /// Logs; - is stdin
    #[arg(required = true, value_name = "FILE", value_parser = typed_path())]
    pub(crate) files: Vec<PathBuf>,
    /// Read the column HEADER of a CSV as if its header were NAME; can be given several times
    #[arg(long, value_name = "HEADER=NAME", value_parser = column_name)]
    pub(crate) column: Vec<ColumnName>,
    /// Also list the names of all signals
    #[arg(long, help_heading = "Output", conflicts_with_all = ["json", "signal"])]
    pub(crate) signals: bool,
    /// Write this signal as CSV, or all signals of this table; can be given several times for signals of one table
    #[arg(long, value_name = "NAME", requires = "output", conflicts_with = "json", help_heading = "Output")]
    pub(crate) signal: Vec<String>,
    /// Name of the CSV that --signal writes
    #[arg(short, long, value_name = "FILE.csv", requires = "signal", value_parser = typed_path(), help_heading = "Output")]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
    /// Print one line of JSON for each file, in their order
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
}

/// A header, and the name that it is read as.
#[derive(Clone, Debug)]
pub(crate) struct ColumnName {
    pub(crate) header: String,
    pub(crate) name: String,
}

pub(super) fn column_name(typed: &str) -> Result<ColumnName, String> {
    // a header may have the sign, a name has none
    match typed.rsplit_once('=') {
        Some((header, name)) if !header.trim().is_empty() => {
            Ok(ColumnName { header: header.to_owned(), name: name.trim().to_owned() })
        }
        _ => Err("write the header of the column, then =, then a name that hovertone knows, as in Drehzahl=rotor1_rpm"
            .to_owned()),
    }
}
