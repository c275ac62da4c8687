//! How often a belief is right.

use super::limits::binomial_interval;
use super::rows::{Belief, Row};
use crate::document::Document;
use std::collections::BTreeMap;
use std::ops::Range;

/// Lower edges of the bins of belief; the last bin ends at 1.
const EDGES: [f64; 5] = [0.0, 0.1, 0.5, 0.9, 0.99];
/// Beliefs are written with a few digits.
const ROUNDING: f64 = 1e-9;

/// The beliefs of one bin.
struct Bin<'a> {
    name: String,
    beliefs: Vec<&'a Belief>,
}

/// The edges of each bin.
fn ranges() -> impl Iterator<Item = Range<f64>> {
    let ends = EDGES.iter().skip(1).copied().chain([f64::INFINITY]);
    EDGES.into_iter().zip(ends).map(|(low, high)| low..high)
}

fn name_of(range: &Range<f64>) -> String {
    format!("{}–{}", range.start, range.end.min(1.0))
}

fn is_in(range: &Range<f64>, belief: &Belief) -> bool {
    range.contains(&(belief.belief + ROUNDING))
}

fn bins<'a>(beliefs: &[&'a Belief]) -> Vec<Bin<'a>> {
    let bins = ranges().map(|range| Bin {
        name: name_of(&range),
        beliefs: beliefs.iter().filter(|belief| is_in(&range, belief)).copied().collect(),
    });
    bins.collect()
}

/// The section of the report.
pub(super) fn add_reliability(document: &mut Document, rows: &[Row]) {
    document.heading("Are the plausibilities right?");
    document.paragraph(
        "Of an ambiguous answer, each reading with its own plausibility; of a speed that was told, the plausibility of its reading, or 0.99 where the \
         flags left no choice. Right: a speed of a rotor, or of their mean. Recordings of low confidence are left out. In brackets: the 95 % \
         interval of the share (Clopper and Pearson 1934), as if all answers were independent. Several answers are of one recording, so the \
         true interval is wider.",
    );
    let mut lines = Vec::new();
    for set in ["real", "semi-real"] {
        for is_blind in [true, false] {
            let is_meant =
                |row: &&Row| row.set == set && !row.is_low_confidence && row.mode.starts_with("blind") == is_blind;
            let beliefs: Vec<&Belief> = rows.iter().filter(is_meant).flat_map(|row| &row.beliefs).collect();
            for bin in bins(&beliefs).iter().filter(|bin| !bin.beliefs.is_empty()) {
                let mut line = vec![set.to_owned(), (if is_blind { "nothing" } else { "flags" }).to_owned()];
                line.extend(cells(bin));
                lines.push(line);
            }
        }
    }
    let heads = ["set", "told", "plausibility", "answers", "mean plausibility, %", "right, %"];
    document.table(&heads, &lines);
    add_by_recording(document, rows);
}

/// All sets together, where each recording counts once in each bin.
fn add_by_recording(document: &mut Document, rows: &[Row]) {
    document.paragraph(
        "All of them together, where each recording counts once in a bin, with the mean of its answers there: the answers of one recording to several \
         flags are not independent. The plausibility holds where its mean lies in the 95 % interval of the share that is right.",
    );
    let trusted: Vec<&Row> = rows.iter().filter(|row| !row.is_low_confidence).collect();
    let lines: Vec<Vec<String>> = ranges()
        .filter_map(|range| Some((name_of(&range), Recordings::of(&trusted, &range)?)))
        .map(|(name, recordings)| {
            let limits = binomial_interval(recordings.right.round() as usize, recordings.count);
            let holds = (limits.low..=limits.high).contains(&recordings.mean_belief);
            let share = recordings.right / recordings.count as f64;
            let right = format!("{:.0} ({:.0}–{:.0})", 100.0 * share, 100.0 * limits.low, 100.0 * limits.high);
            let mean = format!("{:.0}", 100.0 * recordings.mean_belief);
            vec![name, recordings.count.to_string(), mean, right, (if holds { "yes" } else { "no" }).to_owned()]
        })
        .collect();
    document.table(&["plausibility", "recordings", "mean plausibility, %", "right, %", "holds"], &lines);
}

/// The recordings with beliefs in one bin.
#[derive(Debug, PartialEq)]
struct Recordings {
    count: usize,
    /// Sum over the recordings of the share of their answers that is right.
    right: f64,
    /// Mean over the recordings of their mean belief.
    mean_belief: f64,
}

impl Recordings {
    /// `None` where no recording has a belief in the range.
    fn of(rows: &[&Row], range: &Range<f64>) -> Option<Self> {
        let mut of_recording: BTreeMap<(&str, &str), Vec<&Belief>> = BTreeMap::new();
        for row in rows {
            for belief in row.beliefs.iter().filter(|belief| is_in(range, belief)) {
                of_recording.entry((&row.set, &row.file)).or_default().push(belief);
            }
        }
        let mean = |beliefs: &[&Belief], value: fn(&Belief) -> f64| {
            beliefs.iter().map(|belief| value(belief)).sum::<f64>() / beliefs.len() as f64
        };
        let sum = |value: fn(&Belief) -> f64| of_recording.values().map(|beliefs| mean(beliefs, value)).sum::<f64>();
        let count = of_recording.len();
        (count > 0).then(|| Self {
            count,
            right: sum(|belief| f64::from(u8::from(belief.is_right))),
            mean_belief: sum(|belief| belief.belief) / count as f64,
        })
    }
}

fn cells(bin: &Bin<'_>) -> [String; 4] {
    let (of, right) = (bin.beliefs.len(), bin.beliefs.iter().filter(|belief| belief.is_right).count());
    let mean = bin.beliefs.iter().map(|belief| belief.belief).sum::<f64>() / of as f64;
    let (share, limits) = (right as f64 / of as f64, binomial_interval(right, of));
    let right = format!("{:.0} ({:.0}–{:.0})", 100.0 * share, 100.0 * limits.low, 100.0 * limits.high);
    [bin.name.clone(), of.to_string(), format!("{:.0}", 100.0 * mean), right]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::judgement::Verdict;
    use crate::real::rows::tests::row;

    #[test]
    fn a_recording_counts_once_in_a_bin() {
        let with = |file: &str, belief: f64, is_right| Row {
            file: file.to_owned(),
            beliefs: vec![Belief { belief, is_right }],
            ..row("c", "blades", Verdict::Right)
        };
        let rows = [with("a", 0.95, false), with("a", 0.97, true), with("b", 0.92, true), with("b", 0.3, false)];
        let rows: Vec<&Row> = rows.iter().collect();
        let found = Recordings::of(&rows, &(0.9..0.99)).unwrap();
        assert_eq!((found.count, found.right), (2, 1.5));
        assert!((found.mean_belief - 0.94).abs() < 1e-12);
        assert_eq!(Recordings::of(&rows, &(0.0..0.1)), None);
    }

    #[test]
    fn beliefs_fall_into_their_bins() {
        let belief = |belief: f64, is_right| Belief { belief, is_right };
        let all = [belief(0.0, false), belief(0.1, false), belief(0.3, true), belief(0.99, true), belief(1.0, false)];
        let found = bins(&all.iter().collect::<Vec<_>>());
        assert_eq!(found.iter().map(|bin| bin.beliefs.len()).collect::<Vec<_>>(), [1, 2, 0, 0, 2]);
        assert_eq!(cells(&found[1]), ["0.1–0.5", "2", "20", "50 (1–99)"]);
        assert_eq!(found[4].name, "0.99–1");
    }
}
