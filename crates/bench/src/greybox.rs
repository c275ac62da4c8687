//! `cargo run --release -p hovertone-bench -- greybox`: the low-level model of simulated flights against their truth, from logged speeds
//! and from sound. Prints the tables of `docs/greybox.md`. Run by people; its test flies fewer.

use crate::options::whole_number;
use hovertone::sound::{Passes, Signal};
use hovertone_dynamics::{
    Checked, ControlKnowns, ControlLog, GreyBoxConfig, GreyBoxFit, GreyBoxModel, LineOrders, LoopInputs, MotorVolts,
    Parameter, SoundConfig, checked, grey_box_from_sound, grey_box_from_speeds, lines_from_passes,
    observations_of_rows,
};
use hovertone_sim::FlightState;
use hovertone_sim::scenario::{
    ControllerSection, DoubletAmounts, GainsSection, MicrophoneSection, RoomSection, ScenarioFile, ScenarioRun,
    SpreadSection,
};
use hovertone_vehicle::{
    Axis, FlightParameters, GRAVITY_STANDARD_M_S2, LoopGains, find_flight_parameters, find_preset,
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Flights of each kind, unless the options say otherwise.
const LOGGED: u64 = 50;
const HEARD: u64 = 4;
const DURATION_S: f64 = 60.0;
const CHECK_S: f64 = 15.0;
const VEHICLES: [&str; 2] = ["ardrone", "f450"];
/// Largest difference of the rotors from each other, as a share.
const SPREAD_SHARE_MAX: f64 = 0.03;
/// Largest error of a gain that counts as right.
const GAIN_SHARE_MAX: f64 = 0.05;

/// Where the speeds come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    Logged,
    HeardInTheOpen,
    HeardInARoom,
}

impl Source {
    /// The word for it after `--only`.
    fn option(self) -> &'static str {
        match self {
            Self::Logged => "logged",
            Self::HeardInTheOpen => "open",
            Self::HeardInARoom => "room",
        }
    }
}

/// A told gain or time constant beside the truth.
struct Told {
    name: String,
    /// As a share of the truth; none where that is 0.
    error_share: Option<f64>,
    /// Error over standard uncertainty.
    deviation: f64,
}

/// Result of a flight.
struct Examined {
    /// Worst error of a told k_p, as a share.
    gain_error: f64,
    told: Vec<Told>,
    time_constant_error: f64,
    check: Option<Checked>,
    /// Hover speed of each rotor over their mean, less 1.
    apart_share: [f64; 4],
    /// Whether the sound is said to have echoes.
    has_echoes: bool,
}

const USAGE: &str = "cargo run --release -p hovertone-bench -- greybox [--logged N] [--heard N] [--first-seed N] [--vehicle NAME] [--only logged|open|room] [--list]";

/// Which flights are examined.
struct Exam {
    logged: u64,
    heard: u64,
    first_seed: u64,
    vehicles: Vec<&'static str>,
    sources: Vec<Source>,
    is_listed: bool,
}

impl Exam {
    fn of_options(options: &[&str]) -> Result<Self, String> {
        let mut exam = Self {
            logged: LOGGED,
            heard: HEARD,
            first_seed: 1,
            vehicles: VEHICLES.to_vec(),
            sources: vec![Source::Logged, Source::HeardInTheOpen, Source::HeardInARoom],
            is_listed: false,
        };
        let mut options = options.iter();
        while let Some(option) = options.next() {
            if *option == "--list" {
                exam.is_listed = true;
                continue;
            }
            let value = options.next().ok_or(USAGE)?;
            let number = || whole_number(option, value);
            match *option {
                "--logged" => exam.logged = number()?,
                "--heard" => exam.heard = number()?,
                "--first-seed" => exam.first_seed = number()?,
                "--vehicle" => exam.vehicles.retain(|vehicle| vehicle == value),
                "--only" => exam.sources.retain(|source| source.option() == *value),
                _ => return Err(USAGE.to_owned()),
            }
        }
        if exam.vehicles.is_empty() || exam.sources.is_empty() { Err(USAGE.to_owned()) } else { Ok(exam) }
    }

