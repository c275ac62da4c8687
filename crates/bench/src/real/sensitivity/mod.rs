//! `cargo run --release -p hovertone-bench -- sensitivity`: one step each way for each number of the settings, on the real recordings. Writes
//! `docs/sensitivity.md`.

mod constants;
mod numbers;
mod trial;

use super::cases::{Told, TruthSet};
use super::judgement::{Expected, Verdict};
use super::library::LoadedCase;
use super::progress::Progress;
use super::{Mode, REAL, data_folder, sentence};
use crate::accuracy::drawn;
use crate::document::{Document, three_digits};
use crate::workspace::made_by;
use constants::decision_constants;
use hovertone::speed::Config;
use numbers::Number;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use trial::Trial;

/// What it writes, in the repository.
const REPORT: &str = "docs/sensitivity.md";
/// Heading of the list of constants.
const CONSTANTS: &str = "Constants";
/// One step down, and one step up.
const FACTORS: [f64; 2] = [0.7, 1.4];

/// Runs the exam and writes its report.
pub(crate) fn run(root: &Path, words: &[&str]) -> Result<(), String> {
    let (data, tried) = match words {
        [] => (None, None),
        ["--constants"] => return rewrite_constants(root),
        ["--data", folder] => (Some(*folder), None),
        ["--try", values] => (None, Some(*values)),
        ["--data", folder, "--try", values] => (Some(*folder), Some(*values)),
        _ => {
            return Err(
                "cargo run --release -p hovertone-bench -- sensitivity [--constants | --data DIR] [--try NAME=VALUE,…]"
                    .to_owned(),
            );
        }
    };
    let made_by = made_by(root, "sensitivity", words);
    let set = TruthSet::read(REAL, &data_folder(root, data).join("real"))?;
    let cases = LoadedCase::all(&set, |told| matches!(told, Told::Blades | Told::Known))?;
    let Some(first) = cases.first() else { return Err("no case has blades alone, or with the vehicle".to_owned()) };
    let numbers = Number::all(&first.config()?)?;
    let usual = verdicts(&cases, Ok)?;
    if let Some(values) = tried {
        let trial = Trial::read(values, &numbers)?;
        print_changes(&cases, &usual, &verdicts(&cases, |config| trial.applied(config))?);
        return Ok(());
    }
    let usual = Counts::of(&cases, &usual);
    println!("as it is: {}", usual.text());
    let progress = Progress::new("steps", numbers.len() * FACTORS.len());
    let mut rows = Vec::new();
    for number in &numbers {
        let mut row = vec![format!("`{}`", number.full_name()), three_digits(Some(number.value))];
        for factor in FACTORS {
            let value = number.times(factor);
            let stepped = verdicts(&cases, |config| number.put(&config, value));
            row.push(stepped.map_or_else(|refused| refused, |stepped| Counts::of(&cases, &stepped).against(&usual)));
            progress.step();
        }
        rows.push(row);
    }
    let text = report(root, &made_by, &usual, &rows)?;
    fs::write(root.join(REPORT), text).map_err(|error| format!("{REPORT}: {error}"))?;
    println!("{REPORT} is written");
    Ok(())
}

/// How many cases of each mode had each kind of answer.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Counts {
    blades: ModeCounts,
    known: ModeCounts,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct ModeCounts {
    right: i32,
    ambiguous: i32,
    wrong: i32,
    silent: i32,
}

impl ModeCounts {
    fn add(&mut self, verdict: Verdict) {
        let count = match verdict {
            // rotors are not separated: the speed of one of them is right
            Verdict::Right | Verdict::MeanOff => &mut self.right,
            Verdict::Wrong | Verdict::Octave => &mut self.wrong,
            Verdict::Silent => &mut self.silent,
            Verdict::First | Verdict::Listed | Verdict::Missing => &mut self.ambiguous,
        };
        *count += 1;
    }

    fn text(self) -> String {
        let Self { right, ambiguous, wrong, silent } = self;
        format!("{right} right, {ambiguous} ambiguous, {wrong} wrong, {silent} silent")
    }

    /// The differences from other counts: "right −2, ambiguous +2".
    fn against(self, other: Self) -> String {
        let differences = [
            ("right", self.right - other.right),
            ("ambiguous", self.ambiguous - other.ambiguous),
            ("wrong", self.wrong - other.wrong),
            ("silent", self.silent - other.silent),
        ];
        let mut text = String::new();
        for (name, difference) in differences.into_iter().filter(|(_, difference)| *difference != 0) {
            let sign = if difference > 0 { '+' } else { '−' };
            let comma = if text.is_empty() { "" } else { ", " };
            let _ = write!(text, "{comma}{name} {sign}{}", difference.abs());
        }
        text
    }
}

