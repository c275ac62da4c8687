//! Arguments of `speed`.

use super::groups::{AnalysisArguments, HearingArguments, KnownArguments, ReplaceArguments, ToneArguments, typed_path};
use super::labels::LabelArguments;
use clap::Args;
use std::path::PathBuf;

const SPEED_EXAMPLES: &str = "\
hovertone follows the tone of --order; without --order, the tone of the gear (--gear); without a gear, the tone of the blades (--blades). \
A known --vehicle gives its gear and its blades. Without any of these flags, hovertone searches for the tone. Where the number of blades \
stays unclear, all possible speeds are shown, and the exit code is 3.

Examples:
  hovertone speed --blades 2 hover.mp4
  hovertone speed hover.mp4
  hovertone speed --gear 8:69 --blades 2 ardrone/*.mov
  hovertone speed --blades 2 --from 14 --to 17 --track track.csv bench.wav
  hovertone speed --vehicle ardrone --log flight.csv --log-axes frd hover.mov   names of rotors
  hovertone speed --vehicle ardrone --microphones stands.toml hover.wav         by microphones
  hovertone speed --vehicle ardrone --spin-up front-left,rear-right,rear-left,front-right bench.wav
  hovertone speed --vehicle crazyflie --json *.wav | jq .speed_rpm";

/// Rotor speed in recordings: mean, uncertainty, and spread over time
///
/// Any video or audio file will do. hovertone leaves out silence, handling noise, take-off and landing, and says on stderr what it left
/// out.
/// With --from or --to, it leaves out nothing between these times.
#[derive(Args, Debug)]
#[command(after_help = SPEED_EXAMPLES)]
pub(crate) struct SpeedArguments {
    /// Recordings: video or audio files; - is stdin
    #[arg(required = true, value_name = "FILE", value_parser = typed_path())]
    pub(crate) files: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) tone: ToneArguments,
    #[command(flatten)]
    pub(crate) known: KnownArguments,
    #[command(flatten)]
    pub(crate) labels: LabelArguments,
    #[command(flatten)]
    pub(crate) analysis: AnalysisArguments,
    #[command(flatten)]
    pub(crate) hearing: HearingArguments,
    /// Print one line of JSON for each file, in their order
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
    /// Write the speed of every frame as CSV; with several recordings, the first column names the file
    #[arg(long, value_name = "FILE.csv", help_heading = "Output", value_parser = typed_path())]
    pub(crate) track: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
}
