//! Arguments of `tones`.

use super::groups::{HearingArguments, KnownArguments, time_s, typed_path, whole_number};
use clap::Args;
use hovertone_vehicle::BLADE_COUNT_MAX;
use std::path::PathBuf;

const TONES_EXAMPLES: &str = "\
The tone of the blades alone does not show how many blades there are. Faint tones of the shaft show it, and so does the tone of a known \
gear. Diameter, mass and number of rotors rule out speeds that cannot carry the vehicle.

Examples:
  hovertone tones hover.mp4
  hovertone tones --blades 2 hover.mp4
  hovertone tones --vehicle iris hover.mp4
  hovertone tones --diameter-m 0.254 --mass-kg 1.2 --rotors 4 hover.mp4
  hovertone tones --json *.wav | jq '.families[0].readings[0]'";

/// Tones in recordings, and the shaft speed that each possible meaning of the rotor's tone gives
///
/// Lists every tone: its harmonics (multiples of its frequency), their level over the noise, and when it is heard. For the tone of the
/// rotor, it lists all possible meanings: blades, gear, speed, and how plausible each is.
#[derive(Args, Debug)]
#[command(after_help = TONES_EXAMPLES)]
pub(crate) struct TonesArguments {
    /// Recordings: video or audio files; - is stdin
    #[arg(required = true, value_name = "FILE", value_parser = typed_path())]
    pub(crate) files: Vec<PathBuf>,
    /// Blades of each propeller: it rules out all other numbers of blades
    #[arg(long, value_name = "N", value_parser = whole_number(1u32..=BLADE_COUNT_MAX), help_heading = "Known facts about the vehicle")]
    pub(crate) blades: Option<u32>,
    #[command(flatten)]
    pub(crate) known: KnownArguments,
    /// Name of a known vehicle: its numbers rule out speeds (see `hovertone vehicles`)
    #[arg(long, value_name = "NAME", help_heading = "Known facts about the vehicle")]
    pub(crate) vehicle: Option<String>,
    /// Listen from this time on, in seconds or as 1:02.5
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = time_s, help_heading = "How it is analysed")]
    pub(crate) from: Option<f64>,
    /// Listen up to this time
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = time_s, help_heading = "How it is analysed")]
    pub(crate) to: Option<f64>,
    #[command(flatten)]
    pub(crate) hearing: HearingArguments,
    /// Print one line of JSON for each file, in their order
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
}
