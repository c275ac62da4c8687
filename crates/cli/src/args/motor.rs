//! Arguments of `motor`.

use super::groups::{ReplaceArguments, typed_path};
use super::log::{ColumnName, column_name};
use clap::Args;
use std::path::PathBuf;

const MOTOR_EXAMPLES: &str = "\
A log of PX4 (.ulg), ArduPilot (.bin), Betaflight and INAV (.bbl, .bfl), RCbenchmark's CSV, or any CSV with
the speeds of the rotors; commands in the same log add dead time and gain. A step is one change of the speed
between two levels that are held. Log rows every 20 ms or faster tell the time constant of any motor.

Examples:
  hovertone motor steps.csv
  hovertone motor steps.csv --figure steps.svg
  hovertone motor steps.csv --json | jq '.time_constant_up_s.value'
  hovertone motor bench.csv --column Zeit=time_ms --column Drehzahl=rotor1_rpm";

/// Time constants, dead time and gain of the motors, from steps in a log
#[derive(Args, Debug)]
#[command(after_help = MOTOR_EXAMPLES)]
pub(crate) struct MotorArguments {
    /// Logs; - is stdin
    #[arg(required = true, value_name = "LOG", value_parser = typed_path())]
    pub(crate) files: Vec<PathBuf>,
    /// Read the column HEADER of a CSV as if its header were NAME; can be given several times
    #[arg(long, value_name = "HEADER=NAME", value_parser = column_name)]
    pub(crate) column: Vec<ColumnName>,
    /// Print one JSON object per line and log, in the order given
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
    /// Draw the steps of one log, with their curves
    #[arg(long, value_name = "FILE.svg|png", value_parser = typed_path(), help_heading = "Output")]
    pub(crate) figure: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
}
