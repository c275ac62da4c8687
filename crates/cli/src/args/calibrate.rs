//! Arguments of `calibrate`.

use super::groups::{HearingArguments, ToneArguments, time_s, typed_path, whole_number};
use clap::Args;
use hovertone_vehicle::ROTORS_MAX;
use std::path::PathBuf;

const CALIBRATE_EXAMPLES: &str = "\
Record one rotor on a bench while a tachometer shows its speed: this checks the order of the tone and the recorder's \
clock. Or record a tone of known frequency: this checks the clock alone, by the strongest line within 2.5 % of that \
frequency, or within --band.

The clock passes if the whole interval, error ± uncertainty, lies within --clock-ppm. It fails if no part of it does. Otherwise \
it is not decided. A tachometer that shows whole revolutions per minute leaves ±80 millionths at 7200 rpm (k = 2): this \
decides the order, but a clock only if --clock-ppm is above 80.

Examples:
  hovertone calibrate --vehicle crazyflie --rotors 1 --tachometer-rpm 20850 bench.wav
  hovertone calibrate --true-hz 1000 tone.wav";

/// Checks the recorder's clock and the order of the tone against one known speed: pass, fail or not decided, with the correction
///
/// Hears the rotor as `hovertone speed` does, and compares the result with the known speed. If the check does not pass, the exit code is 3.
#[derive(Args, Debug)]
#[command(after_help = CALIBRATE_EXAMPLES)]
pub(crate) struct CalibrateArguments {
    /// Recording: a video or audio file; - is stdin
    #[arg(value_name = "RECORDING", value_parser = typed_path())]
    pub(crate) file: PathBuf,
    /// Speed of the rotor's shaft, as a tachometer shows it
    #[arg(
        long,
        value_name = "RPM",
        required_unless_present = "true_hz",
        conflicts_with = "true_hz",
        help_heading = "The known speed"
    )]
    pub(crate) tachometer_rpm: Option<String>,
    /// Frequency of the tone: of a signal generator; or of the rotor's tone, with --blades, --gear, --order or --vehicle
    #[arg(long, value_name = "HZ", help_heading = "The known speed")]
    pub(crate) true_hz: Option<f64>,
    /// Standard uncertainty of the known speed, in millionths [default: by the last digit of --tachometer-rpm; 0 for --true-hz]
    #[arg(long, value_name = "PPM", help_heading = "The known speed")]
    pub(crate) known_std_ppm: Option<f64>,
    #[command(flatten)]
    pub(crate) tone: ToneArguments,
    /// Number of rotors that turn: 1, since the known speed is that of one rotor
    #[arg(long, value_name = "N", value_parser = whole_number(1u32..=ROTORS_MAX), help_heading = "Which tone")]
    pub(crate) rotors: Option<u32>,
    /// Largest allowed error of the recorder's clock, in millionths
    #[arg(long, value_name = "PPM", default_value_t = 50.0, help_heading = "How it is analysed")]
    pub(crate) clock_ppm: f64,
    /// Use the recording from this time on, in seconds or as 1:02.5, and leave out nothing after it
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = time_s, help_heading = "How it is analysed")]
    pub(crate) from: Option<f64>,
    /// Use the recording up to this time, and leave out nothing before it
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = time_s, help_heading = "How it is analysed")]
    pub(crate) to: Option<f64>,
    #[command(flatten)]
    pub(crate) hearing: HearingArguments,
    /// Print one JSON object
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
}
