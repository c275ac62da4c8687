//! Simulate → WAV → identify, for a hundred random hovers: how often C_f comes back within its own stated U (k = 2).
//! Run by people, never in a test; `crates/cli/tests/command/roundtrip.rs` does ten of them.

use crate::options::whole_number;
use crate::workspace::cargo;
use crate::workspace::target;
use hovertone::vehicle::COVERAGE_FACTOR;
use hovertone_sim::scenario::ScenarioFile;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The seeds: 1 to this.
const SCENARIO_COUNT: u64 = 100;
const DURATION_S: f64 = 10.0;
/// Rotors' constants within ±1 %, so speeds up to 1 % apart.
const SPREAD_SHARE: f64 = 0.01;
/// More than this is a gross failure.
const GROSS_SHARE: f64 = 0.05;
/// Scenarios whose constant must come back within its ±.
const WITHIN_WANTED: usize = 90;

/// What came back by one method.
struct Answer {
    error_share: f64,
    /// Weighing and speeds.
    std_share: Option<f64>,
    /// The whole budget, k = 2.
    expanded_share: Option<f64>,
}

impl Answer {
    fn is_within(&self) -> bool {
        self.std_share.is_some_and(|std_share| self.error_share.abs() <= COVERAGE_FACTOR * std_share)
    }

    fn is_within_budget(&self) -> bool {
        self.expanded_share.is_some_and(|expanded_share| self.error_share.abs() <= expanded_share)
    }
}

/// One scenario.
struct Trip {
    seed: u64,
    vehicle: String,
    place: &'static str,
    speed_spread_share: f64,
    wander_share: f64,
    /// By method, in the order of the results; `None` where no tone was heard.
    answers: Vec<(String, Option<Answer>)>,
}

pub(crate) fn run(root: &Path, options: &[&str]) -> Result<(), String> {
    let (mut count, mut spread_share) = (SCENARIO_COUNT, SPREAD_SHARE);
    for pair in options.chunks(2) {
        match pair {
            ["--count", number] => count = whole_number("--count", number)?,
            ["--spread", share] => {
                spread_share = share.parse().map_err(|_| format!("--spread {share}: not a number"))?
            }
            _ => {
                return Err(
                    "cargo run --release -p hovertone-bench -- roundtrip [--count N] [--spread SHARE]".to_owned()
                );
            }
        }
    }
    cargo(root, &["build", "--release", "--locked", "-p", "hovertone-cli"])?;
    let program = target(root).join("release/hovertone");
    let folder = target(root).join("bench/roundtrip");
    let (next, trips) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed) as u64 + 1;
                    if seed > count {
                        break;
                    }
                    let outcome = trip(&program, &folder.join(seed.to_string()), seed, spread_share);
                    if let Ok(mut trips) = trips.lock() {
                        trips.push(outcome.map_err(|error| format!("seed {seed}: {error}")));
                    }
                }
            });
        }
    });
    let trips = trips.into_inner().map_err(|_| "a worker failed".to_owned())?;
    let mut trips = trips.into_iter().collect::<Result<Vec<Trip>, String>>()?;
    trips.sort_by_key(|trip| trip.seed);
    print(&trips, spread_share);
    Ok(())
}

