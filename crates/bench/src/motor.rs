//! Constants of motors from the sound of steps: simulated benches with one to four rotors, heard as `hovertone motor` does.

use crate::options::whole_number;
use hovertone::motors::{HeardMotor, HeardTone, MotorConstants, constants_of, level_of_rotors, motor_from_sound};
use hovertone::sound::{Passes, Signal};
use hovertone::speed::{Config, ToneConfig};
use hovertone::vehicle::{Estimate, find_preset};
use hovertone_sim::scenario::{MotorWanderSection, RoomSection, ScenarioFile, ScenarioRun};
use hovertone_sim::{FlightSound, RotorState, SoundState};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Benches of each vehicle.
const COUNT: u64 = 100;
const VEHICLES: [&str; 2] = ["ardrone", "f450"];
/// Levels of the speed, as shares of the speed in hover, each held for so long.
const LEVELS: [f64; 7] = [0.75, 1.0, 0.8, 1.1, 0.85, 1.05, 0.7];
const HOLD_S: f64 = 1.6;
const LENGTH_S: f64 = HOLD_S * LEVELS.len() as f64;
const STEP_S: f64 = 0.002;
/// Time in which the sound of the room falls by 60 dB, unless another is given.
const REVERBERATION_S: f64 = 0.4;
const USAGE: &str = "cargo run --release -p hovertone-bench -- motor [--count N] [--first-seed N] [--reverberation S] [--only room|open] [--vehicle NAME] [--list] [--save DIR]";
/// Largest error that counts as right.
const RIGHT_SHARE: f64 = 0.03;

/// A vehicle that is held while its motors step.
#[derive(Clone, Debug)]
struct Bench {
    vehicle: &'static str,
    seed: u64,
    is_room: bool,
    reverberation_s: f64,
    time_constants_s: [f64; 2],
    /// Each rotor's speed over their mean.
    rotor_shares: [f64; 4],
    start_s: f64,
}

/// Which benches are heard.
struct Exam {
    count: u64,
    first_seed: u64,
    reverberation_s: f64,
    /// Whether each answer is printed.
    is_listed: bool,
    /// Whether those in a room are heard, or those in the open; else both.
    is_room: Option<bool>,
    /// Folder for the sounds of the benches.
    save_to: Option<PathBuf>,
    vehicles: Vec<&'static str>,
}

impl Exam {
    fn of_options(options: &[&str]) -> Result<Self, String> {
        let mut exam = Self {
            count: COUNT,
            first_seed: 0,
            reverberation_s: REVERBERATION_S,
            is_listed: false,
            is_room: None,
            save_to: None,
            vehicles: VEHICLES.to_vec(),
        };
        let mut rest = options.iter();
        while let Some(&option) = rest.next() {
            if option == "--list" {
                exam.is_listed = true;
                continue;
            }
            let value = rest.next().ok_or(USAGE)?;
            let wrong = |_| format!("{option} {value}: not a number");
            match option {
                "--count" => exam.count = whole_number(option, value)?,
                "--first-seed" => exam.first_seed = whole_number(option, value)?,
                "--reverberation" => exam.reverberation_s = value.parse().map_err(wrong)?,
                "--only" => exam.is_room = Some(*value == "room"),
                "--vehicle" => exam.vehicles = VEHICLES.into_iter().filter(|vehicle| vehicle == value).collect(),
                "--save" => exam.save_to = Some(PathBuf::from(value)),
                _ => return Err(USAGE.to_owned()),
            }
        }
        Ok(exam)
    }

    fn benches(&self, vehicle: &'static str) -> impl Iterator<Item = Bench> {
        let seeds = self.first_seed..self.first_seed + self.count;
        let bench = move |seed| Bench { reverberation_s: self.reverberation_s, ..Bench::drawn(vehicle, seed) };
        seeds.map(bench).filter(|bench| self.is_room.is_none_or(|is_room| bench.is_room == is_room))
    }
}

/// τ up and down as heard, beside the truth.
struct Answer {
    is_room: bool,
    heard: Option<MotorConstants>,
    truth_s: [f64; 2],
}

