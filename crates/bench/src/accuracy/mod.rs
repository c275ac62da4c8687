//! How accurate: one rotor against the Cramér-Rao bound, the stated ± against the truth, the programs that others use on
//! the same recordings in the same run, a real motor, and the cost of a long file. Writes `docs/accuracy.md`. Run by
//! people, never in a test.
//!
//! The truth is made here (`sound`) or by the peers' own scripts in `../shared/peers`, which are run where they lie and
//! never copied; without them that part is left out. The peers are installed by `--install-peers` (a virtual environment
//! and node packages under `target/accuracy`; needs `python3` and `npm`) and, for aubio, by `apt-get install aubio-tools`.
//! A peer that is not there is left out, and the report says so.

mod bound;
mod condition;
mod draws;
mod four_rotors;
mod long_file;
mod peers;
mod real_motor;
mod single_rotor;
mod sound;
mod track;
mod workbench;

use crate::document::Document;
use crate::options::whole_number;
use crate::workspace::made_by;
pub(crate) use draws::drawn;
use std::fs;
use std::path::Path;
pub(crate) use workbench::Workbench;

/// What it writes, in the repository.
const REPORT: &str = "docs/accuracy.md";
/// Draws for each condition of the table of bounds.
const DRAWS: usize = 200;
/// Draws for each condition of the table of coverage.
const COVERAGE_DRAWS: usize = 2000;

/// The parts in their order, by the name that `--only` takes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    Bounds,
    Coverage,
    FourRotors,
    RealMotor,
    LongFile,
}

impl Part {
    const ALL: [(&'static str, Self); 5] = [
        ("bounds", Self::Bounds),
        ("coverage", Self::Coverage),
        ("four-rotors", Self::FourRotors),
        ("real-motor", Self::RealMotor),
        ("long-file", Self::LongFile),
    ];
}

#[derive(Debug, PartialEq)]
struct Options {
    draws: usize,
    coverage_draws: usize,
    minutes: u32,
    install_peers: bool,
    /// One part: printed, and written in its place in the report.
    only: Option<Part>,
}

pub(crate) fn run(root: &Path, words: &[&str]) -> Result<(), String> {
    let options = options_of(words)?;
    let workbench = Workbench::beside(root);
    if options.install_peers
        && let Some(workbench) = &workbench
    {
        workbench.install()?;
    }
    let mut document = Document::default();
    if options.only.is_none() {
        add_head(&mut document, root, words);
    }
    for (_, part) in Part::ALL.into_iter().filter(|(_, part)| options.only.is_none_or(|only| only == *part)) {
        match part {
            Part::Bounds => single_rotor::add_bounds(&mut document, options.draws)?,
            Part::Coverage => single_rotor::add_coverage(&mut document, options.coverage_draws)?,
            Part::FourRotors => four_rotors::add_four_rotors(&mut document, workbench.as_ref())?,
            Part::RealMotor => real_motor::add_real_motor(&mut document, root)?,
            Part::LongFile => long_file::add_long_file(&mut document, root, options.minutes)?,
        }
    }
    let mut text = document.into_text();
    if options.only.is_some() {
        println!("{text}");
        let before = fs::read_to_string(root.join(REPORT)).map_err(|error| format!("{REPORT}: {error}"))?;
        text = with_section(&before, &text, &made_by(root, "accuracy", words));
    }
    fs::write(root.join(REPORT), text).map_err(|error| format!("{REPORT}: {error}"))?;
    println!("{REPORT} is written");
    Ok(())
}

/// A report with one section in the place of the old one, and what it was made by.
fn with_section(report: &str, section: &str, made_by: &str) -> String {
    let (heading, body) = section.trim_start().split_once('\n').unwrap_or((section, ""));
    let from = report.find(heading).unwrap_or(report.len());
    let end = report[from..].match_indices("\n## ").map(|(at, _)| from + at + 1).next().unwrap_or(report.len());
    let section = format!("{heading}\n\nThis section: {made_by}.\n\n{}\n", body.trim());
    let rest = &report[end..];
    format!("{}{section}{}{rest}", &report[..from], if rest.is_empty() { "" } else { "\n" })
}

fn add_head(document: &mut Document, root: &Path, words: &[&str]) {
    document.paragraph("# How accurate");
    document.paragraph(&format!(
        "All but the sections that say otherwise were {}; not edited by hand. Recommended settings throughout: nothing is told but \
         what the flags named here say. Every sound is drawn from fixed seeds, whatever the number of cores, so that another \
         run repeats all numbers but the numbers of the long file (and the other programs', as long as their versions stay). Errors of the speed count double in the thrust constant.",
        made_by(root, "accuracy", words),
    ));
}

fn options_of(words: &[&str]) -> Result<Options, String> {
    let mut options = Options {
        draws: DRAWS,
        coverage_draws: COVERAGE_DRAWS,
        minutes: crate::speed::MINUTES,
        install_peers: false,
        only: None,
    };
    let mut words = words.iter();
    while let Some(name) = words.next() {
        if *name == "--install-peers" {
            options.install_peers = true;
            continue;
        }
        let value = words.next().ok_or_else(usage)?;
        let count = || whole_number(name, value);
        match *name {
            "--draws" => options.draws = count()?,
            "--coverage" => options.coverage_draws = count()?,
            "--minutes" => options.minutes = whole_number(name, value)?,
            "--only" => {
                let part = Part::ALL.iter().find(|(part_name, _)| part_name == value).ok_or_else(usage)?;
                options.only = Some(part.1);
            }
            _ => return Err(usage()),
        }
    }
    Ok(options)
}

fn usage() -> String {
    let parts = Part::ALL.map(|(name, _)| name).join("|");
    format!(
        "cargo run --release -p hovertone-bench -- accuracy [--draws N] [--coverage N] [--minutes N] [--install-peers] [--only {parts}]"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_takes_the_place_of_the_old_one() {
        let report = "# A\n\nhead\n\n## B\n\nold\n\n## C\n\nlast\n";
        let made = with_section(report, "## B\n\nnew\n\n", "me");
        assert_eq!(made, "# A\n\nhead\n\n## B\n\nThis section: me.\n\nnew\n\n## C\n\nlast\n");
        assert_eq!(with_section(&made, "## C\n\nnewer\n", "you").matches("## C").count(), 1);
        let last = with_section(report, "## C\n\nnewer", "me");
        assert!(last.ends_with("old\n\n## C\n\nThis section: me.\n\nnewer\n"), "{last}");
    }

    #[test]
    fn options_are_read() {
        let options =
            options_of(&["--draws", "7", "--install-peers", "--only", "long-file", "--minutes", "2"]).unwrap();
        let only = Some(Part::LongFile);
        let expected = Options { draws: 7, coverage_draws: COVERAGE_DRAWS, minutes: 2, install_peers: true, only };
        assert_eq!(options, expected);
        for words in [&["--draws"][..], &["--draws", "x"], &["--only", "all"], &["7", "8"]] {
            assert!(options_of(words).is_err(), "{words:?}");
        }
    }
}
