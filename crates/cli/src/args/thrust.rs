//! Arguments of the commands about forces: identify, fit, weigh, export, compare.

use super::draft::{DraftArguments, MASS_HELP};
use super::groups::{
    HearingArguments, ReplaceArguments, ToneArguments, method_parser, time_s, typed_path, whole_number,
};
use super::units::{length_m, mass_kg};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use hovertone::speed::Method;
use hovertone_exchange::SimulatorFormat;
use hovertone_vehicle::ROTORS_MAX;
use std::path::PathBuf;

const IDENTIFY_EXAMPLES: &str = "\
An experiment file:
  [vehicle]
  preset = \"ardrone\"          # or rotors, blades, gear = { pinion = 8, wheel = 69 }
  mass_kg = 0.413             # ready to fly, from a kitchen scale

  [tone]
  order = 69                  # lines per turn: blades, or the gear's wheel; \"auto\": the vehicle's

  [[load]]
  name = \"no hull\"
  recordings = [\"no_hull/*.mov\"]

  [[load]]
  name = \"small hull\"
  added_mass_kg = 0.031
  recordings = [\"small_hull/*.mov\"]
  # a recording with the log of its flight: { file = \"a.mov\", log = \"a.ulg\" }

  [air]                       # for C_T; or height_m alone
  temperature_c = 22.0
  pressure_hpa = 1003.0

  [uncertainty]               # for the budget; all have defaults (docs/formats.md)
  rotor_spread_share = 0.0058
  hover_height_m = 1.0

  [[load]]                    # or a bench run: thrust from a scale
  name = \"bench\"
  thrust_n = 0.099
  rotors_running = 1
  recordings = [\"48000.wav\"]

`hovertone demo` writes a complete one, with its recordings.

Examples:
  hovertone identify experiment.toml
  hovertone identify experiment.toml --check
  hovertone identify experiment.toml -o results
  hovertone identify --vehicle ardrone --mass 0.413=demo/no_hull/*.wav
  hovertone identify examples/crazyflie-bench.toml --data-root DIR";

/// Thrust constant from recordings of hovers with known masses, or of bench runs
///
/// Prints warnings; the constant of one rotor and of the whole vehicle, with its ±; whether the loads agree; and where the page is.
/// With -v it also prints tables as in the paper: by the method of hovertone (harmonic), and by the two methods of the paper.
#[derive(Args, Debug)]
#[command(after_help = format!("{MASS_HELP}\n\n{IDENTIFY_EXAMPLES}"))]
pub(crate) struct IdentifyArguments {
    /// The experiment file: vehicle, masses and recordings. `hovertone init` writes one; the flags from --mass on replace it
    #[arg(value_name = "EXPERIMENT.toml", value_parser = typed_path(), required_unless_present = "mass", conflicts_with_all = DraftArguments::NAMES)]
    pub(crate) experiment: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) draft: DraftArguments,
    /// Analyse nothing: only list the planned analysis, the files that were found, and the files that are missing
    #[arg(long, conflicts_with_all = ["json", "verbose"], help_heading = "How it is analysed")]
    pub(crate) check: bool,
    /// Write report.html, results.json, tables and figures into this folder: a new or empty one, or that of an earlier run of this
    /// experiment
    #[arg(short, long, value_name = "DIR", help_heading = "Output", value_parser = typed_path())]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
    /// Print the content of results.json instead
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
    /// Print the tables too
    #[arg(short, long, help_heading = "Output", conflicts_with = "json")]
    pub(crate) verbose: bool,
    /// Folder in which the recordings are [default: the folder of the experiment file]
    #[arg(long, value_name = "DIR", help_heading = "Reading files", value_parser = typed_path())]
    pub(crate) data_root: Option<PathBuf>,
    /// The method whose constant is reported; all are computed [default: separated if several rotors are heard, else harmonic]
    #[arg(long, value_parser = method_parser(), help_heading = "How it is analysed")]
    pub(crate) method: Option<Method>,
    #[command(flatten)]
    pub(crate) hearing: HearingArguments,
}

const FIT_EXAMPLES: &str = "\
The headers name the columns: a speed (rpm, rad/s, rev/s), and a thrust (N, g, gf, kg, lbf) or a mass that hovers \
(mass_g, mass_kg). There may also be standard uncertainties (speed_std_rpm, thrust_std_n, mass_std_g), power and torque. \
Columns of words (motor, propeller) make groups, each with a fit of its own. Where a table has no uncertainties, all thrusts get the same \
one, in newtons or in percent: the one that fits the scatter of the rows better.

Examples:
  hovertone fit stand.csv
  hovertone fit stand.csv --diameter-m 0.254 --temperature-c 22 --pressure-hpa 1003
  hovertone fit hovers.csv --rotors 4 --latitude-deg -20.3
  hovertone fit --plan --mass-kg 0.413 --added-mass-kg 0.1 --wanted-share 0.03";

/// Thrust constant from tables of speed and thrust; or, with --plan, how many flights a wanted uncertainty needs
///
/// Fits F = C_f ω² with uncertainties in F and in ω. Also fits F = F₀ + C ω² and F = C ω^p, and says how probable each law is. Rows that do
/// not fit are named.
#[derive(Args, Debug)]
#[command(after_help = FIT_EXAMPLES)]
pub(crate) struct FitArguments {
    /// Tables: CSV files with a header; - is stdin
    #[arg(required_unless_present = "plan", value_name = "TABLE.csv", value_parser = typed_path())]
    pub(crate) tables: Vec<PathBuf>,
    /// Print one JSON document: the fit, or `groups` with the fit of each group
    #[arg(long)]
    pub(crate) json: bool,
    /// Rotors that share the thrust of a row, or carry its mass [default: 1; 4 with --plan]
    #[arg(long, value_name = "N", value_parser = whole_number(1u32..=ROTORS_MAX))]
    pub(crate) rotors: Option<u32>,
    #[command(flatten)]
    pub(crate) place: PlaceArguments,
    #[command(flatten)]
    pub(crate) air: AirArguments,
    #[command(flatten)]
    pub(crate) plan: PlanArguments,
}

#[derive(Args, Debug)]
#[command(next_help_heading = "Where it was flown")]
pub(crate) struct PlaceArguments {
    /// Local gravity, in m/s² [default: standard gravity]
    #[arg(long, value_name = "M/S2")]
    pub(crate) gravity_m_s2: Option<f64>,
    /// Latitude in degrees: gives the local gravity
    #[arg(long, value_name = "DEG", conflicts_with = "gravity_m_s2")]
    pub(crate) latitude_deg: Option<f64>,
    /// Height above the sea, in m: corrects gravity, and gives the density of the air
    #[arg(long, value_name = "M", value_parser = length_m)]
    pub(crate) height_m: Option<f64>,
}

#[derive(Args, Debug)]
#[command(next_help_heading = "Air and propeller, for C_T and the figure of merit")]
pub(crate) struct AirArguments {
    /// Diameter of a propeller, in m or as 24cm or 8in
    #[arg(long, value_name = "M", value_parser = length_m)]
    pub(crate) diameter_m: Option<f64>,
    /// Temperature of the air [default: of the standard atmosphere at --height-m]
    #[arg(long, value_name = "C")]
    pub(crate) temperature_c: Option<f64>,
    /// Pressure at the place [default: of the standard atmosphere at --height-m]
    #[arg(long, value_name = "HPA")]
    pub(crate) pressure_hpa: Option<f64>,
    /// Relative humidity [default: 0]
    #[arg(long, value_name = "PERCENT")]
    pub(crate) humidity_percent: Option<f64>,
}

#[derive(Args, Debug)]
#[command(next_help_heading = "Before flying")]
pub(crate) struct PlanArguments {
    /// Plan a measurement: how many loads and trials, and how many seconds of hover, a wanted uncertainty needs
    #[arg(long, conflicts_with_all = ["tables", "temperature_c", "pressure_hpa", "humidity_percent"], requires = "mass_kg")]
    pub(crate) plan: bool,
    /// Wanted expanded uncertainty (k = 2) of the constant, as a share
    #[arg(long, requires = "plan", value_name = "SHARE", default_value_t = 0.025)]
    pub(crate) wanted_share: f64,
    /// Mass of the vehicle, ready to fly, in kg or as 413g
    #[arg(long, requires = "plan", value_name = "KG", value_parser = mass_kg)]
    pub(crate) mass_kg: Option<f64>,
    /// Largest payload that the vehicle may carry, in kg or as 100g [default: a quarter of its mass]
    #[arg(long, requires = "plan", value_name = "KG", value_parser = mass_kg)]
    pub(crate) added_mass_kg: Option<f64>,
    /// Standard uncertainty of a weighing
    #[arg(long, requires = "plan", value_name = "KG", default_value = "0.0005", value_parser = mass_kg)]
    pub(crate) mass_std_kg: f64,
    /// Standard deviation of the speed in a hover, as a share of its mean; the flights of the paper have 0.0123
    #[arg(long, requires = "plan", value_name = "SHARE", default_value_t = 0.0123)]
    pub(crate) speed_spread_share: f64,
    /// Time over which the speed of a hover changes (its correlation time), in s
    #[arg(long, requires = "plan", value_name = "S", default_value_t = 0.3)]
    pub(crate) correlation_s: f64,
    /// Plan with speeds of separated rotors or of their group, in place of one tone for all rotors (docs/budget.md)
    #[arg(long, requires = "plan")]
    pub(crate) rotors_separated: bool,
}

const WEIGH_EXAMPLES: &str = "\
Use a constant of the same vehicle, if possible from the same phone at the same place: then the errors that both flights have cancel. If \
the air is 1 % thinner than in the flights of the constant, the mass is 1 % too large.

Examples:
  hovertone weigh loaded.mov --constant out/results.json
  hovertone weigh loaded.mov --constant-n-s2 2.831e-5 --vehicle ardrone --mass-kg 0.413";

/// Mass of an unknown payload, from the sound of a hover and a known thrust constant
#[derive(Args, Debug)]
#[command(after_help = WEIGH_EXAMPLES)]
pub(crate) struct WeighArguments {
    /// Recordings of hovers with the same payload; - is stdin
    #[arg(required = true, value_name = "FILE", value_parser = typed_path())]
    pub(crate) files: Vec<PathBuf>,
    /// results.json of `hovertone identify`, for constant, mass, gravity and tone
    #[arg(long, value_name = "RESULTS.json", required_unless_present = "constant_n_s2", value_parser = typed_path())]
    pub(crate) constant: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) of: GroupArguments,
    /// Thrust constant of the whole vehicle, N/(rad/s)²
    #[arg(long, value_name = "N_S2", conflicts_with = "constant")]
    pub(crate) constant_n_s2: Option<f64>,
    /// Standard uncertainty of --constant-n-s2
    #[arg(long, value_name = "N_S2", conflicts_with = "constant")]
    pub(crate) constant_std_n_s2: Option<f64>,
    /// Number of rotors that carry the vehicle [default: from the results, or from --vehicle]
    #[arg(long, value_name = "N", value_parser = whole_number(1u32..=ROTORS_MAX))]
    pub(crate) rotors: Option<u32>,
    /// Diameter of a propeller, in m or as 24cm or 8in: with it, hovertone can rule out half and double the true speed [default: that of
    /// the results, or of --vehicle]
    #[arg(long, value_name = "M", value_parser = length_m)]
    pub(crate) diameter_m: Option<f64>,
    /// Mass of the vehicle without payload, in kg or as 413g [default: that of the results]
    #[arg(long, value_name = "KG", value_parser = mass_kg)]
    pub(crate) mass_kg: Option<f64>,
    /// Standard uncertainty of that mass [default: 0.0005]
    #[arg(long, value_name = "KG", value_parser = mass_kg)]
    pub(crate) mass_std_kg: Option<f64>,
    #[command(flatten)]
    pub(crate) place: PlaceArguments,
    #[command(flatten)]
    pub(crate) tone: ToneArguments,
    /// Use the recordings from this time on, in seconds or as 1:02.5, and leave out nothing after it
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = time_s, help_heading = "How it is analysed")]
    pub(crate) from: Option<f64>,
    /// Use the recordings up to this time, and leave out nothing before it
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = time_s, help_heading = "How it is analysed")]
    pub(crate) to: Option<f64>,
    #[command(flatten)]
    pub(crate) hearing: HearingArguments,
    /// Print JSON
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
}

const EXPORT_EXAMPLES: &str = "\
Every export has the constant in the program's own unit; a comment has it in all other units: N/(rad/s)^2, N/(rev/s)^2, \
N/rpm^2, g/rpm^2. Sound does not tell torque and time constants: they are marked as missing.

--into changes only two numbers in your own model: the thrust constant of all rotors and, with \
--torque-constant-n-m-s2, the torque constant. hovertone recognises the format by the content of the file.

Examples:
  hovertone export out/results.json --to gazebo
  hovertone export out/results.json --into iris.sdf
  hovertone export out/results.json --to gym-pybullet-drones -o kf.urdf
  hovertone export out/results.json --to airsim --diameter-m 0.2 --air-density-kg-m3 1.17
  hovertone export out/results.json --to rotorpy --torque-constant-n-m-s2 2.1e-7";

/// One of several groups.
#[derive(Args, Debug)]
pub(crate) struct GroupArguments {
    /// Group to use, if the results of `hovertone fit --json` have several
    #[arg(long, value_name = "NAME")]
    pub(crate) group: Option<String>,
}

/// Writes the constant for a simulator: as a new model, or into your own
#[derive(Args, Debug)]
#[command(after_help = EXPORT_EXAMPLES)]
pub(crate) struct ExportArguments {
    /// results.json of `hovertone identify`, or the output of `hovertone fit --json`
    #[arg(value_name = "RESULTS.json", value_parser = typed_path())]
    pub(crate) results: PathBuf,
    /// Simulator that will read the file
    #[arg(long, value_name = "FORMAT", value_parser = format_parser(), required_unless_present = "into", conflicts_with = "into")]
    pub(crate) to: Option<SimulatorFormat>,
    /// Change the constant in this model of a simulator, or in a copy of it with -o, and print the difference
    #[arg(long, value_name = "MODEL", value_parser = typed_path())]
    pub(crate) into: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) of: GroupArguments,
    /// Write into this file: without it --to prints, and --into changes the model itself
    #[arg(short, long, value_name = "FILE", help_heading = "Output", value_parser = typed_path())]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
    /// Torque constant of a rotor, if you measured it, in N m/(rad/s)²
    #[arg(long, value_name = "X")]
    pub(crate) torque_constant_n_m_s2: Option<f64>,
    /// Command (0 to 1) at which the vehicle hovers, for constants in N/command²
    #[arg(long, value_name = "U")]
    pub(crate) hover_command: Option<f64>,
    /// Diameter of a propeller, in m or as 24cm or 8in [default: that of the results]
    #[arg(long, value_name = "M", value_parser = length_m)]
    pub(crate) diameter_m: Option<f64>,
    /// Density of the air [default: that of the results]
    #[arg(long, value_name = "KG/M3")]
    pub(crate) air_density_kg_m3: Option<f64>,
}

const COMPARE_EXAMPLES: &str = "\
The models may be SDF (Gazebo, PX4), xacro (RotorS), URDF (gym-pybullet-drones), Python (RotorPy), YAML (Flightmare), \
C++ (AirSim), TOML (crazyflow), or exports of hovertone.

Examples:
  hovertone compare out/results.json iris.sdf hummingbird.xacro";

/// Compares models of simulators with the heard constant: their constants, units, and hover speeds
#[derive(Args, Debug)]
#[command(after_help = COMPARE_EXAMPLES)]
pub(crate) struct CompareArguments {
    /// results.json of `hovertone identify`
    #[arg(value_name = "RESULTS.json", value_parser = typed_path())]
    pub(crate) results: PathBuf,
    /// Models of simulators
    #[arg(required = true, value_name = "MODEL", value_parser = typed_path())]
    pub(crate) models: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) of: GroupArguments,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

fn format_parser() -> impl TypedValueParser<Value = SimulatorFormat> {
    let named = |name: String| match name.as_str() {
        "px4" => Ok(SimulatorFormat::Gazebo),
        "crazyflie" => Ok(SimulatorFormat::Crazyflow),
        _ => SimulatorFormat::ALL.into_iter().find(|format| format.name() == name).ok_or("no such format"),
    };
    let formats = SimulatorFormat::ALL.map(|format| PossibleValue::new(format.name()).help(contents(format)));
    let other_names = [("px4", "the same as gazebo"), ("crazyflie", "the same as crazyflow")];
    let other_names = other_names.map(|(name, help)| PossibleValue::new(name).help(help));
    PossibleValuesParser::new(formats.into_iter().chain(other_names)).try_map(named)
}

/// The file of a format and its constant, for the help.
fn contents(format: SimulatorFormat) -> String {
    let file = match format {
        SimulatorFormat::Gazebo => "SDF of Gazebo and PX4",
        SimulatorFormat::Rotors => "xacro of RotorS",
        SimulatorFormat::GymPybulletDrones => "URDF of gym-pybullet-drones",
        SimulatorFormat::Rotorpy => "Python of RotorPy",
        SimulatorFormat::Flightmare => "YAML of Flightmare",
        SimulatorFormat::Airsim => "C++ of AirSim",
        SimulatorFormat::Crazyflow => "TOML of crazyflow, for a Crazyflie",
        SimulatorFormat::Json => "JSON with all units",
        SimulatorFormat::Yaml => "YAML with all units",
        _ => return format.constant().0.to_owned(),
    };
    let (name, unit) = format.constant();
    format!("{file}: {name}, {unit}")
}