    fn seeds(&self, source: Source) -> std::ops::Range<u64> {
        let count = if source == Source::Logged { self.logged } else { self.heard };
        self.first_seed..self.first_seed + count
    }
}

/// Runs the exam.
pub(crate) fn run(options: &[&str]) -> Result<(), String> {
    let exam = Exam::of_options(options)?;
    println!(
        "| vehicle | speeds | flights | all k_p within 5 % | median error of k_p | within 2 u | median error of τ | rms on another flight | echoes found |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for &source in &exam.sources {
        let seeds = exam.seeds(source);
        for preset in exam.vehicles.iter().filter(|_| !seeds.is_empty()) {
            let of_seed = |seed| {
                let flight = examined(preset, seed, source, DURATION_S);
                if exam.is_listed {
                    eprintln!("{preset} {} {seed}: {}", source.option(), line_of(flight.as_ref()));
                }
                flight
            };
            let all: Vec<Option<Examined>> = seeds.clone().map(of_seed).collect();
            println!("{}", row_of(preset, source, &all));
        }
    }
    Ok(())
}

/// The errors of a flight in per cent, each with its error over standard uncertainty.
fn line_of(flight: Option<&Examined>) -> String {
    let Some(flight) = flight else { return "no answer".to_owned() };
    let told = |Told { name, error_share, deviation }: &Told| {
        let share = error_share.map_or(String::new(), |share| format!("{:+.2} % ", 100.0 * share));
        format!("{name} {share}({deviation:+.1} u)")
    };
    let all: Vec<String> = flight.told.iter().map(told).collect();
    let rms = flight.check.map_or(f64::NAN, |check| 100.0 * check.rms_share);
    let apart = flight.apart_share.map(|share| format!("{:+.2}", 100.0 * share)).join(", ");
    format!("{}; rms on another flight {rms:.3} %; rotors {apart} % from their mean", all.join(", "))
}

