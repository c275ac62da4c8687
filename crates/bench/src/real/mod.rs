//! `cargo run --release -p hovertone-bench -- real`: the program on real recordings, judged against what is known of them. Writes
//! `docs/real-sound.md` and `docs/real-sound.png`.
//!
//! ```text
//! cases ─▶ program ─▶ answer ─▶ judgement ─▶ rows ─▶ tables, reliability, false alarms, contact sheet
//! ```
//!
//! The recordings are no part of the project: `../shared/data` holds them, with their truth.

mod answer;
mod cases;
mod causes;
mod contact_sheet;
mod decoys;
mod false_alarms;
mod floors;
mod hearing;
mod judgement;
pub(crate) mod levels;
mod library;
mod limits;
mod microphones;
mod options;
mod peers;
mod program;
mod progress;
mod prototype;
mod reliability;
mod rotors_told;
mod rows;
pub(crate) mod saying_more;
mod semi_real;
pub(crate) mod sensitivity;
mod tables;
mod truth_track;

use crate::document::Document;
use crate::workspace::{made_by, target};
use cases::{Mode, TruthSet};
use causes::Causes;
use judgement::Verdict;
use options::Options;
use peers::Peers;
use program::Program;
use rows::{Row, changes, read_rows, write_rows};
use std::fs;
use std::path::{Path, PathBuf};

/// What it writes, in the repository.
const REPORT: &str = "docs/real-sound.md";
const SHEET: &str = "docs/real-sound.png";
/// The name of the set of recordings as they are.
const REAL: &str = "real";

pub(crate) fn run(root: &Path, words: &[&str]) -> Result<(), String> {
    let options = Options::from_words(words)?;
    // before anything is written: it says whether the workspace has changes
    let made_by = made_by(root, "real", words);
    let program = Program::found(options.hovertone.as_deref())?;
    if options.hovertone.is_none() && program.is_older_than_sources(root) {
        eprintln!(
            "{} is older than the sources: build it anew, or these are the answers of before",
            program.path().display()
        );
    }
    let data = data_folder(root, options.data.as_deref());
    let Sets { real, semi_real, missing } = Sets::read(root, &data, &options)?;
    let mut rows = hearing::heard(&real, &program)?;
    if let Some(set) = &semi_real {
        rows.extend(hearing::heard(set, &program)?);
    }
    let out = options.out.as_ref().map_or_else(|| target(root).join("real").join(options.rows_name()), PathBuf::from);
    let before = options.compare.as_ref().map(|path| read_rows(Path::new(path))).transpose()?;
    write_rows(&out, &rows)?;
    print_rows(&rows, options.all);
    if let Some(before) = before {
        println!("\n{}", changes(&before, &rows));
    }
    if options.ci {
        return floors::check(&rows);
    }
    if options.is_whole() {
        let sheet = contact_sheet::contact_sheet(&real, &program, &rows)?;
        fs::write(root.join(SHEET), sheet).map_err(|error| format!("{SHEET}: {error}"))?;
        let semi_real = semi_real.as_ref();
        let examined =
            Examined { real: &real, semi_real, rows: &rows, missing: &missing, data: &data, program: &program };
        let text = report(root, &made_by, &examined, &options.peers)?;
        fs::write(root.join(REPORT), text).map_err(|error| format!("{REPORT}: {error}"))?;
        println!("{REPORT} is written; the rows are in {}", out.display());
    }
    Ok(())
}

/// The recordings to hear.
struct Sets {
    real: TruthSet,
    semi_real: Option<TruthSet>,
    /// Why parts are left out.
    missing: Vec<String>,
}

impl Sets {
    fn read(root: &Path, data: &Path, options: &Options) -> Result<Self, String> {
        let mut real = TruthSet::read(REAL, &data.join("real"))
            .map_err(|error| format!("{error}: say where the recordings are by --data DIR or HOVERTONE_TEST_DATA"))?;
        let (mut semi_real, mut missing) = (None, Vec::new());
        if !options.ci {
            match semi_real::semi_real(root, data, options.semi_real.as_deref()) {
                Ok(set) => semi_real = Some(set),
                Err(error) => {
                    eprintln!("the semi-real recordings are left out: {error}");
                    missing.push(error);
                }
            }
        }
        let mut count = 0;
        for set in [Some(&mut real), semi_real.as_mut()].into_iter().flatten() {
            set.keep(|truth| options.only.as_ref().is_none_or(|only| truth.class == *only));
            set.keep(|truth| !options.ci || floors::is_in_subset(truth));
            count += set.truths.len();
        }
        match &options.only {
            Some(only) if count == 0 => Err(format!("there is no recording of class {only}")),
            _ => Ok(Self { real, semi_real, missing }),
        }
    }
}

