//! What was typed. What it means is found out by each command's `resolve`.

use crate::label_args::LabelArguments;
use crate::spectrogram_args::SpectrogramArguments;
use crate::thrust_args::{CompareArguments, ExportArguments, FitArguments, IdentifyArguments, WeighArguments};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand};
use hovertone::speed::Method;
use hovertone_vehicle::Gear;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  hovertone demo                              the paper's experiment, in simulated flight
  hovertone speed --blades 2 hover.mp4        rotor speed of a recording
  hovertone speed --vehicle ardrone *.wav     of many, heard as a known vehicle
  hovertone tones hover.mp4                   which tones it holds, and what each can mean
  hovertone spectrogram hover.mp4 -o x.png    the picture, with bands and ridge over it
  hovertone identify experiment.toml -o out   the thrust constant from hovers with known masses
  hovertone fit stand.csv                     the same fit on a thrust stand's table
  hovertone fit --plan --mass-kg 0.413        how much flying a wanted uncertainty needs
  hovertone weigh loaded.mov --constant out/results.json   what it lifts, by its sound
  hovertone export out/results.json --to gazebo            lines for a simulator
  hovertone compare out/results.json iris.sdf              a simulator's model against what was heard
  hovertone simulate scenario.toml -o out     a flight, its sound, and the truth about both
  hovertone vehicles                          the vehicles it knows, with sources

Exit codes:
  0  done
  1  a file could not be read or written
  2  wrong use
  3  done, but something is missing: no rotor tone, one whose order is open, a file that ends early

Data goes to stdout and to files, everything else to stderr.";

/// hovertone hears a multirotor hover and tells its rotor speeds and its thrust constant
#[derive(Debug, Parser)]
#[command(name = "hovertone", version, after_help = EXAMPLES, max_term_width = 100)]
#[command(long_about = "hovertone hears a multirotor hover and tells its rotor speeds and its thrust constant.

From ordinary video or audio of hovering flights with known masses it finds the rotor tones, turns them into rotor \
speeds, and identifies C_f in F = C_f ω², with its uncertainty.")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Speed(Box<SpeedArguments>),
    Tones(Box<TonesArguments>),
    Spectrogram(Box<SpectrogramArguments>),
    Identify(IdentifyArguments),
    Fit(Box<FitArguments>),
    Weigh(Box<WeighArguments>),
    Export(ExportArguments),
    Compare(CompareArguments),
    Demo(DemoArguments),
    Simulate(SimulateArguments),
    Vehicles(VehiclesArguments),
}

const SPEED_EXAMPLES: &str = "\
Which tone is heard: --order wins, then --gear, then --blades, then --vehicle. Without any of them
the tone is found by itself; where its blades cannot be heard, all readings are shown (exit code 3).

