//! `cargo run --release -p hovertone-bench -- levels`: levels of the lines and evidence of simulated flights beside real recordings,
//! measured by the same code. Writes `docs/synthetic-and-real.md` and `docs/synthetic-and-real-levels.png`.
//!
//! ```text
//! simulated flights, real recordings ─▶ evidence near the true speed ─▶ measured by class of line ─▶ tables, figure
//! ```

mod measured;
mod report;
mod simulated;

use super::cases::{Told, Truth};
use super::judgement::Expected;
use super::library::{LoadedCase, answer_to, config_of_blades};
use super::progress::Progress;
use super::{REAL, TruthSet, data_folder};
use crate::accuracy::drawn;
use crate::options::whole_number;
use crate::workspace::{made_by, target};
use hovertone::sound::Signal;
use hovertone::speed::{Config, SpanConfig, evidence_near};
use hovertone_figures::figure_png;
use measured::{Heard, Measured};
use report::Sets;
use std::fs;
use std::path::Path;

const REPORT: &str = "docs/synthetic-and-real.md";
const FIGURE: &str = "docs/synthetic-and-real-levels.png";
const FIGURE_DOTS_PER_INCH: f64 = 150.0;
const FLIGHT_COUNT: usize = 60;
const USAGE: &str = "cargo run --release -p hovertone-bench -- levels [--data DIR] [--flights N]";

/// Runs the exam and writes its report.
pub(crate) fn run(root: &Path, words: &[&str]) -> Result<(), String> {
    let (mut data, mut flight_count) = (None, FLIGHT_COUNT);
    for pair in words.chunks(2) {
        match pair {
            ["--data", folder] => data = Some(*folder),
            ["--flights", number] => {
                flight_count = whole_number("--flights", number)?;
            }
            _ => return Err(USAGE.to_owned()),
        }
    }
    let made_by = made_by(root, "levels", words);
    let set = TruthSet::read(REAL, &data_folder(root, data).join("real"))?;
    let cases = LoadedCase::all(&set, |told| told == Told::Blades)?;
    let rotors: Vec<&LoadedCase<'_>> = cases.iter().filter(|loaded| loaded.case.truth.mean_rev_s().is_some()).collect();
    let progress = Progress::new("recordings", rotors.len());
    let real = drawn(rotors.len(), |number| {
        let heard = heard_of_case(rotors[number]);
        progress.step();
        heard
    })?;
    let of_kind = |is_flight: bool| -> Vec<Heard> {
        let kinds = rotors.iter().map(|loaded| loaded.case.truth.kind == "multi");
        real.iter().zip(kinds).filter(|(_, flies)| *flies == is_flight).map(|(heard, _)| heard.clone()).collect()
    };
    let has_ffmpeg = simulated::has_ffmpeg();
    let simulated = heard_flights(root, flight_count, has_ffmpeg)?;
    let sets = Sets { simulated, flights: of_kind(true), benches: of_kind(false) };
    let figure = figure_png(&report::figure(&sets)?, FIGURE_DOTS_PER_INCH).map_err(|error| error.to_string())?;
    fs::write(root.join(FIGURE), figure).map_err(|error| format!("{FIGURE}: {error}"))?;
    let text = report::report(&made_by, &sets, has_ffmpeg);
    fs::write(root.join(REPORT), &text).map_err(|error| format!("{REPORT}: {error}"))?;
    println!("{text}\n{REPORT} is written");
    Ok(())
}

fn heard_flights(root: &Path, count: usize, has_ffmpeg: bool) -> Result<Vec<Heard>, String> {
    let folder = target(root).join("bench/levels");
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let progress = Progress::new("flights", count);
    drawn(count, |number| {
        let flight = simulated::flown(number as u64 + 1, &folder, has_ffmpeg)?;
        let subject = Subject {
            truth: &flight.truth,
            flags: &[],
            sound: &flight.sound,
            blades: flight.blades,
            true_rev_s: flight.mean_rev_s,
        };
        let heard = subject.heard(&config_of_blades(flight.blades)?);
        progress.step();
        heard
    })
}

fn heard_of_case(loaded: &LoadedCase<'_>) -> Result<Heard, String> {
    let truth = loaded.case.truth;
    let true_rev_s = truth.mean_rev_s().ok_or_else(|| format!("{}: its speed is not known", truth.file))?;
    let flags = loaded.case.flags;
    Subject { truth, flags, sound: &loaded.sound, blades: loaded.blades(), true_rev_s }.heard(&loaded.config()?)
}

/// A sound with its truth.
struct Subject<'a> {
    truth: &'a Truth,
    flags: &'a [String],
    sound: &'a Signal,
    blades: u32,
    true_rev_s: f64,
}

impl Subject<'_> {
    /// Levels and evidence over the stretch whose speed is known; the answer to the whole sound.
    fn heard(&self, config: &Config) -> Result<Heard, String> {
        let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", self.truth.file);
        let span = self
            .truth
            .span_s
            .map_or_else(SpanConfig::default, |[from_s, to_s]| SpanConfig { from_s: Some(from_s), to_s: Some(to_s) });
        let stretch = Config { span, ..config.clone() };
        let seen = evidence_near(&mut self.sound.clone(), self.true_rev_s, &stretch).map_err(|error| failed(&error))?;
        let answer = answer_to(self.sound.clone(), config).map_err(|error| failed(&error))?;
        let first = answer.alternatives.first().map(|reading| reading.speed_rev_s);
        Ok(Heard {
            told_share: answer.speed_rev_s.or(first).map(|told_rev_s| told_rev_s / self.true_rev_s),
            name: self.truth.file.clone(),
            measured: Measured::of(&seen, self.blades, self.true_rev_s),
            verdict: Expected::of(self.truth, self.flags, &answer, None).verdict(&answer),
        })
    }
}
