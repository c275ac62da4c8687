//! `cargo run --release -p hovertone-bench -- saying-more`: each error with a fact about the vehicle said, and without it. Writes
//! `docs/saying-more.md`.

mod comparison;
mod flights;
mod subject;

use super::program::Program;
use super::progress::Progress;
use super::{data_folder, semi_real, sentence};
use crate::accuracy::drawn;
use crate::document::Document;
use crate::options::whole_number;
use crate::workspace::{made_by, target};
use comparison::{Compared, Outcome};
use std::fs;
use std::path::Path;
use subject::{FACTS, Subject, Ways};

/// What it writes, in the repository.
const REPORT: &str = "docs/saying-more.md";
/// The flights: seeds 1 to this.
const FLIGHT_COUNT: u64 = 100;
const USAGE: &str = "cargo run --release -p hovertone-bench -- saying-more [--semi-real DIR] [--flights N]";

/// Runs the exam and writes its report.
pub(crate) fn run(root: &Path, words: &[&str]) -> Result<(), String> {
    let (mut semi_real_folder, mut flight_count) = (None, FLIGHT_COUNT);
    for pair in words.chunks(2) {
        match pair {
            ["--semi-real", folder] => semi_real_folder = Some(*folder),
            ["--flights", number] => {
                flight_count = whole_number("--flights", number)?;
            }
            _ => return Err(USAGE.to_owned()),
        }
    }
    let made_by = made_by(root, "saying-more", words);
    let program = Program::found(None)?;
    let set = semi_real::semi_real(root, &data_folder(root, None), semi_real_folder)?;
    let place = target(root).join("bench/saying-more");
    let progress = Progress::new("flights", flight_count as usize);
    let mut compared = drawn(flight_count as usize, |number| {
        let seed = number as u64 + 1;
        let compared = flights::flown(&program, &place.join(seed.to_string()), seed)?.compared(&program)?;
        progress.step();
        Ok(compared)
    })?;
    let progress = Progress::new("semi-real recordings", set.truths.len());
    compared.extend(drawn(set.truths.len(), |number| {
        let compared = Subject::semi_real(&set, &set.truths[number])?.compared(&program)?;
        progress.step();
        Ok(compared)
    })?);
    let compared: Vec<Compared> = compared.into_iter().flatten().collect();
    let text = report(&made_by, &compared);
    fs::write(root.join(REPORT), &text).map_err(|error| format!("{REPORT}: {error}"))?;
    println!("{text}\n{REPORT} is written");
    Ok(())
}

fn report(made_by: &str, compared: &[Compared]) -> String {
    let mut document = Document::default();
    document.paragraph("# Saying more");
    document.paragraph(&format!("{}; not edited by hand.", sentence(made_by)));
    document.paragraph(HEAD);
    document.heading("Counts");
    let heads = ["set", "said more", "beside"].into_iter().chain(Outcome::ALL.map(Outcome::name));
    let heads: Vec<&str> = heads.chain(["largest growth, %"]).collect();
    let mut rows = Vec::new();
    for set in [flights::NAME, semi_real::NAME] {
        for fact in FACTS {
            let of_fact: Vec<&Compared> = compared.iter().filter(|one| one.set == set && one.ways == fact).collect();
            rows.extend((!of_fact.is_empty()).then(|| count_row(set, fact, &of_fact)));
        }
    }
    document.table(&heads, &rows);
    let bad: Vec<&Compared> = compared.iter().filter(|one| one.outcome().is_bad()).collect();
    document.heading("Where saying more is worse");
    if bad.is_empty() {
        document.paragraph("Nowhere.");
    } else {
        let honest = bad.iter().filter(|one| one.is_within_own_uncertainty()).count();
        document.paragraph(&format!(
            "{} of {} comparisons; in {honest} of them the answer with more said is still within its own U.",
            bad.len(),
            compared.len(),
        ));
        let rows: Vec<Vec<String>> = bad.iter().map(|one| one.cells()).collect();
        document.table(&["recording", "without", "error ± U, %", "with", "error ± U, %", "outcome"], &rows);
    }
    document.into_text()
}

fn count_row(set: &str, ways: Ways, compared: &[&Compared]) -> Vec<String> {
    let count = |outcome: Outcome| compared.iter().filter(|one| one.outcome() == outcome).count().to_string();
    let growth = compared.iter().filter_map(|one| one.growth_share()).max_by(f64::total_cmp);
    let growth = growth.map_or("–".to_owned(), |growth| format!("{:.3}", 100.0 * growth.max(0.0)));
    let names = [set, ways.more.name(), ways.less.name()].map(str::to_owned).into_iter();
    names.chain(Outcome::ALL.map(count)).chain([growth]).collect()
}

const HEAD: &str = "Saying more of the vehicle should never make the answer worse. Each recording is heard by `hovertone speed` with and \
    without a fact, and the errors of both mean speeds against the true mean of all rotors over the analysed stretch are compared. \
    *Alike*: the error with the fact is at most the error without it plus the expanded uncertainty U (k = 2) that the answer without it states, and not \
    smaller by more. *Better* and *worse*: it is smaller, or larger, by more than that. *Found*: a speed where there was none. *Withdrawn*: none \
    where the speed was more than 1 % off. *Lost*: none where the speed was less than 1 % off. *Misled*: a speed more than 1 % off where there was none. \
    *Silent*: none, with and without. The ± itself is not counted: a fact that makes \
    the ± larger, or too small for the error, is *alike* here. The simulated flights are random hovers; the semi-real recordings are sums \
    of real single rotors.";
