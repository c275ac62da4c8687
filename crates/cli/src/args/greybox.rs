//! Arguments of `greybox`.

use super::groups::{HearingArguments, ReplaceArguments, typed_path};
use super::labels::{BodyAxes, clock_offset_s};
use super::log::{ColumnName, column_name};
use super::units::mass_kg;
use clap::Args;
use std::path::PathBuf;

const GREYBOX_EXAMPLES: &str = "\
The log may come from PX4 (ULog), ArduPilot (DataFlash), or Betaflight or INAV (blackbox). It may also be a CSV with the headers time_s; \
command_roll, command_pitch, command_yaw_rate, command_climb (from −1 to 1); roll_deg, pitch_deg, yaw_rate_rad_s, velocity_z_m_s. With \
roll_rate_rad_s and pitch_rate_rad_s the result is better. With speed_1_rad_s to speed_4_rad_s no recording is needed. For a minute, fly \
doublets (a command to one side, then to the other), short and long, in roll, pitch, yaw and climb.

Examples:
  hovertone greybox doublets.wav doublets.csv --vehicle ardrone
  hovertone greybox doublets.csv --vehicle ardrone --scenario identified.toml
  hovertone greybox doublets.wav doublets.csv --vehicle ardrone --check other.wav other.csv";

/// Model of motors and controllers: gains (eq 1), time constant (eq 2) and C_τ, from the sound and the log of a flight of doublets
///
/// Fits eqs 1 and 2 of the paper to the speeds of the rotors. The speeds are heard, guided by the predictions of the model, or logged.
#[derive(Args, Debug)]
#[command(after_help = GREYBOX_EXAMPLES)]
pub(crate) struct GreyBoxArguments {
    /// The recording and the log of the flight; or the log alone, with the speeds of the rotors
    #[arg(required = true, num_args = 1..=2, value_names = ["RECORDING", "LOG"], value_parser = typed_path())]
    pub(crate) files: Vec<PathBuf>,
    /// Vehicle whose numbers the fit starts from: one of the flight model (see `hovertone simulate --help`)
    #[arg(long, value_name = "NAME")]
    pub(crate) vehicle: String,
    /// Mass as flown, in kg or as 413g [default: the vehicle's]
    #[arg(long, value_name = "KG", value_parser = mass_kg)]
    pub(crate) mass_kg: Option<f64>,
    /// Time to add to the log's clock to get that of the recording, in s; an error of up to 10 s is found from the sound [default: 0]
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = clock_offset_s)]
    pub(crate) log_offset_s: Option<f64>,
    /// Axes of the log: flu (x forward, y left, z up) or frd (y right, z down) [default: flu]
    #[arg(long, value_name = "AXES")]
    pub(crate) log_axes: Option<BodyAxes>,
    /// Read the column HEADER of a CSV as if its header were NAME; can be given several times
    #[arg(long, value_name = "HEADER=NAME", value_parser = column_name)]
    pub(crate) column: Vec<ColumnName>,
    /// Another flight, not used for the fit: its heard or logged speeds are compared with the predicted ones
    #[arg(long, num_args = 1..=2, value_names = ["RECORDING", "LOG"], value_parser = typed_path())]
    pub(crate) check: Vec<PathBuf>,
    /// Print one JSON object
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
    /// Write the identified vehicle as a scenario that `hovertone simulate` flies
    #[arg(long, value_name = "FILE.toml", value_parser = typed_path(), help_heading = "Output")]
    pub(crate) scenario: Option<PathBuf>,
    /// Draw predicted and observed speeds: of the flight of --check, or without it of the fitted flight
    #[arg(long, value_name = "FILE.svg|png", value_parser = typed_path(), help_heading = "Output")]
    pub(crate) figure: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) hearing: HearingArguments,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
}
