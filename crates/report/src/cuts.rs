//! The cuts of a recording on one line.

use crate::number::DASH;
use hovertone_analysis::{Cut, CutReason, Span};
use std::collections::BTreeSet;

/// Most stretches on the line; the others are summed up.
const STRETCHES_MAX: usize = 6;
/// Most used stretches that stand in a table.
const SEGMENTS_SHOWN: usize = 2;
/// Cuts with a smaller gap count as adjacent.
const TOUCHING_S: f64 = 1e-6;

/// A stretch of cuts that follow each other, with the time that each reason cuts of it. A hover's edge belongs to the stretch beside it.
struct Stretch {
    span: Span,
    reasons: Vec<(&'static str, f64)>,
}

/// "4.4 s each: handling noise, silence": the sum and the reasons, by which recordings are alike; `None` where nothing was cut.
pub(crate) fn cut_in_short(cuts: &[Cut]) -> Option<String> {
    let stretches = joined(cuts);
    let reasons: BTreeSet<&str> = stretches.iter().flat_map(Stretch::names).collect();
    let sum_s: f64 = stretches.iter().map(|stretch| stretch.span.length_s()).sum();
    let reasons = reasons.into_iter().collect::<Vec<_>>().join(", ");
    (!stretches.is_empty()).then(|| format!("{sum_s:.1} s each: {reasons}"))
}

/// "0.0–1.6 s (silence, transition to or from the hover), 6.2–7.0 s (handling noise)"; `None` where nothing was cut.
pub fn cuts_in_words(cuts: &[Cut]) -> Option<String> {
    let stretches = joined(cuts);
    if stretches.is_empty() {
        return None;
    }
    if stretches.len() <= STRETCHES_MAX {
        return Some(stretches.iter().map(Stretch::in_words).collect::<Vec<_>>().join(", "));
    }
    let mut sums = Vec::new();
    for (reason, length_s) in stretches.iter().flat_map(|stretch| &stretch.reasons) {
        add(&mut sums, reason, *length_s);
    }
    let words: Vec<String> = sums.iter().map(|(reason, sum_s)| format!("{sum_s:.1} s {reason}")).collect();
    Some(format!("{} stretches: {}", stretches.len(), words.join(", ")))
}

/// The used stretches; of many, the time from the first to the last and the number of gaps, whose times stand with the cuts.
pub(crate) fn used_in_words(segments: &[Span]) -> String {
    let times = |from_s: f64, to_s: f64| format!("{from_s:.1}–{to_s:.1}");
    match segments {
        [] => DASH.to_owned(),
        [first, .., last] if segments.len() > SEGMENTS_SHOWN => {
            format!("{}, {} gaps", times(first.from_s, last.to_s), segments.len() - 1)
        }
        few => few.iter().map(|span| times(span.from_s, span.to_s)).collect::<Vec<_>>().join(", "),
    }
}

impl Stretch {
    fn names(&self) -> impl Iterator<Item = &'static str> {
        self.reasons.iter().map(|(reason, _)| *reason)
    }

    fn in_words(&self) -> String {
        let reasons: Vec<&str> = self.names().collect();
        format!("{:.1}–{:.1} s ({})", self.span.from_s, self.span.to_s, reasons.join(", "))
    }

    /// Whether a cut that follows belongs to this stretch.
    fn takes(&self, reason: &'static str) -> bool {
        let edge = CutReason::Edge.words();
        self.names().all(|known| known == edge) || reason == edge || self.names().any(|known| known == reason)
    }
}

