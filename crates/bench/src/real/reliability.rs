//! How often a belief is right.

use super::limits::binomial_interval;
use super::rows::{Belief, Row};
use crate::document::Document;

/// Lower edges of the bins of belief; the last bin ends at 1.
const EDGES: [f64; 5] = [0.0, 0.1, 0.5, 0.9, 0.99];
/// Beliefs are written with a few digits.
const ROUNDING: f64 = 1e-9;

/// The beliefs of one bin.
struct Bin<'a> {
    name: String,
    beliefs: Vec<&'a Belief>,
}

fn bins<'a>(beliefs: &[&'a Belief]) -> Vec<Bin<'a>> {
    let ends = EDGES.iter().skip(1).copied().chain([f64::INFINITY]);
    let bins = EDGES.into_iter().zip(ends).map(|(low, high)| Bin {
        name: format!("{low}–{}", if high.is_finite() { high } else { 1.0 }),
        beliefs: beliefs.iter().filter(|belief| (low..high).contains(&(belief.belief + ROUNDING))).copied().collect(),
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
