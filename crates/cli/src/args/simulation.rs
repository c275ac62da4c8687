//! Arguments of the commands that simulate a flight: demo and simulate.

use super::groups::{ReplaceArguments, typed_path};
use clap::Args;
use std::path::PathBuf;

const DEMO_EXAMPLES: &str = "\
The same seed gives the same files and the same numbers on the same machine.

Examples:
  hovertone demo
  hovertone demo -o other-flights --seed 7";

/// The paper's experiment in simulated flight: three loads with five trials each, heard and identified
///
/// An AR.Drone hovers in the laboratory of the paper's figure 1. The demo writes the recordings, the experiment file, and the truth about
/// every
/// rotor. It identifies the recordings, prints the paper's two tables beside the paper's own numbers and the truth, and writes report.html.
#[derive(Args, Debug)]
#[command(after_help = DEMO_EXAMPLES)]
pub(crate) struct DemoArguments {
    /// Where to write: a folder that is empty, new, or of an earlier demo
    #[arg(short, long, value_name = "DIR", default_value = "demo", value_parser = typed_path())]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
    /// Show the low-level model instead: fly doublets, hear them, identify eqs 1 and 2, and fly the identified model beside the true one
    #[arg(long)]
    pub(crate) low_level: bool,
    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Show no progress bar; there is none anyway if stderr is no terminal
    #[arg(long)]
    pub(crate) no_progress: bool,
}

const SIMULATE_EXAMPLES: &str = "\
A scenario file; each key may be left out (docs/formats.md lists all):
  duration_s = 20.0
  seed = 7

  [vehicle]
  preset = \"ardrone\"          # ardrone, ardrone2, crazyflie, f450
  mass_kg = 0.413

  [[payload]]
  mass_kg = 0.031
  position_m = [0.0, 0.0, -0.01]

  [room]                      # the laboratory of the paper's figure 1; without it, a free field
  [people]                    # talking outside
  [ambient]

  [[microphone]]              # one channel each
  position_m = [-3.5, 1.0, 2.0]

  [[maneuver]]                # hover, step, doublet, climb, square, fly_to, take_off, land, csv
  kind = \"hover\"
  duration_s = 5.0

  [[maneuver]]
  kind = \"doublet\"
  axis = \"roll\"
  amount = 0.3
  half_s = 0.5

Examples:
  hovertone simulate examples/ardrone-hover.toml -o hover
  hovertone speed --vehicle ardrone hover/sound.wav";

/// A flight from a scenario file: its sound as microphones hear it, and the truth
///
/// Writes sound.wav (one channel for each microphone), truth.csv (commands, voltages, speeds, forces, place and attitude
/// over time) and truth.json (exact means over the hovers, and all settings).
#[derive(Args, Debug)]
#[command(after_help = SIMULATE_EXAMPLES)]
pub(crate) struct SimulateArguments {
    /// The flight and the microphones
    #[arg(value_name = "SCENARIO.toml", value_parser = typed_path())]
    pub(crate) scenario: PathBuf,
    /// Where to write: a folder that is empty, new, or of an earlier run of this scenario
    #[arg(short, long, value_name = "DIR", default_value = "simulation", value_parser = typed_path())]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
    /// Seed of all random numbers [default: the scenario's]
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// Show no progress bar; there is none anyway if stderr is no terminal
    #[arg(long)]
    pub(crate) no_progress: bool,
}