impl Counts {
    fn of(cases: &[LoadedCase<'_>], verdicts: &[Verdict]) -> Self {
        let mut counts = Self::default();
        for (loaded, verdict) in cases.iter().zip(verdicts) {
            match Mode::of(loaded.case.flags).told {
                Told::Known => counts.known.add(*verdict),
                _ => counts.blades.add(*verdict),
            }
        }
        counts
    }

    fn text(&self) -> String {
        format!("with blades {}; with blades, rotors, diameter and mass {}", self.blades.text(), self.known.text())
    }

    fn against(&self, other: &Self) -> String {
        let (blades, known) = (self.blades.against(other.blades), self.known.against(other.known));
        match (blades.is_empty(), known.is_empty()) {
            (true, true) => "–".to_owned(),
            (false, true) => blades,
            (true, false) => format!("known: {known}"),
            (false, false) => format!("{blades}; known: {known}"),
        }
    }
}

/// The verdict on each case with settings made of the default ones.
fn verdicts(
    cases: &[LoadedCase<'_>],
    settings: impl Fn(Config) -> Result<Config, String> + Sync,
) -> Result<Vec<Verdict>, String> {
    drawn(cases.len(), |number| {
        let loaded = &cases[number];
        let answer = loaded.answer(&settings(loaded.config()?)?)?;
        Ok(Expected::of(loaded.case.truth, loaded.case.flags, &answer, None).verdict(&answer))
    })
}

/// Prints the counts with other settings, and each case whose verdict changes.
fn print_changes(cases: &[LoadedCase<'_>], usual: &[Verdict], tried: &[Verdict]) {
    println!("as it is: {}\ntried: {}", Counts::of(cases, usual).text(), Counts::of(cases, tried).text());
    for ((loaded, usual), tried) in cases.iter().zip(usual).zip(tried).filter(|((_, usual), tried)| usual != tried) {
        println!("{} {}: {usual:?} → {tried:?}", loaded.case.truth.file, loaded.case.flags.join(" "));
    }
}

fn report(root: &Path, made_by: &str, usual: &Counts, rows: &[Vec<String>]) -> Result<String, String> {
    let mut document = Document::default();
    document.paragraph("# Sensitivity");
    document.paragraph(&format!("{}; not edited by hand.", sentence(made_by)));
    document.paragraph(HEAD);
    document.paragraph(&format!("As it is: {}.", usual.text()));
    document.heading("Settings");
    document.table(&["number", "value", "× 0.7", "× 1.4"], rows);
    list_constants(root, &mut document)?;
    Ok(document.into_text())
}

/// The decision constants of today's sources below what was measured before: a list needs no hour.
fn rewrite_constants(root: &Path) -> Result<(), String> {
    let path = root.join(REPORT);
    let failed = |error: std::io::Error| format!("{REPORT}: {error}");
    let text = fs::read_to_string(&path).map_err(failed)?;
    let (measured, _) =
        text.split_once(&format!("## {CONSTANTS}\n")).ok_or(format!("{REPORT} has no list of constants"))?;
    let mut list = Document::default();
    list_constants(root, &mut list)?;
    fs::write(&path, format!("{measured}{}", list.into_text().trim_start())).map_err(failed)
}

fn list_constants(root: &Path, document: &mut Document) -> Result<(), String> {
    let constants = decision_constants(root)?;
    document.heading(CONSTANTS);
    document.paragraph(&format!(
        "{} decision constants of `rotor-speed` are no settings yet, so that no step was taken:",
        constants.len()
    ));
    let rows: Vec<Vec<String>> = constants.into_iter().map(|constant| vec![constant.file, constant.names]).collect();
    document.table(&["file", "constants"], &rows);
    Ok(())
}

const HEAD: &str = "The numbers of the settings that decide, and what one step each way changes on the trusted real recordings: with blades \
    alone, and with blades, rotors, diameter and mass (“known”). Rotors are not separated here. A share above one half is \
    stepped by its distance from 1. Each cell says how many cases more or fewer are right, ambiguous, wrong (an octave off, or another \
    speed) or silent; “–” is no change. A setting that its limits refuse says so.";

#[cfg(test)]
mod tests {
    use super::{Counts, ModeCounts};

    #[test]
    fn differences_name_what_changes() {
        let usual = ModeCounts { right: 78, ambiguous: 2, wrong: 2, silent: 0 };
        let stepped = ModeCounts { right: 75, ambiguous: 5, wrong: 1, silent: 1 };
        assert_eq!(stepped.against(usual), "right −3, ambiguous +3, wrong −1, silent +1");
        let of = |blades, known| Counts { blades, known };
        assert_eq!(of(usual, usual).against(&of(usual, usual)), "–");
        assert_eq!(of(usual, stepped).against(&of(usual, usual)), "known: right −3, ambiguous +3, wrong −1, silent +1");
    }
}