Examples:
  hovertone speed --blades 2 hover.mp4
  hovertone speed hover.mp4
  hovertone speed --gear 8:69 --blades 2 ardrone/*.mov
  hovertone speed --blades 2 --from 14 --to 17 --track track.csv bench.wav
  hovertone speed --vehicle ardrone --log flight.csv --log-axes frd hover.mov    which rotor is which
  hovertone speed --vehicle ardrone --microphones stands.toml hover.wav          the same, by the channels' microphones
  hovertone speed --vehicle ardrone --spin-up front-left,rear-right,rear-left,front-right bench.wav
  hovertone speed --vehicle crazyflie --json *.wav | jq .speed_rpm";

/// Rotor speed of recordings: mean, uncertainty and spread
///
/// Any video or audio file will do. Silence, handling noise, take-off and landing are cut away by themselves, and what
/// was cut is said on stderr; --from and --to overrule that.
#[derive(Args, Debug)]
#[command(after_help = SPEED_EXAMPLES)]
pub(crate) struct SpeedArguments {
    /// Recordings: video or audio files
    #[arg(required = true, value_name = "FILE")]
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
    /// Print one JSON object per line and file, in the order given
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
    /// Write the speed of every frame as CSV; with several recordings the first column is the file
    #[arg(long, value_name = "FILE.csv", help_heading = "Output")]
    pub(crate) track: Option<PathBuf>,
}

#[derive(Args, Debug)]
#[command(next_help_heading = "Which tone")]
pub(crate) struct ToneArguments {
    /// Blades of each propeller: the tone is the blade pass
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=20))]
    pub(crate) blades: Option<u32>,
    /// Teeth of the motor's pinion and the rotor's wheel (the wheel alone will do): the tone is the gear mesh
    #[arg(long, value_name = "P:W", value_parser = gear)]
    pub(crate) gear: Option<Gear>,
    /// Lines per turn of the shaft, of whichever tone
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) order: Option<f64>,
    /// A known vehicle: its gear mesh or blade pass (see `hovertone vehicles`)
    #[arg(long, value_name = "ID")]
    pub(crate) vehicle: Option<String>,
    /// Where the tone itself lies, in Hz; found by itself where not given
    #[arg(long, value_name = "LOW:HIGH", value_parser = band)]
    pub(crate) band: Option<(f64, f64)>,
    /// Harmonics to follow, the tone itself counted [default: 3]
    #[arg(long, value_name = "N")]
    pub(crate) harmonics: Option<u32>,
}

const TONES_EXAMPLES: &str = "\
A blade pass alone does not tell the number of blades: lines of the shaft between its harmonics do, the mesh of a
known gear does, and diameter, mass and rotors rule out what cannot fly.

Examples:
  hovertone tones hover.mp4
  hovertone tones --vehicle iris hover.mp4
  hovertone tones --diameter-m 0.254 --mass-kg 1.2 --rotors 4 hover.mp4
  hovertone tones --json *.wav | jq '.families[0].readings[0]'";

/// Tone families in recordings, and the shaft speed that each possible order would mean
///
/// Lists every series of lines: fundamental, harmonics, level over the floor, when it is heard. For the one that was
/// taken for the rotor's, all readings: blades, gears, speeds, and how plausible each is.
#[derive(Args, Debug)]
#[command(after_help = TONES_EXAMPLES)]
pub(crate) struct TonesArguments {
    /// Recordings: video or audio files
    #[arg(required = true, value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) known: KnownArguments,
    /// A known vehicle, for what it rules out (see `hovertone vehicles`)
    #[arg(long, value_name = "ID", help_heading = "What is known of the vehicle")]
    pub(crate) vehicle: Option<String>,
    /// Listen from here
    #[arg(long, value_name = "S", allow_negative_numbers = true, help_heading = "How it is analysed")]
    pub(crate) from: Option<f64>,
    /// Listen up to here
    #[arg(long, value_name = "S", allow_negative_numbers = true, help_heading = "How it is analysed")]
    pub(crate) to: Option<f64>,
    #[command(flatten)]
    pub(crate) hearing: HearingArguments,
    /// Print one JSON object per line and file, in the order given
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
#[command(next_help_heading = "What is known of the vehicle")]
pub(crate) struct KnownArguments {
    /// Diameter of a propeller: tips faster than Mach 0.6 are ruled out
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) diameter_m: Option<f64>,
    /// Mass as flown: with diameter and rotors, thrust coefficients outside 0.03 to 0.25 are ruled out
    #[arg(long, value_name = "KG", allow_negative_numbers = true)]
    pub(crate) mass_kg: Option<f64>,
    /// Rotors that carry it: with two or more, each is told apart
    #[arg(long, value_name = "N")]
    pub(crate) rotors: Option<u32>,
}

#[derive(Args, Debug)]
#[command(next_help_heading = "How it is analysed")]
pub(crate) struct AnalysisArguments {
    /// How the speed is read from the sound [default: separated for several rotors, else harmonic]
    #[arg(long, value_parser = method_parser())]
    pub(crate) method: Option<Method>,
    /// How far the recorder's clock may be off, in millionths [default: 50]
    #[arg(long, value_name = "PPM", allow_negative_numbers = true)]
    pub(crate) clock_ppm: Option<f64>,
    /// Show the lines of each rotor's shaft against its blade pass: imbalance, unlike blades (not diagnosed)
    #[arg(long)]
    pub(crate) condition: bool,
    /// How fast the vehicle may move towards or away from the microphone, in m/s [default: 0]
    #[arg(long, value_name = "M/S", allow_negative_numbers = true)]
    pub(crate) radial_speed_m_s_max: Option<f64>,
    /// How much nearer to the microphone, or farther from it, a hover may end than it began, in m; say 0 for a bench [default: 0.5]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub(crate) drift_m_max: Option<f64>,
    /// Use the recording from here, and cut nothing away
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) from: Option<f64>,
    /// Use the recording up to here, and cut nothing away
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) to: Option<f64>,
    /// Length of a frame of the paper's methods in seconds; the clearest of 0.0125 to 0.4 where not given
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) window_s: Option<f64>,
    /// Step between frames as a share of their length [default: 0.5]
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    pub(crate) hop_share: Option<f64>,
    /// Share of a frame's peak that takes part in the Gaussian [default: 0.8]
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    pub(crate) gaussian_threshold_share: Option<f64>,
}

#[derive(Args, Debug)]
#[command(next_help_heading = "Reading files")]
pub(crate) struct HearingArguments {
    /// Audio track to hear, counted from 1 [default: the first that is not silent]
    #[arg(long, value_name = "N", value_parser = from_one)]
    pub(crate) audio_track: Option<usize>,
    /// Channel to hear, counted from 1 [default: the mean of all]
    #[arg(long, value_name = "N", value_parser = from_one)]
    pub(crate) channel: Option<usize>,
    /// Show no progress bar (there is none anyway when stderr is not a terminal)
    #[arg(long)]
    pub(crate) no_progress: bool,
}

/// The paper's experiment in simulated flight: three loads, five trials each, identified like anybody's recordings
///
/// An AR.Drone hovers in the laboratory of the paper's figure 1. Writes the recordings as WAV files, the experiment file, and the truth about every rotor; identifies the files;
/// prints both of the paper's tables beside the numbers that the paper printed and beside the truth; and writes report.html with its figures.
#[derive(Args, Debug)]
#[command(after_help = "The same seed gives the same files and the same numbers on the same machine.")]
pub(crate) struct DemoArguments {
    /// Where to write; must be empty, new, or an earlier demo
    #[arg(short, long, value_name = "DIR", default_value = "demo")]
    pub(crate) output: PathBuf,
    /// Everything random comes from here
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Show no progress bar (there is none anyway when stderr is not a terminal)
    #[arg(long)]
    pub(crate) no_progress: bool,
}

const SIMULATE_EXAMPLES: &str = "\
A scenario file, all keys optional (docs/formats.md lists them):
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
    /// What is flown and what hears it
    #[arg(value_name = "SCENARIO.toml")]
    pub(crate) scenario: PathBuf,
    /// Where to write; must be empty, new, or an earlier simulation
    #[arg(short, long, value_name = "DIR", default_value = "simulation")]
    pub(crate) output: PathBuf,
    /// Everything random comes from here [default: the scenario's]
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// Show no progress bar (there is none anyway when stderr is not a terminal)
    #[arg(long)]
    pub(crate) no_progress: bool,
}

/// The vehicles that hovertone knows: every number with the document it was read in
#[derive(Args, Debug)]
pub(crate) struct VehiclesArguments {
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn method_parser() -> impl TypedValueParser<Value = Method> {
    let named = |name: String| Method::ALL.into_iter().find(|method| method.name() == name).ok_or("no such method");
    PossibleValuesParser::new(Method::ALL.map(Method::name)).try_map(named)
}

fn from_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) => Err("it is counted from 1".to_owned()),
        Ok(number) => Ok(number),
        Err(_) => Err("a whole number is needed, counted from 1".to_owned()),
    }
}

/// "8:69", or the wheel alone. A pinion that was not said makes no difference to the tone; it is taken as 1.
fn gear(text: &str) -> Result<Gear, String> {
    let teeth = |text: &str| match text.trim().parse::<u32>() {
        Ok(teeth @ 1..=1000) => Ok(teeth),
        _ => Err("write the teeth as PINION:WHEEL, such as 8:69, or the wheel's alone".to_owned()),
    };
    match text.split_once(':') {
        Some((pinion, wheel)) => Ok(Gear { pinion: teeth(pinion)?, wheel: teeth(wheel)? }),
        None => Ok(Gear { pinion: 1, wheel: teeth(text)? }),
    }
}

/// "100:200".
fn band(text: &str) -> Result<(f64, f64), String> {
    let edges = text.split_once(':').and_then(|(low, high)| Some((finite(low)?, finite(high)?)));
    edges.ok_or_else(|| "write the band as LOW:HIGH in Hz, such as 4000:4300".to_owned())
}

pub(crate) fn finite(text: &str) -> Option<f64> {
    text.trim().parse::<f64>().ok().filter(|number| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn gears_and_bands_are_read() {
        assert_eq!(gear("8:69"), Ok(Gear { pinion: 8, wheel: 69 }));
        assert_eq!(gear("69").map(|gear| gear.wheel), Ok(69));
        assert!(gear("8:").is_err() && gear("0").is_err() && gear("8:69:1").is_err());
        assert_eq!(band("4000:4300.5"), Ok((4000.0, 4300.5)));
        assert!(band("4000").is_err() && band("a:b").is_err() && band("1:inf").is_err());
    }
}
