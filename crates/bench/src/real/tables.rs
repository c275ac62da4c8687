//! The outcomes as tables: by class and mode, several rotors, and every case that is not right.

use super::causes::{Causes, TABLE};
use super::judgement::Verdict;
use super::rotors_told::{ExactRotors, RotorCount};
use super::rows::Row;
use crate::document::Document;
use std::collections::BTreeMap;

/// The name of the lines of totals.
const TOTAL: &str = "all";

/// A line of the table of outcomes: classes in their order, the totals last.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Line {
    is_total: bool,
    class: String,
    mode: String,
}

/// How many cases of a line were judged so, in the order of [`Verdict::ALL`].
type Counts = [usize; Verdict::ALL.len()];

fn outcomes<'a>(rows: impl Iterator<Item = &'a Row>) -> BTreeMap<Line, Counts> {
    let mut lines: BTreeMap<Line, Counts> = BTreeMap::new();
    for row in rows {
        let of_class = Line { is_total: false, class: row.trusted_class(), mode: row.mode.clone() };
        let of_all = Line { is_total: true, class: TOTAL.to_owned(), mode: row.mode.clone() };
        let Some(place) = Verdict::ALL.iter().position(|verdict| *verdict == row.verdict) else { continue };
        for line in [Some(of_class), Some(of_all).filter(|_| !row.is_low_confidence)].into_iter().flatten() {
            lines.entry(line).or_default()[place] += 1;
        }
    }
    lines
}

/// The outcomes of one set: by class and mode, and in total by mode.
pub(super) fn add_outcomes(document: &mut Document, rows: &[Row], set: &str) {
    let heads: Vec<&str> = ["class", "mode"].into_iter().chain(Verdict::ALL.map(Verdict::name)).collect();
    let cells = |(line, counts): (Line, Counts)| {
        let class = if line.is_total { format!("**{}**", line.class) } else { line.class };
        [class, line.mode].into_iter().chain(counts.map(|count| count.to_string())).collect()
    };
    let lines: Vec<Vec<String>> = outcomes(rows.iter().filter(|row| row.set == set)).into_iter().map(cells).collect();
    document.table(&heads, &lines);
}

/// How often several rotors were told, against the exact truth; nothing where no set has it.
pub(super) fn add_exact_rotors(document: &mut Document, rows: &[Row]) {
    let mut modes: BTreeMap<&str, Vec<&ExactRotors>> = BTreeMap::new();
    for row in rows {
        if let Some(exact) = &row.exact_rotors {
            modes.entry(&row.mode).or_default().push(exact);
        }
    }
    if modes.is_empty() {
        return;
    }
    document.paragraph(
        "Four rotors against their exact truth over the analysed stretch: answers whose mean, mean square, or each rotor is within 0.3 %, and \
         answers whose mean is within 2 u. Too many: more rotors are told than turn. Apart: each rotor is within 0.3 %, of the answers for rotors whose means are all at least 0.9 % \
         apart. Rotors: those within 2 u of their own, of all in answers with four. Most clips with closer \
         rotors hold a motor and the same recording backwards. These two cross, and their lines are alike: which is which cannot be heard.",
    );
    let heads = [
        "mode",
        "answers",
        "mean",
        "mean square",
        "within 2 u",
        "each rotor",
        "too many",
        "apart",
        "rotors within 2 u",
    ];
    let lines: Vec<Vec<String>> = modes
        .into_iter()
        .map(|(mode, all)| {
            let sum = |of: fn(&ExactRotors) -> usize| all.iter().map(|exact| of(exact)).sum::<usize>();
            let count = |is: &dyn Fn(&ExactRotors) -> bool| all.iter().filter(|exact| is(exact)).count().to_string();
            vec![
                mode.to_owned(),
                all.len().to_string(),
                count(&|exact| exact.is_mean_told),
                count(&|exact| exact.is_mean_square_told),
                count(&|exact| exact.is_within_2u),
                count(&|exact| exact.is_each_told),
                count(&|exact| exact.are_too_many),
                format!(
                    "{} of {}",
                    count(&|exact| exact.are_apart && exact.is_each_told),
                    count(&|exact| exact.are_apart)
                ),
                format!("{} of {}", sum(|exact| exact.rotors_within_2u), sum(|exact| exact.rotors_told)),
            ]
        })
        .collect();
    document.table(&heads, &lines);
}