fn trip(program: &Path, folder: &Path, seed: u64, spread_share: f64) -> Result<Trip, String> {
    fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let file = ScenarioFile::random_hover(seed, DURATION_S, spread_share);
    let write = |name: &str, text: String| fs::write(folder.join(name), text).map_err(|error| error.to_string());
    write("scenario.toml", toml::to_string(&file).map_err(|error| error.to_string())?)?;
    let flown = folder.join("flown");
    hovertone(program, &["simulate", &text(&folder.join("scenario.toml")), "-o", &text(&flown)])?;
    let truth = fs::read_to_string(flown.join("truth.json")).map_err(|error| error.to_string())?;
    let truth: Value = serde_json::from_str(&truth).map_err(|error| error.to_string())?;
    let hover = &truth["hover"];
    let number = |value: &Value| value.as_f64().ok_or_else(|| "a number is missing".to_owned());
    let speeds: Vec<f64> =
        hover["mean_speed_rad_s"].as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
    let stds: Vec<f64> = hover["std_speed_rad_s"].as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
    let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
    let (slowest, fastest) = speeds.iter().fold((f64::MAX, 0.0_f64), |(a, b), &s| (a.min(s), b.max(s)));
    let mass_kg = number(&truth["mass_kg"])?;
    write(
        "experiment.toml",
        format!(
            "[vehicle]\npreset = \"{}\"\nmass_kg = {mass_kg}\nmass_std_kg = 0.0\ngravity_m_s2 = {}\n\
             [[load]]\nname = \"hover\"\nrecordings = [\"flown/sound.wav\"]\n",
            file.vehicle.preset, file.flight.gravity_m_s2,
        ),
    )?;
    let said = hovertone(program, &["identify", &text(&folder.join("experiment.toml")), "--json", "--no-progress"])?;
    let results: Value = serde_json::from_str(&said).map_err(|error| error.to_string())?;
    let true_total = number(&hover["thrust_constant_total_n_s2"])?;
    let answer = |method: &Value| {
        let constant = &method["thrust_constant_total_n_s2"];
        let value = constant["value"].as_f64()?;
        let std_share = method["measured_std_total_n_s2"].as_f64().map(|std| std / value);
        let expanded_share = method["expanded_uncertainty_total_n_s2"].as_f64().map(|expanded| expanded / value);
        Some(Answer { error_share: value / true_total - 1.0, std_share, expanded_share })
    };
    let methods = results["methods"].as_object().ok_or("no methods in the results")?;
    Ok(Trip {
        seed,
        vehicle: file.vehicle.preset,
        place: if file.room.is_some() { "room" } else { "open" },
        speed_spread_share: (fastest - slowest) / mean,
        wander_share: stds.iter().sum::<f64>() / stds.len() as f64 / mean,
        answers: methods.iter().map(|(name, method)| (name.clone(), answer(method))).collect(),
    })
}

/// What a run of the command says; a missing tone (exit code 3) is an answer too.
fn hovertone(program: &Path, arguments: &[&str]) -> Result<String, String> {
    let output = Command::new(program)
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("hovertone could not start: {error}"))?;
    match output.status.code() {
        Some(0 | 3) => String::from_utf8(output.stdout).map_err(|error| error.to_string()),
        _ => Err(String::from_utf8_lossy(&output.stderr).into_owned()),
    }
}

fn print(trips: &[Trip], spread_share: f64) {
    let names: Vec<&str> =
        trips.first().map_or(Vec::new(), |trip| trip.answers.iter().map(|(name, _)| name.as_str()).collect());
    println!("\n{} random hovers of {DURATION_S} s, constants of rotors within ±{spread_share}\n", trips.len());
    let heads: Vec<String> = names.iter().map(|name| format!("{name} error % | U % | within")).collect();
    println!("| seed | vehicle | place | speeds apart % | wander % | {} |", heads.join(" | "));
    println!("|---|---|---|---|---|{}", "---|".repeat(3 * names.len()));
    for trip in trips {
        let cells = trip.answers.iter().map(|(_, answer)| match answer {
            Some(answer) => format!(
                "{:+.3} | {} | {}",
                100.0 * answer.error_share,
                answer.std_share.map_or("–".to_owned(), |std| format!("{:.2}", 100.0 * COVERAGE_FACTOR * std)),
                if answer.is_within() { "yes" } else { "no" },
            ),
            None => "no tone | – | no".to_owned(),
        });
        println!(
            "| {} | {} | {} | {:.2} | {:.2} | {} |",
            trip.seed,
            trip.vehicle,
            trip.place,
            100.0 * trip.speed_spread_share,
            100.0 * trip.wander_share,
            cells.collect::<Vec<_>>().join(" | ")
        );
    }
    println!(
        "\n| method | heard | within U of the sound | within U of the budget | wanted | gross | median error % | 95th percentile % | worst % |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for (index, name) in names.iter().enumerate() {
        let answers: Vec<&Answer> = trips.iter().filter_map(|trip| trip.answers.get(index)?.1.as_ref()).collect();
        let mut errors: Vec<f64> = answers.iter().map(|answer| 100.0 * answer.error_share.abs()).collect();
        errors.sort_by(f64::total_cmp);
        let quantile = |share: f64| errors.get((share * (errors.len().max(1) - 1) as f64).round() as usize);
        let shown = |value: Option<&f64>| value.map_or("–".to_owned(), |value| format!("{value:.3}"));
        println!(
            "| {name} | {} | {} | {} | {} | {} | {} | {} | {} |",
            answers.len(),
            answers.iter().filter(|answer| answer.is_within()).count(),
            answers.iter().filter(|answer| answer.is_within_budget()).count(),
            WITHIN_WANTED * trips.len() / 100,
            answers.iter().filter(|answer| answer.error_share.abs() > GROSS_SHARE).count(),
            shown(quantile(0.5)),
            shown(quantile(0.95)),
            shown(errors.last()),
        );
    }
}

fn text(path: &Path) -> String {
    path.display().to_string()
}