impl Answer {
    fn print(&self, bench: &Bench) {
        let places = if self.is_room { "room" } else { "open" };
        let heard = self.heard;
        let told =
            [heard.and_then(|heard| heard.time_constant_up_s), heard.and_then(|heard| heard.time_constant_down_s)];
        let words = told.into_iter().zip(self.truth_s).map(|(told, truth_s)| match told.map(|told| told.estimate) {
            Some(Estimate { value, std_uncertainty: Some(std), .. }) => {
                format!("{:.1} ± {:.1} of {:.1} ms", 1e3 * value, 1e3 * std, 1e3 * truth_s)
            }
            _ => format!("none of {:.1} ms", 1e3 * truth_s),
        });
        println!("{} {} {places}: {}", bench.vehicle, bench.seed, words.collect::<Vec<_>>().join(", "));
    }
}

pub(crate) fn run(_root: &Path, options: &[&str]) -> Result<(), String> {
    let exam = Exam::of_options(options)?;
    println!("\n{} benches of each vehicle, half of them in a room, from seed {}\n", exam.count, exam.first_seed);
    println!("The room's sound falls by 60 dB in {} s.\n", exam.reverberation_s);
    println!("| vehicle | τ told | within 3 % | median error | error within 2 u |");
    println!("|---|---|---|---|---|");
    for vehicle in exam.vehicles.iter().copied() {
        let answers: Vec<Answer> =
            exam.benches(vehicle).map(|bench| answer(&exam, &bench)).collect::<Result<_, String>>()?;
        let places = [("", None), (", open", Some(false)), (", room", Some(true))];
        for (words, is_room) in places {
            let chosen = answers.iter().filter(|answer| is_room.is_none_or(|is_room| answer.is_room == is_room));
            println!("{}", table_row(&format!("{vehicle}{words}"), chosen));
        }
    }
    Ok(())
}

fn table_row<'a>(name: &str, answers: impl Iterator<Item = &'a Answer>) -> String {
    let (mut errors, mut in_std, mut asked) = (Vec::new(), Vec::new(), 0);
    for answer in answers {
        let heard = answer.heard;
        let told =
            [heard.and_then(|heard| heard.time_constant_up_s), heard.and_then(|heard| heard.time_constant_down_s)];
        for (told, truth_s) in told.into_iter().zip(answer.truth_s) {
            asked += 1;
            let Some(Estimate { value, std_uncertainty: Some(std), .. }) = told.map(|told| told.estimate) else {
                continue;
            };
            let (error, ratio) = ((value / truth_s - 1.0).abs(), ((value - truth_s) / std).abs());
            errors.push(error);
            in_std.push(ratio);
        }
    }
    errors.sort_by(f64::total_cmp);
    let share = |count: usize| 100.0 * count as f64 / in_std.len().max(1) as f64;
    format!(
        "| {name} | {} of {asked} | {:.1} % | {:.2} % | {:.1} % |",
        errors.len(),
        share(errors.iter().filter(|error| **error <= RIGHT_SHARE).count()),
        100.0 * errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN),
        share(in_std.iter().filter(|ratio| **ratio <= 2.0).count()),
    )
}

impl Bench {
    fn drawn(vehicle: &'static str, seed: u64) -> Self {
        let mut random = Pcg64::seed_from_u64(seed);
        let up_s = 0.03 + 0.07 * random.random::<f64>();
        // from the slowest rotor to the fastest
        let spread = 0.03 * random.random::<f64>();
        let mut shares = [-0.5, 0.5, random.random::<f64>() - 0.5, random.random::<f64>() - 0.5];
        shares.iter_mut().for_each(|share| *share = 1.0 + spread * *share);
        Self {
            vehicle,
            seed,
            is_room: seed % 2 == 1,
            reverberation_s: REVERBERATION_S,
            time_constants_s: [up_s, up_s * (1.0 + random.random::<f64>())],
            rotor_shares: shares,
            start_s: 0.2 * random.random::<f64>(),
        }
    }

    /// Speed as a share of the speed in hover.
    fn share_at(&self, time_s: f64) -> f64 {
        let mut share = LEVELS[0];
        for (at, &level) in LEVELS.iter().enumerate().skip(1) {
            let since_s = (time_s - self.start_s - HOLD_S * at as f64).clamp(0.0, HOLD_S);
            let time_constant_s = self.time_constants_s[usize::from(level < share)];
            share = level + (share - level) * (-since_s / time_constant_s).exp();
        }
        share
    }

