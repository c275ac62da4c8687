//! Cuts with other speeds → phases of flight: take-off, landing, manoeuvre.

use crate::harmonic::SAME_TIME_S;
use crate::survey::Survey;
use crate::thresholds::{CLEAR_DB, HELD_S, NEARLY_ALL};
use crate::tone::CombMap;
use hovertone_analysis::{Cut, CutReason, Hover, Span};
use hovertone_signal::statistics::median;

/// Largest overshoot beyond the speed of the hover when rotors run up or down, as a share. *Decision.*
const OVERSHOOT_SHARE: f64 = 0.15;
/// Smallest comb score of a clear row, dB: with a lower score, the best speed of a row is wrong by chance, also with a faint rotor.
const CLEAR_DB_MIN: f64 = CLEAR_DB;

/// Length of the rows with clear tones outside the hover that are not held and belong to no take-off or landing, s.
pub(crate) fn restless_s(hover: &Hover, survey: &Survey, map: &CombMap) -> f64 {
    let middle_s = |row: usize| survey.rows[row].span.middle_s();
    let best_db = |row: usize| map.best_of_row(row).map_or(0.0, |(_, score)| score);
    let in_hover = |row: usize| hover.segments.iter().any(|segment| segment.contains(middle_s(row)));
    let rows = 0..survey.rows.len();
    let hover_db: Vec<f64> = rows.clone().filter(|&row| in_hover(row)).map(best_db).collect();
    let clear_db = (NEARLY_ALL * median(&hover_db).unwrap_or(f64::INFINITY)).max(CLEAR_DB_MIN);
    let is_restless = |cut: &Cut| match cut.reason {
        CutReason::OtherSpeed { .. } => cut.span.length_s() <= HELD_S,
        CutReason::Manoeuvre | CutReason::TooShort => true,
        _ => false,
    };
    rows.filter(|&row| best_db(row) >= clear_db)
        .filter(|&row| hover.cuts.iter().any(|cut| is_restless(cut) && cut.span.contains(middle_s(row))))
        .map(|row| survey.rows[row].span.length_s())
        .sum()
}

/// Names the cuts before, between and after the spans of hover as take-off, manoeuvre and landing, where no other speed is held.
pub(super) fn name_cuts(hover: &mut Hover, hover_speed_rev_s: f64) {
    let (Some(first), Some(last)) = (hover.segments.first().copied(), hover.segments.last().copied()) else { return };
    hover.cuts.sort_by(|a, b| a.span.from_s.total_cmp(&b.span.from_s));
    let runs_up = Direction { hover_speed_rev_s, sign: 1.0 };
    let runs_down = Direction { hover_speed_rev_s, sign: -1.0 };
    let segments = hover.segments.clone();
    let silences: Vec<Span> =
        hover.cuts.iter().filter(|cut| cut.reason == CutReason::Silence).map(|cut| cut.span).collect();
    let from_silence = |at_s: f64| silences.iter().any(|silence| is_same(silence.to_s, at_s));
    let to_silence = |at_s: f64| silences.iter().any(|silence| is_same(silence.from_s, at_s));
    for cuts in runs_of_motion(&mut hover.cuts) {
        let span = Span { from_s: cuts[0].span.from_s, to_s: cuts[cuts.len() - 1].span.to_s };
        let is_between = span.from_s >= first.from_s && span.to_s <= last.to_s;
        let has_speeds =
            cuts.iter().any(|cut| matches!(cut.reason, CutReason::OtherSpeed { .. } | CutReason::Manoeuvre));
        let is_heard = cuts.iter().all(|cut| cut.reason != CutReason::NoTone);
        let is_up = (has_speeds || from_silence(span.from_s)) && runs_up.is_of(cuts);
        let is_down = (has_speeds || to_silence(span.to_s)) && runs_down.is_of(cuts);
        if cuts.iter().all(|cut| matches!(cut.reason, CutReason::Edge | CutReason::TooShort)) {
            continue;
        }
        let reason = if is_same(span.to_s, first.from_s) && is_up {
            CutReason::TakeOff
        } else if is_same(span.from_s, last.to_s) && is_down {
            CutReason::Landing
        } else if is_between && has_speeds && is_heard && touches_hover(&segments, &span) {
            CutReason::Manoeuvre
        } else {
            continue;
        };
        cuts.iter_mut().filter(|cut| cut.reason != CutReason::Edge).for_each(|cut| cut.reason = reason);
    }
    join_equal(&mut hover.cuts);
}

/// Runs of neighbouring cuts in which the speed changes: other speeds that are not held, changes too fast to be heard as a series of
/// lines, and the edges beside these.
fn runs_of_motion(cuts: &mut [Cut]) -> impl Iterator<Item = &mut [Cut]> {
    let is_motion = |cut: &Cut| match cut.reason {
        CutReason::OtherSpeed { .. } | CutReason::NoTone => cut.span.length_s() <= HELD_S,
        CutReason::Edge | CutReason::TooShort | CutReason::Manoeuvre => true,
        _ => false,
    };
    cuts.chunk_by_mut(move |a, b| is_motion(a) && is_motion(b) && is_same(b.span.from_s, a.span.to_s))
        .filter(move |run| run.iter().all(is_motion))
}

/// A change of speed towards the hover (sign 1), or away from it (sign −1).
struct Direction {
    hover_speed_rev_s: f64,
    sign: f64,
}

impl Direction {
    /// Whether the speeds of the cuts change in this direction, and overshoot the hover by little.
    fn is_of(&self, cuts: &[Cut]) -> bool {
        let speeds: Vec<f64> = cuts
            .iter()
            .filter_map(|cut| match cut.reason {
                CutReason::OtherSpeed { speed_rev_s } => Some(speed_rev_s),
                _ => None,
            })
            .collect();
        let is_below = speeds.iter().all(|speed| *speed <= self.hover_speed_rev_s * (1.0 + OVERSHOOT_SHARE));
        let moves = speeds.windows(2).all(|pair| self.sign * (pair[1] - pair[0]) >= -OVERSHOOT_SHARE * pair[0]);
        is_below && moves
    }
}

/// Whether two times are equal up to rounding.
fn is_same(a_s: f64, b_s: f64) -> bool {
    (a_s - b_s).abs() < SAME_TIME_S
}

/// Whether a span lies directly between two segments of the hover.
fn touches_hover(segments: &[Span], span: &Span) -> bool {
    segments.iter().any(|segment| is_same(segment.to_s, span.from_s))
        && segments.iter().any(|segment| is_same(segment.from_s, span.to_s))
}

/// Joins neighbouring cuts with the same reason.
fn join_equal(cuts: &mut Vec<Cut>) {
    cuts.dedup_by(|next, before| {
        let is_one = before.reason == next.reason && is_same(next.span.from_s, before.span.to_s);
        if is_one {
            before.span.to_s = next.span.to_s;
        }
        is_one
    });
}