/// Adds a time to that of its reason.
fn add(sums: &mut Vec<(&'static str, f64)>, reason: &'static str, length_s: f64) {
    match sums.iter_mut().find(|(known, _)| *known == reason) {
        Some((_, sum_s)) => *sum_s += length_s,
        None => sums.push((reason, length_s)),
    }
}

/// Cuts in order of time, without what overlaps.
fn joined(cuts: &[Cut]) -> Vec<Stretch> {
    let mut cuts: Vec<&Cut> = cuts.iter().collect();
    cuts.sort_by(|a, b| a.span.from_s.total_cmp(&b.span.from_s));
    let mut stretches: Vec<Stretch> = Vec::new();
    for cut in cuts {
        let reason = cut.reason.words();
        // frames of the survey overlap the next cut: time that is already listed is skipped
        let listed_s = stretches.last().map_or(f64::NEG_INFINITY, |before| before.span.to_s);
        let span = Span { from_s: cut.span.from_s.max(listed_s), to_s: cut.span.to_s.max(listed_s) };
        let is_within = span.length_s() <= 0.0;
        let last = stretches
            .last_mut()
            .filter(|before| span.from_s - before.span.to_s < TOUCHING_S && (is_within || before.takes(reason)));
        match last {
            Some(before) => {
                before.span.to_s = span.to_s;
                add(&mut before.reasons, reason, span.length_s());
            }
            None => stretches.push(Stretch { span, reasons: vec![(reason, span.length_s())] }),
        }
    }
    stretches
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(from_s: f64, to_s: f64, reason: CutReason) -> Cut {
        Cut { span: Span { from_s, to_s }, reason }
    }

    #[test]
    fn edges_join_what_they_border_on() {
        let cuts = [
            cut(0.0, 1.0, CutReason::Silence),
            cut(9.5, 10.0, CutReason::OtherSpeed { speed_rev_s: 20.0 }),
            cut(1.0, 1.5, CutReason::Edge),
            cut(9.0, 9.5, CutReason::Edge),
            cut(10.0, 11.0, CutReason::OtherSpeed { speed_rev_s: 9.0 }),
        ];
        let expected = "0.0–1.5 s (silence, transition to or from the hover), 9.0–11.0 s (transition to or from the hover, another speed)";
        assert_eq!(cuts_in_words(&cuts).as_deref(), Some(expected));
        assert_eq!(cuts_in_words(&[]), None);
    }

    #[test]
    fn cuts_do_not_overlap() {
        let cuts = [cut(0.0, 0.6, CutReason::TooShort), cut(0.5, 2.1, CutReason::NoTone)];
        assert_eq!(
            cuts_in_words(&cuts).as_deref(),
            Some("0.0–0.6 s (steady, but too short for a hover), 0.6–2.1 s (no steady rotor)")
        );
    }

    #[test]
    fn a_stretch_with_two_reasons_names_both() {
        let cuts = [cut(0.0, 2.0, CutReason::Silence), cut(0.5, 1.5, CutReason::NoTone)];
        assert_eq!(cuts_in_words(&cuts).as_deref(), Some("0.0–2.0 s (silence, no steady rotor)"));
        assert_eq!(cut_in_short(&cuts).as_deref(), Some("2.0 s each: no steady rotor, silence"));
        // the edge between two stretches belongs to the first
        let cuts =
            [cut(0.0, 2.0, CutReason::Silence), cut(2.0, 2.5, CutReason::Edge), cut(2.5, 3.0, CutReason::Manoeuvre)];
        let expected = "0.0–2.5 s (silence, transition to or from the hover), 2.5–3.0 s (manoeuvre)";
        assert_eq!(cuts_in_words(&cuts).as_deref(), Some(expected));
    }

    #[test]
    fn many_cuts_are_summed_up() {
        let cuts: Vec<Cut> = (0..10)
            .map(|index| {
                let from_s = f64::from(index) * 10.0;
                let reason = if index % 2 == 0 { CutReason::NoTone } else { CutReason::HandlingNoise };
                cut(from_s, from_s + 1.5, reason)
            })
            .collect();
        let expected = "10 stretches: 7.5 s no steady rotor, 7.5 s handling noise";
        assert_eq!(cuts_in_words(&cuts).as_deref(), Some(expected));
    }

    /// What is cut from the middle is not told as used.
    #[test]
    fn the_used_times_have_the_gaps_of_the_cuts() {
        let span = |from_s: f64, to_s: f64| Span { from_s, to_s };
        assert_eq!(used_in_words(&[]), "–");
        assert_eq!(used_in_words(&[span(0.5, 9.5)]), "0.5–9.5");
        assert_eq!(used_in_words(&[span(0.0, 4.5), span(6.0, 10.0)]), "0.0–4.5, 6.0–10.0");
        assert_eq!(used_in_words(&[span(0.0, 1.0), span(2.0, 3.0), span(4.0, 5.0)]), "0.0–5.0, 2 gaps");
    }
}