    /// The sound as 32-bit floats, and the truth.
    fn save(&self, folder: &Path, samples: &[f32]) -> std::io::Result<()> {
        let name = format!("{}-{}", self.vehicle, self.seed);
        let bytes: Vec<u8> = samples.iter().flat_map(|sample| sample.to_le_bytes()).collect();
        std::fs::write(folder.join(format!("{name}.f32")), bytes)?;
        let Self { is_room, time_constants_s: [up_s, down_s], rotor_shares, start_s, .. } = self;
        let truth = format!(
            "{{\"is_room\": {is_room}, \"up_s\": {up_s}, \"down_s\": {down_s}, \"start_s\": {start_s}, \"shares\": {rotor_shares:?}}}"
        );
        std::fs::write(folder.join(format!("{name}.json")), truth)
    }

    /// What a microphone hears of it.
    fn sound(&self) -> Result<(Vec<f32>, f64), String> {
        let room =
            self.is_room.then(|| RoomSection { reverberation_s: Some(self.reverberation_s), ..RoomSection::default() });
        let mut file = ScenarioFile { seed: self.seed, duration_s: Some(1.0), room, ..ScenarioFile::default() };
        file.vehicle.preset = self.vehicle.to_owned();
        file.motor_wander = Some(MotorWanderSection::default());
        let scenario = file.resolve(&BTreeMap::new()).map_err(|error| error.to_string())?;
        let sample_rate_hz = f64::from(scenario.sound.sample_rate_hz);
        let mut sound = FlightSound::new(scenario.sound.clone()).map_err(|error| error.to_string())?;
        let mut first = Vec::new();
        let mut run = ScenarioRun::silent(scenario).map_err(|error| error.to_string())?;
        run.advance(&mut Vec::new(), &mut first).map_err(|error| error.to_string())?;
        let hover = first.first().ok_or("a flight without states")?;
        let (places, axis) = (hover.rotor_positions_m(), hover.thrust_axis());
        let mut channels = Vec::new();
        for step in 0..=(LENGTH_S / STEP_S) as usize {
            let time_s = step as f64 * STEP_S;
            let rotor = |rotor: usize| RotorState {
                speed_rad_s: hover.speed_rad_s[rotor] * self.rotor_shares[rotor] * self.share_at(time_s),
                position_m: places[rotor],
                axis,
            };
            let state = SoundState { time_s, rotors: (0..4).map(rotor).collect() };
            sound.push(&state, &mut channels).map_err(|error| error.to_string())?;
        }
        sound.finish(&mut channels);
        let samples = channels.into_iter().next().ok_or("no microphone")?;
        Ok((samples, sample_rate_hz))
    }
}

fn answer(exam: &Exam, bench: &Bench) -> Result<Answer, String> {
    let (samples, sample_rate_hz) = bench.sound()?;
    if let Some(folder) = &exam.save_to {
        bench.save(folder, &samples).map_err(|error| error.to_string())?;
    }
    let vehicle = find_preset(bench.vehicle).ok_or("no such vehicle")?;
    let gear = vehicle.gear.as_ref().map(|gear| gear.value.mesh_order());
    let order = match (gear, &vehicle.blade_count) {
        (Some(order), _) => order,
        (None, Some(blades)) => hovertone::vehicle::Order::from_blades(blades.value),
        (None, None) => return Err("no tone".to_owned()),
    }
    .map_err(|error| error.to_string())?;
    let tone =
        ToneConfig { blades: vehicle.blade_count.as_ref().map(|blades| blades.value), ..ToneConfig::of_order(order) };
    let tone = vehicle.shaft_speed.as_ref().map_or_else(|| tone.clone(), |known| tone.clone().within(&known.value));
    let mut source = Signal::new(samples, sample_rate_hz);
    let heard = heard_motor(&mut source, tone)?;
    let heard = heard.and_then(|heard| heard.model).map(|model| constants_of(&[model]));
    let answer = Answer { is_room: bench.is_room, heard, truth_s: bench.time_constants_s };
    if exam.is_listed {
        answer.print(bench);
    }
    Ok(answer)
}

fn heard_motor(source: &mut Signal, tone: ToneConfig) -> Result<Option<HeardMotor>, String> {
    let mut on_progress = |_| {};
    let mut passes = Passes::planned(source, 1, &mut on_progress).map_err(|error| error.to_string())?;
    let config = Config::for_tone(tone);
    let level = level_of_rotors(&mut passes, &config).map_err(|error| error.to_string())?;
    let Ok(speed_rev_s) = level else { return Ok(None) };
    let heard = HeardTone { tone: &config.tone, speed_rev_s, span_s: 0.0..f64::INFINITY };
    motor_from_sound(&mut passes, &heard, None).map(Some).map_err(|error| error.to_string())
}
