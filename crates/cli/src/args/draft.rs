//! Arguments that describe an experiment in place of its file: of `init` and `identify`.

use super::groups::{band, gear, whole_number};
use super::thrust::PlaceArguments;
use super::units::length_m;
use clap::Args;
use hovertone_vehicle::{BLADE_COUNT_MAX, Gear, ROTORS_MAX};

/// How to type loads, for the help of both commands.
pub(crate) const MASS_HELP: &str = "\
--mass names one load: its mass as flown, and its recordings. These three mean the same:
  --mass '0.413=no_hull/*.mov'    hovertone finds the files of the pattern
  --mass 0.413 no_hull/*.mov      the shell finds them; all files up to the next flag belong to the load
  --mass 413g=a.mov --mass 413g=b.mov
A folder stands for the recordings in it: --mass 413g=no_hull.
In zsh and fish, the pattern of the first form needs its quotes; in bash it works without them.";

#[derive(Args, Debug)]
#[command(next_help_heading = "Without an experiment file")]
pub(crate) struct DraftArguments {
    /// A load: its mass as flown, in kg or as 413g, and its recordings. Give this flag once for each load
    #[arg(long, value_name = "KG=FILES", num_args = 1..)]
    pub(crate) mass: Vec<String>,
    /// A known vehicle (see `hovertone vehicles`)
    #[arg(long, value_name = "NAME")]
    pub(crate) vehicle: Option<String>,
    /// Blades of each propeller
    #[arg(long, value_name = "N", value_parser = whole_number(1u32..=BLADE_COUNT_MAX))]
    pub(crate) blades: Option<u32>,
    /// Teeth of the motor's pinion and of the rotor's wheel, or of the wheel alone
    #[arg(long, value_name = "P:W", value_parser = gear)]
    pub(crate) gear: Option<Gear>,
    /// Number of rotors that carry the vehicle [default: the vehicle's]
    #[arg(long, value_name = "N", value_parser = whole_number(1u32..=ROTORS_MAX))]
    pub(crate) rotors: Option<u32>,
    /// Diameter of a propeller, from tip to tip, in m or as 24cm or 8in: with it, hovertone can rule out half and double the true speed [default: the
    /// vehicle's]
    #[arg(long, value_name = "M", value_parser = length_m)]
    pub(crate) diameter_m: Option<f64>,
    /// Band in which the tone lies, in Hz [default: found in the sound]
    #[arg(long, value_name = "LOW:HIGH", value_parser = band)]
    pub(crate) band: Option<(f64, f64)>,
    /// Number of harmonics (multiples of the tone) to follow; the tone itself is the first [default: 3]
    #[arg(long, value_name = "N", value_parser = whole_number(1u32..=20))]
    pub(crate) harmonics: Option<u32>,
    #[command(flatten)]
    pub(crate) place: PlaceArguments,
}

impl DraftArguments {
    /// Names of all arguments that `identify` refuses beside an experiment file.
    pub(crate) const NAMES: [&str; 11] = [
        "mass",
        "vehicle",
        "blades",
        "gear",
        "rotors",
        "diameter_m",
        "band",
        "harmonics",
        "gravity_m_s2",
        "latitude_deg",
        "height_m",
    ];
}
