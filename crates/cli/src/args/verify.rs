//! Arguments of `verify`.

use super::groups::{AnalysisArguments, HearingArguments, KnownArguments, ReplaceArguments, ToneArguments, typed_path};
use super::labels::offsets;
use super::log::{ColumnName, column_name};
use clap::Args;
use std::path::PathBuf;

const VERIFY_EXAMPLES: &str = "\
The log needs speeds of the motors: PX4 (.ulg), ArduPilot (.bin), Betaflight and INAV (.bbl, .bfl), or CSV. The \
clocks are aligned by the changes of the speeds.

Examples:
  hovertone verify hover.mp4 flight.ulg --vehicle iris
  hovertone verify hover.mp4 flight.csv --vehicle ardrone --json
  hovertone verify hover.mp4 flight.csv --vehicle ardrone --figure check.svg
  hovertone verify hover.mp4 flight.csv --vehicle ardrone --log-offset-s -5:5";

/// Compares heard speeds with the logged ones: whether the order of the tone and the clock are right, and whether the ± holds
#[derive(Args, Debug)]
#[command(after_help = VERIFY_EXAMPLES)]
pub(crate) struct VerifyArguments {
    /// Recording: video or audio file
    #[arg(value_name = "RECORDING", value_parser = typed_path())]
    pub(crate) recording: PathBuf,
    /// Log of the same flight
    #[arg(value_name = "LOG", value_parser = typed_path())]
    pub(crate) log: PathBuf,
    /// Read the column HEADER of a CSV as if its header were NAME; can be given several times
    #[arg(long, value_name = "HEADER=NAME", value_parser = column_name)]
    pub(crate) column: Vec<ColumnName>,
    /// Limits of the offset: the time to add to the log's clock to get that of the recording, -5:5 in seconds or -0:05..0:05 [default:
    /// none]
    #[arg(long, value_name = "LOW:HIGH", value_parser = offsets, allow_hyphen_values = true)]
    pub(crate) log_offset_s: Option<(f64, f64)>,
    #[command(flatten)]
    pub(crate) tone: ToneArguments,
    #[command(flatten)]
    pub(crate) known: KnownArguments,
    #[command(flatten)]
    pub(crate) analysis: AnalysisArguments,
    #[command(flatten)]
    pub(crate) hearing: HearingArguments,
    /// Print one JSON object
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
    /// Draw heard and logged speeds over each other, and their difference with its ± below
    #[arg(long, value_name = "FILE.svg|png", value_parser = typed_path(), help_heading = "Output")]
    pub(crate) figure: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
}
