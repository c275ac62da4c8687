//! Arguments of `vehicles`.

use super::groups::typed_path;
use clap::Args;
use std::path::PathBuf;

const VEHICLES_EXAMPLES: &str = "\
A file with a vehicle of your own; only rotors is needed:
  [my-drone]
  name = \"My drone\"
  rotors = 4
  blades = 2                    # or, with a gear: gear = { pinion = 8, wheel = 69 }
  propeller_diameter_m = 0.127  # from tip to tip
  mass_kg = 0.250               # with battery
  shaft_speed_rev_s = [60.0, 400.0]
  source = \"measured by me\"

--add copies it into hovertone/vehicles.toml in $XDG_CONFIG_HOME, or in ~/.config. Then its name is --vehicle my-drone \
on the command line, and preset = \"my-drone\" in an experiment file.

Examples:
  hovertone vehicles
  hovertone vehicles ardrone
  hovertone vehicles --add my-drone.toml";

/// The vehicles that hovertone knows, with the source of every number; and your own
#[derive(Args, Debug)]
#[command(after_help = VEHICLES_EXAMPLES)]
pub(crate) struct VehiclesArguments {
    /// Show these vehicles alone
    #[arg(value_name = "NAME", conflicts_with = "add")]
    pub(crate) names: Vec<String>,
    /// Add the vehicles of this file to your own; - is stdin
    #[arg(long, value_name = "FILE.toml", conflicts_with = "json", value_parser = typed_path())]
    pub(crate) add: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}