fn row_of(preset: &str, source: Source, all: &[Option<Examined>]) -> String {
    let told: Vec<&Examined> = all.iter().flatten().collect();
    let right = told.iter().filter(|flight| flight.gain_error < GAIN_SHARE_MAX).count();
    let deviations: Vec<f64> = told.iter().flat_map(|flight| flight.told.iter().map(|told| told.deviation)).collect();
    let within = deviations.iter().filter(|deviation| deviation.abs() <= 2.0).count();
    let errors = |of: &dyn Fn(&Examined) -> Option<f64>| median(told.iter().filter_map(|flight| of(flight)).collect());
    let speeds = match source {
        Source::Logged => "logged",
        Source::HeardInTheOpen => "heard, open ground",
        Source::HeardInARoom => "heard, room",
    };
    format!(
        "| {preset} | {speeds} | {} | {right} | {:.2} % | {:.0} % | {:.2} % | {:.3} % | {} |",
        all.len(),
        100.0 * errors(&|flight| Some(flight.gain_error)),
        100.0 * within as f64 / deviations.len().max(1) as f64,
        100.0 * errors(&|flight| Some(flight.time_constant_error)),
        100.0 * errors(&|flight| Some(flight.check?.rms_share)),
        told.iter().filter(|flight| flight.has_echoes).count(),
    )
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// A vehicle whose gains are up to 30 % off its preset's and whose rotors are up to 3 % apart, in doublets and in another flight.
fn scenarios(preset: &str, seed: u64, source: Source, duration_s: f64) -> Option<[ScenarioFile; 2]> {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut uniform = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    let of = &find_flight_parameters(preset)?.controller;
    let mut scaled = |gains: LoopGains| {
        let (p, d) = (uniform(0.7, 1.3), uniform(0.7, 1.3));
        let LoopGains { proportional, derivative, limit_v } = gains;
        Some(GainsSection { proportional: p * proportional, derivative: d * derivative, limit_v })
    };
    let controller = ControllerSection {
        roll: scaled(of.roll.value),
        pitch: scaled(of.pitch.value),
        yaw_rate: scaled(of.yaw_rate.value),
        climb: scaled(of.climb.value),
        ..ControllerSection::default()
    };
    let spread_share = uniform(0.0, SPREAD_SHARE_MAX);
    // speeds go with the inverse root of C_f
    let mut shares = || Some([0; 4].map(|_: i32| 1.0 + uniform(-spread_share, spread_share)));
    let spread = SpreadSection { thrust_shares: shares(), motor_gains: shares(), ..SpreadSection::default() };
    let amounts = DoubletAmounts::default();
    let mut doublets = ScenarioFile {
        controller: Some(controller),
        spread: Some(spread),
        microphones: vec![MicrophoneSection::at([-uniform(1.5, 2.5), uniform(-1.0, 1.0), uniform(0.5, 1.8)])],
        ..ScenarioFile::doublets(preset, seed, duration_s, amounts)
    };
    if source == Source::HeardInARoom {
        (doublets.ground, doublets.room) = (None, Some(RoomSection::default()));
    }
    let smaller =
        DoubletAmounts { tilt: 0.7 * amounts.tilt, yaw_rate: 0.7 * amounts.yaw_rate, climb: 0.7 * amounts.climb };
    let mut check = ScenarioFile {
        maneuvers: ScenarioFile::doublets(preset, seed, CHECK_S, smaller).maneuvers,
        ..doublets.clone()
    };
    check.maneuvers.reverse();
    check.duration_s = Some(CHECK_S);
    Some([doublets, check])
}

struct Flown {
    inputs: LoopInputs,
    time_s: Vec<f64>,
    speeds: [Vec<f64>; 4],
    truth: GreyBoxModel,
    sound: Signal,
}

fn flown(scenario: &ScenarioFile, has_sound: bool) -> Option<Flown> {
    let resolved = scenario.resolve(&BTreeMap::new()).ok()?;
    let mut run = if has_sound { ScenarioRun::new(resolved) } else { ScenarioRun::silent(resolved) }.ok()?;
    let vehicle = run.scenario().flight.vehicle.clone();
    let rate_hz = f64::from(run.scenario().sound.sample_rate_hz);
    let (mut channels, mut rows): (Vec<Vec<f32>>, Vec<FlightState>) = (Vec::new(), Vec::new());
    while run.advance(&mut channels, &mut rows).ok()? {}
    run.finish(&mut channels);
    let column = |of: &dyn Fn(&FlightState) -> f64| rows.iter().map(of).collect::<Vec<f64>>();
    let rate = |axis: usize| Some(column(&|row| row.euler().rates(&row.rates_rad_s.into())[axis]));
    let log = ControlLog {
        time_s: column(&|row| row.time_s),
        command: [0, 1, 2, 3].map(|axis| Some(column(&|row| row.command.to_array()[axis]))),
        measured: [
            Some(column(&|row| row.euler().roll_rad)),
            Some(column(&|row| row.euler().pitch_rad)),
            rate(2),
            Some(column(&|row| row.velocity_m_s[2])),
        ],
        tilt_rate_rad_s: [rate(0), rate(1)],
    };
    let speeds = [0, 1, 2, 3].map(|rotor| column(&|row| row.speed_rad_s[rotor]));
    let gains = scenario.spread.and_then(|spread| spread.motor_gains).unwrap_or([1.0; 4]);
    let hovers = [0, 1, 2, 3].map(|rotor: usize| speeds[rotor].first().copied().unwrap_or_default());
    Some(Flown {
        inputs: LoopInputs::from_log(&log, &ControlKnowns::of(&vehicle))?,
        truth: truth_of(&vehicle, hovers, gains.iter().sum::<f64>() / 4.0),
        speeds,
        sound: Signal::new(channels.into_iter().next().unwrap_or_default(), rate_hz),
        time_s: log.time_s,
    })
}

/// The model of the vehicle as flown: about its own hover, with the mean gain of its motors.
fn truth_of(vehicle: &FlightParameters, hover_rad_s: [f64; 4], motor_gain: f64) -> GreyBoxModel {
    let mut truth = GreyBoxModel::of(vehicle, vehicle.mass_kg.value, GRAVITY_STANDARD_M_S2);
    let (volts, nominal_rad_s) = (MotorVolts::of(vehicle), truth.mean_hover_rad_s());
    truth.hover_rad_s = hover_rad_s;
    let slopes = volts.slope_v_s_rad(nominal_rad_s) / volts.slope_v_s_rad(truth.mean_hover_rad_s());
    for of_loop in &mut truth.loops {
        of_loop.proportional *= motor_gain * slopes;
        of_loop.derivative *= motor_gain * slopes;
    }
    truth.time_constant_s *= slopes;
    truth
}

/// The fit, and whether the sound is said to have echoes.
fn fit_of(flown: &mut Flown, preset: &str, source: Source) -> Option<(GreyBoxFit, bool)> {
    let vehicle = find_flight_parameters(preset)?;
    let start = GreyBoxModel::of(vehicle, vehicle.mass_kg.value, GRAVITY_STANDARD_M_S2);
    if source == Source::Logged {
        let speeds = [0, 1, 2, 3].map(|rotor: usize| flown.speeds[rotor].as_slice());
        let observations = observations_of_rows(&flown.time_s, speeds, 0.1);
        let fit = grey_box_from_speeds(&observations, &flown.inputs, &start, &GreyBoxConfig::default()).ok()?;
        return Some((fit, false));
    }
    let hover_rev_s = start.mean_hover_rad_s() / TAU;
    let mut quiet = |_| {};
    let mut passes = Passes::planned(&mut flown.sound, 1, &mut quiet).ok()?;
    let orders = LineOrders::of(find_preset(preset)?)?;
    let range = 0.7 * hover_rev_s..1.35 * hover_rev_s;
    let lines = lines_from_passes(&mut passes, 0.0..f64::INFINITY, &orders, range).ok()?;
    let heard = grey_box_from_sound(&lines, &flown.inputs, &start, &SoundConfig::default(), &mut |_| {}).ok()?;
    Some((heard.fit, heard.echoes.is_some()))
}

/// The exam of one flight; `None` where it could not be flown or fitted.
fn examined(preset: &str, seed: u64, source: Source, duration_s: f64) -> Option<Examined> {
    let [doublets, check] = scenarios(preset, seed, source, duration_s)?;
    let mut flight = flown(&doublets, source != Source::Logged)?;
    let (fit, has_echoes) = fit_of(&mut flight, preset, source)?;
    let truth = flight.truth.to_vector();
    let error = |at: usize| fit.model.to_vector()[at] / truth[at] - 1.0;
    let compared = |parameter: &Parameter| {
        matches!(parameter, Parameter::Proportional(_) | Parameter::Derivative(_) | Parameter::TimeConstant)
    };
    let told = |(at, parameter): (usize, Parameter)| {
        let std_uncertainty = fit.std_uncertainty[at].filter(|_| compared(&parameter))?;
        let error_share = (truth[at] != 0.0).then(|| error(at));
        Some(Told {
            name: parameter.name(),
            error_share,
            deviation: (fit.model.to_vector()[at] - truth[at]) / std_uncertainty,
        })
    };
    let other = flown(&check, false)?;
    // against the true speeds, with the delays of the sound taken out
    let mut model = fit.model;
    if source != Source::Logged {
        let late_s = model.command_delay_s;
        (model.command_delay_s, model.measured_delay_s) = (0.0, model.measured_delay_s - late_s);
    }
    let prediction = hovertone_dynamics::SpeedPrediction::new(&other.inputs, &model);
    let speeds = [0, 1, 2, 3].map(|rotor: usize| other.speeds[rotor].as_slice());
    Some(Examined {
        gain_error: Axis::ALL.iter().map(|axis| error(*axis as usize).abs()).fold(0.0, f64::max),
        told: Parameter::all().into_iter().enumerate().filter_map(told).collect(),
        time_constant_error: error(12).abs(),
        check: checked(&observations_of_rows(&other.time_s, speeds, 0.1), &prediction),
        apart_share: flight.truth.hover_rad_s.map(|hover| hover / flight.truth.mean_hover_rad_s() - 1.0),
        has_echoes,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logged_flights_pass_the_exam() {
        for preset in VEHICLES {
            for seed in 1..=2 {
                let examined = examined(preset, seed, Source::Logged, 30.0).unwrap();
                assert!(examined.gain_error < GAIN_SHARE_MAX, "{preset} {seed}: {}", examined.gain_error);
                assert!(examined.check.unwrap().rms_share < 0.005);
            }
        }
    }
}
