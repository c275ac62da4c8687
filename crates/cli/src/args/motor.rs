//! Arguments of `motor`.

use super::groups::{HearingArguments, KnownArguments, ReplaceArguments, ToneArguments, time_s, typed_path};
use super::labels::clock_offset_s;
use super::log::{ColumnName, column_name};
use clap::Args;
use std::path::PathBuf;

const MOTOR_EXAMPLES: &str = "\
A file is a log of PX4 (.ulg), ArduPilot (.bin), Betaflight or INAV (.bbl, .bfl) or RCbenchmark (.csv), any CSV with the speeds of the \
rotors, or a recording of a bench. A step is a change from one steady speed to another; in a recording, each speed must be held for about \
a second. If the commands are known, from the same log or from --commands, the gain is found too. The dead time is found only if commands \
and speeds have the same clock.

Examples:
  hovertone motor steps.csv
  hovertone motor steps.csv --figure steps.svg
  hovertone motor steps.csv --json | jq '.time_constant_up_s.value'
  hovertone motor bench.csv --column Zeit=time_ms --column Drehzahl=rotor1_rpm
  hovertone motor bench.wav --blades 2
  hovertone motor bench.wav --blades 2 --commands commands.csv --offset 0";

/// Time constants, dead time and gain of the motors, from steps in a log or in the sound of a bench
#[derive(Args, Debug)]
#[command(after_help = MOTOR_EXAMPLES)]
pub(crate) struct MotorArguments {
    /// Logs or recordings; - is a log from stdin
    #[arg(required = true, value_name = "FILE", value_parser = typed_path())]
    pub(crate) files: Vec<PathBuf>,
    /// Read the column HEADER of a CSV as if its header were NAME; can be given several times
    #[arg(long, value_name = "HEADER=NAME", value_parser = column_name)]
    pub(crate) column: Vec<ColumnName>,
    /// Log with the commands of the motors that are recorded
    #[arg(long, value_name = "LOG", value_parser = typed_path())]
    pub(crate) commands: Option<PathBuf>,
    /// Time to add to the clock of the commands to get that of the recording, in s [default: found from the steps; then the dead time is
    /// not]
    #[arg(long, value_name = "S", requires = "commands", allow_hyphen_values = true, value_parser = clock_offset_s)]
    pub(crate) offset: Option<f64>,
    #[command(flatten)]
    pub(crate) tone: ToneArguments,
    #[command(flatten)]
    pub(crate) known: KnownArguments,
    /// Hear the recording from this time on, in seconds or as 1:02.5
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = time_s, help_heading = "How it is analysed")]
    pub(crate) from: Option<f64>,
    /// Hear the recording up to this time
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = time_s, help_heading = "How it is analysed")]
    pub(crate) to: Option<f64>,
    #[command(flatten)]
    pub(crate) hearing: HearingArguments,
    /// Print one line of JSON for each file, in their order
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
    /// Draw the steps of one file, with their curves
    #[arg(long, value_name = "FILE.svg|png", value_parser = typed_path(), help_heading = "Output")]
    pub(crate) figure: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
}
