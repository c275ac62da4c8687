//! The cuts of a recording on one line.

use hovertone_analysis::{Cut, CutReason, Span};
use std::collections::BTreeSet;

/// Most stretches on the line; the others are summed up.
const STRETCHES_MAX: usize = 6;
/// Cuts with a smaller gap count as adjacent.
const TOUCHING_S: f64 = 1e-6;

/// "4.4 s each: handling noise, silence": the sum and the reasons, by which recordings are alike; `None` where nothing was cut.
pub(crate) fn cut_in_short(cuts: &[Cut]) -> Option<String> {
    let stretches = joined(cuts);
    let reasons: BTreeSet<&str> = stretches.iter().map(|(_, reason)| in_words(*reason)).collect();
    let sum_s: f64 = stretches.iter().map(|(span, _)| span.length_s()).sum();
    let reasons = reasons.into_iter().collect::<Vec<_>>().join(", ");
    (!stretches.is_empty()).then(|| format!("{sum_s:.1} s each: {reasons}"))
}

/// "0.0–1.6 s (silence), 6.2–7.0 s (handling noise)"; `None` where nothing was cut.
pub fn cuts_in_words(cuts: &[Cut]) -> Option<String> {
    let stretches = joined(cuts);
    if stretches.is_empty() {
        return None;
    }
    if stretches.len() <= STRETCHES_MAX {
        let words: Vec<String> = stretches
            .iter()
            .map(|(span, reason)| format!("{:.1}–{:.1} s ({})", span.from_s, span.to_s, in_words(*reason)))
            .collect();
        return Some(words.join(", "));
    }
    let mut sums: Vec<(&str, f64)> = Vec::new();
    for (span, reason) in &stretches {
        let words = in_words(*reason);
        match sums.iter_mut().find(|(known, _)| *known == words) {
            Some((_, sum_s)) => *sum_s += span.length_s(),
            None => sums.push((words, span.length_s())),
        }
    }
    let words: Vec<String> = sums.iter().map(|(words, sum_s)| format!("{sum_s:.1} s {words}")).collect();
    Some(format!("{} stretches: {}", stretches.len(), words.join(", ")))
}

fn in_words(reason: CutReason) -> &'static str {
    match reason {
        CutReason::Silence => "silence",
        CutReason::HandlingNoise => "handling noise",
        CutReason::OtherSpeed { .. } => "another speed",
        CutReason::TakeOff => "take-off",
        CutReason::Landing => "landing",
        CutReason::Manoeuvre => "manoeuvre",
        CutReason::NoTone => "no rotor heard",
        CutReason::Edge => "edge of the hover",
        CutReason::TooShort => "too short to use",
        _ => "not hover",
    }
}

/// Cuts in order of time. Adjacent cuts with equal reasons are merged, and the edge of a hover is merged with its neighbour.
fn joined(cuts: &[Cut]) -> Vec<(Span, CutReason)> {
    let mut cuts: Vec<&Cut> = cuts.iter().collect();
    cuts.sort_by(|a, b| a.span.from_s.total_cmp(&b.span.from_s));
    let mut stretches: Vec<(Span, CutReason)> = Vec::new();
    for cut in cuts {
        let is_edge = |reason: CutReason| reason == CutReason::Edge;
        match stretches.last_mut() {
            Some((span, reason))
                if cut.span.from_s - span.to_s < TOUCHING_S
                    && (in_words(*reason) == in_words(cut.reason) || is_edge(*reason) || is_edge(cut.reason)) =>
            {
                span.to_s = cut.span.to_s;
                if is_edge(*reason) {
                    *reason = cut.reason;
                }
            }
            // frames of the survey overlap the next cut: time that is already listed is skipped
            Some((before, _)) => {
                let span = Span { from_s: cut.span.from_s.max(before.to_s), ..cut.span };
                stretches.push((span, cut.reason));
            }
            None => stretches.push((cut.span, cut.reason)),
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
        let expected = "0.0–1.5 s (silence), 9.0–11.0 s (another speed)";
        assert_eq!(cuts_in_words(&cuts).as_deref(), Some(expected));
        assert_eq!(cuts_in_words(&[]), None);
    }

    #[test]
    fn cuts_do_not_overlap() {
        let cuts = [cut(0.0, 0.6, CutReason::TooShort), cut(0.5, 2.1, CutReason::NoTone)];
        assert_eq!(cuts_in_words(&cuts).as_deref(), Some("0.0–0.6 s (too short to use), 0.6–2.1 s (no rotor heard)"));
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
        let expected = "10 stretches: 7.5 s no rotor heard, 7.5 s handling noise";
        assert_eq!(cuts_in_words(&cuts).as_deref(), Some(expected));
    }
}