/// The separated rotors by class.
pub(super) fn add_rotor_counts(document: &mut Document, rows: &[Row], set: &str) {
    let mut classes: BTreeMap<&str, RotorCount> = BTreeMap::new();
    for row in rows.iter().filter(|row| row.set == set) {
        if let Some(count) = row.rotor_count {
            let sum = classes.entry(&row.class).or_default();
            *sum = sum.plus(count);
        }
    }
    if classes.is_empty() {
        return;
    }
    document.paragraph(
        "Separated rotors: how many were told, how many of them lie within the tolerance of a true rotor, and how many lie outside the range \
         of all rotors (by more than 2 %).",
    );
    let lines: Vec<Vec<String>> = classes
        .into_iter()
        .map(|(class, count)| {
            let numbers = [count.told, count.good, count.outside].map(|number| number.to_string());
            [class.to_owned()].into_iter().chain(numbers).collect()
        })
        .collect();
    document.table(&["class", "told", "good", "outside"], &lines);
}

/// Every case that is not right, with the reason that the program gave and the cause that a person found.
pub(super) fn add_not_right(document: &mut Document, rows: &[Row], causes: &Causes) {
    document.heading("Cases that are not right");
    document.paragraph(&format!(
        "Answers and accepted ranges in rev/s. The cause is what a person found, from the table `{TABLE}`; empty where no one has looked.",
    ));
    let heads = ["class", "mode", "file", "flags", "outcome", "answer", "accepted", "reason", "cause"];
    let mut wanted: Vec<&Row> = rows.iter().filter(|row| row.verdict != Verdict::Right).collect();
    // real before semi-real; wrong before octaves before open answers before silence
    let rank = |verdict: Verdict| match verdict {
        Verdict::Wrong => 0,
        Verdict::Octave => 1,
        Verdict::MeanOff => 2,
        Verdict::Missing => 3,
        Verdict::Listed => 4,
        Verdict::First => 5,
        Verdict::Silent | Verdict::Right => 6,
    };
    wanted.sort_by_key(|row| (row.set != "real", row.is_low_confidence, rank(row.verdict)));
    let lines: Vec<Vec<String>> = wanted
        .into_iter()
        .map(|row| {
            let reason = row.reason.as_deref().filter(|_| row.note.is_empty()).unwrap_or_default();
            vec![
                row.trusted_class(),
                row.mode.clone(),
                row.file_name().to_owned(),
                row.flags.clone(),
                row.verdict.name().to_owned(),
                row.answer(),
                row.accepted(),
                in_a_cell(reason),
                in_a_cell(causes.of(row)),
            ]
        })
        .collect();
    document.table(&heads, &lines);
}

/// Text that does not end the cell or the line of a table.
fn in_a_cell(text: &str) -> String {
    text.replace('|', "\\|").split_whitespace().collect::<Vec<_>>().join(" ")
}

/// One line for a terminal.
pub(super) fn line_of(row: &Row) -> String {
    format!(
        "{:24} {:13} {:8} {:40} [{}] {} accepted {} {}",
        row.trusted_class(),
        row.mode,
        row.verdict.name(),
        row.file_name(),
        row.flags,
        row.answer(),
        row.accepted(),
        row.reason.as_deref().unwrap_or_default()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::rows::tests::row;

    #[test]
    fn low_confidence_stands_apart_and_is_not_in_the_total() {
        let low = Row { is_low_confidence: true, ..row("a", "blades", Verdict::Wrong) };
        let rows = [row("b", "blades", Verdict::Right), row("a", "blades", Verdict::Octave), low];
        let found: Vec<(String, Counts)> =
            outcomes(rows.iter()).into_iter().map(|(line, counts)| (line.class, counts)).collect();
        assert_eq!(found[0], ("a".to_owned(), [0, 0, 1, 0, 0, 0, 0, 0]));
        assert_eq!(found[1], ("a (low confidence)".to_owned(), [0, 1, 0, 0, 0, 0, 0, 0]));
        assert_eq!(found[3], (TOTAL.to_owned(), [1, 0, 1, 0, 0, 0, 0, 0]));
    }

    #[test]
    fn the_list_has_reason_and_cause_and_no_right_case() {
        let silent = Row { reason: Some("too | quiet".to_owned()), ..row("a", "blades", Verdict::Silent) };
        let rows = [silent, row("right", "blades", Verdict::Right), row("wrong", "known", Verdict::Wrong)];
        let causes = Causes::for_test("file,mode,cause\na.wav,blades,far away\n");
        let mut document = Document::default();
        add_not_right(&mut document, &rows, &causes);
        let text = document.into_text();
        assert!(text.contains("too \\| quiet | far away |"), "{text}");
        assert!(!text.contains("| right |") && text.find("| wrong |") < text.find("| silent |"), "{text}");
    }
}