/// Where the recordings are.
fn data_folder(root: &Path, given: Option<&str>) -> PathBuf {
    let named = given.map(PathBuf::from).or_else(|| std::env::var_os("HOVERTONE_TEST_DATA").map(PathBuf::from));
    named.unwrap_or_else(|| root.join("../shared/data"))
}

fn print_rows(rows: &[Row], all: bool) {
    for row in rows.iter().filter(|row| all || row.verdict != Verdict::Right) {
        println!("{}", tables::line_of(row));
    }
    let mut document = Document::default();
    add_outcomes(&mut document, rows);
    println!("\n{}", document.into_text());
}

/// The tables of outcomes of all sets.
fn add_outcomes(document: &mut Document, rows: &[Row]) {
    for (set, title) in [(REAL, "Real recordings"), (semi_real::NAME, "Semi-real recordings")] {
        if rows.iter().any(|row| row.set == set) {
            document.heading(title);
            tables::add_outcomes(document, rows, set);
            tables::add_rotor_counts(document, rows, set);
        }
    }
    tables::add_exact_rotors(document, rows);
}

/// What the report is made of.
struct Examined<'a> {
    real: &'a TruthSet,
    semi_real: Option<&'a TruthSet>,
    rows: &'a [Row],
    /// Why parts are left out.
    missing: &'a [String],
    data: &'a Path,
    program: &'a Program,
}

fn report(root: &Path, made_by: &str, examined: &Examined<'_>, peers_of: &[String]) -> Result<String, String> {
    let Examined { real, semi_real, rows, missing, data, program } = *examined;
    let causes = Causes::read(root)?;
    for line in causes.stale(rows) {
        eprintln!("{}: the line {line} explains no case that is not right: remove it", causes::TABLE);
    }
    let mut document = Document::default();
    document.paragraph("# Real sound");
    document.paragraph(&format!("{}; not edited by hand.", sentence(made_by)));
    document.paragraph(HEAD);
    for reason in missing {
        document.paragraph(&format!("The semi-real recordings are left out: {reason}."));
    }
    document.paragraph("![Spectrograms of the recordings with our tracks](real-sound.png)");
    add_outcomes(&mut document, rows);
    reliability::add_reliability(&mut document, rows);
    false_alarms::add_false_alarms(&mut document, rows);
    decoys::add_decoys(&mut document, real)?;
    microphones::add_microphones(&mut document, &data.join("real"), program)?;
    if !peers_of.is_empty() {
        let is_meant = |set: &&TruthSet| peers_of.iter().any(|name| name == set.name);
        let sets: Vec<&TruthSet> = [Some(real), semi_real].into_iter().flatten().filter(is_meant).collect();
        let peers = Peers { root, data, semi_real, program };
        peers::add_peers(&mut document, &peers, &sets, rows, made_by)?;
    } else if let Some(kept) = peers::kept_section(&fs::read_to_string(root.join(REPORT)).unwrap_or_default()) {
        document.markdown(kept);
    }
    tables::add_not_right(&mut document, rows, &causes);
    Ok(document.into_text())
}

/// With a capital letter.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

const HEAD: &str = "Each recording is heard as a user would: by the command `hovertone speed`, once for each line of flags. Modes: *blind*, \
    nothing is told; *blades*, the blades, the order or the vehicle; *rotors4*, blades and number of rotors; *known*, also diameter and mass; \
    *+span*, also the stretch. Outcomes: *right*, the mean lies in the accepted range (or within 3 u of it, u at most 0.1 %), and for recordings \
    without a rotor no speed is told; *octave*, twice, half, three times, … of the answer would be right; *wrong*, any other speed; *mean off*, \
    a speed between the slowest and the fastest rotor where their mean was asked for; *first*, *listed*, *missing*, an ambiguous answer with \
    the truth first, further down, or absent among its readings; *silent*, no speed where a rotor sounds. Recordings whose truth is not trusted \
    (low confidence) stand apart and are not in the totals. The ranges of flights reach from the slowest to the fastest rotor: they test octaves \
    and gross errors, not the last digit. The semi-real recordings are sums of real single rotors, whose speeds are known at every instant.";

#[cfg(test)]
mod tests {
    use super::{data_folder, run, sentence};
    use crate::workspace::root;

    #[test]
    #[ignore = "exam: the command on the recordings of `real --ci`"]
    fn real_sound_is_heard_no_worse_than_before() {
        let data = data_folder(&root(), None);
        if !data.join("real/truth.json").is_file() {
            println!("skipped: no test recordings at {} (set HOVERTONE_TEST_DATA)", data.display());
            return;
        }
        run(&root(), &["--ci"]).unwrap();
    }

    #[test]
    fn a_sentence_has_a_capital_letter() {
        assert_eq!((sentence("made by"), sentence("")), ("Made by".to_owned(), String::new()));
    }
}
