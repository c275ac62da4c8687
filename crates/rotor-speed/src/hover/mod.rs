//! Survey → hover: which stretches are steady flight, and why the rest was cut away.

mod manoeuvre;
mod phases;
mod settings;

pub(crate) use phases::restless_s;
pub use settings::{HoverConfig, HoverPart};

use crate::survey::Survey;
use crate::tone::CombMap;
use hovertone_analysis::{Cut, CutReason, Hover, Span};
use hovertone_signal::statistics::median;

/// The hover that is looked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WantedHover {
    /// Shaft speed.
    pub(crate) speed_rev_s: f64,
    /// Half width of the band around it, as a share.
    pub(crate) band_half_width_share: f64,
    /// Whether several rotors turn: then the loudest changes, and the mean of all tells the vehicle's motion.
    pub(crate) has_several_rotors: bool,
}

/// Finds the stretches in which the rotors turn near the wanted speed, at the level of the hover.
pub(crate) fn hover_from_survey(survey: &Survey, map: &CombMap, wanted: &WantedHover, config: &HoverConfig) -> Hover {
    let verdicts = verdicts_of_rows(survey, map, wanted, config);
    let mut hover = Hover::default();
    let mut row = 0;
    while row < verdicts.len() {
        let end = row + verdicts[row..].iter().take_while(|verdict| verdict.is_same_kind(&verdicts[row])).count();
        let span = Span { from_s: survey.rows[row].span.from_s, to_s: survey.rows[end - 1].span.to_s };
        match verdicts[row].reason() {
            None => {
                trim_into(&mut hover, span, row > 0, end < verdicts.len(), survey.rows[row].span.length_s(), config)
            }
            Some(reason) => hover.cuts.push(Cut { span, reason }),
        }
        row = end;
    }
    phases::name_cuts(&mut hover, wanted.speed_rev_s);
    hover
}

/// Takes a steady span into the hover, less the edges where it meets something else.
fn trim_into(hover: &mut Hover, span: Span, is_cut_before: bool, is_cut_after: bool, row_s: f64, config: &HoverConfig) {
    let edge_s = |is_cut: bool| if is_cut { row_s.min(0.2 * span.length_s()) } else { 0.0 };
    let kept = Span { from_s: span.from_s + edge_s(is_cut_before), to_s: span.to_s - edge_s(is_cut_after) };
    if kept.length_s() < config.length_s_min {
        hover.cuts.push(Cut { span, reason: CutReason::TooShort });
        return;
    }
    let edges = [Span { to_s: kept.from_s, ..span }, Span { from_s: kept.to_s, ..span }];
    hover.cuts.extend(
        edges.into_iter().filter(|edge| edge.length_s() > 0.0).map(|span| Cut { span, reason: CutReason::Edge }),
    );
    hover.segments.push(kept);
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict {
    Hover,
    Not(CutReason),
}

impl Verdict {
    fn reason(self) -> Option<CutReason> {
        match self {
            Self::Hover => None,
            Self::Not(reason) => Some(reason),
        }
    }

    fn is_same_kind(self, other: &Self) -> bool {
        match (self, other) {
            (
                Self::Not(CutReason::OtherSpeed { speed_rev_s: a }),
                Self::Not(CutReason::OtherSpeed { speed_rev_s: b }),
            ) => (a / b - 1.0).abs() < 0.1,
            (a, b) => a == *b,
        }
    }
}

fn verdicts_of_rows(survey: &Survey, map: &CombMap, wanted: &WantedHover, config: &HoverConfig) -> Vec<Verdict> {
    let WantedHover { speed_rev_s, band_half_width_share: half_width_share, has_several_rotors } = *wanted;
    let rows = 0..survey.rows.len();
    let near_db: Vec<f64> = rows
        .clone()
        .map(|row| map.best_near(row, speed_rev_s, half_width_share).map_or(0.0, |(_, score)| score.max(0.0)))
        .collect();
    // the score of the rows that carry the tone, however few they are: a mean in which rows count by their square
    let (cubes, squares) = near_db.iter().fold((0.0, 0.0), |(c, s), d| (c + d.powi(3), s + d.powi(2)));
    let score_db_min = if squares > 0.0 { config.comb_share_min * cubes / squares } else { f64::INFINITY };
    let level_db: Vec<f64> = survey.rows.iter().map(|row| row.level_db(survey.bin_hz)).collect();
    let with_tone: Vec<f64> =
        rows.clone().filter(|&row| near_db[row] >= score_db_min).map(|row| level_db[row]).collect();
    let Some(hover_level_db) = median(&with_tone) else {
        return vec![Verdict::Not(CutReason::NoTone); survey.rows.len()];
    };
    let speeds_rev_s: Vec<Option<f64>> = rows
        .clone()
        .map(|row| match has_several_rotors {
            // now one is the loudest, now another; what they share moves as the vehicle does
            true if near_db[row] >= score_db_min => map.mean_near(row, speed_rev_s, half_width_share),
            true => None,
            false => map
                .best_near(row, speed_rev_s, half_width_share)
                .filter(|&(_, score)| score >= score_db_min)
                .map(|(speed, _)| speed),
        })
        .collect();
    let row_s = survey.rows.first().map_or(config.survey_row_s, |row| row.span.length_s());
    let is_flown = manoeuvre::manoeuvring_rows(&speeds_rev_s, row_s, config);
    let mut verdicts: Vec<Verdict> = rows
        .map(|row| {
            let is_quiet = level_db[row] < hover_level_db - config.quieter_db;
            let is_loud = level_db[row] > hover_level_db + config.louder_db;
            let is_near = near_db[row] >= score_db_min;
            let other = map.best_of_row(row).filter(|&(_, score)| score >= score_db_min && !is_near);
            match (is_near, is_quiet, is_loud, other) {
                (true, false, false, _) if is_flown[row] => Verdict::Not(CutReason::Manoeuvre),
                (true, false, false, _) => Verdict::Hover,
                (_, _, true, _) => Verdict::Not(CutReason::HandlingNoise),
                (_, _, _, Some((speed_rev_s, _))) => Verdict::Not(CutReason::OtherSpeed { speed_rev_s }),
                (_, true, _, None) => Verdict::Not(CutReason::Silence),
                (_, _, _, None) => Verdict::Not(CutReason::NoTone),
            }
        })
        .collect();
    bridge_single_rows(&mut verdicts);
    verdicts
}

/// A single weak row inside a hover is a fading tone, not a landing: the ridge shows it as a gap.
fn bridge_single_rows(verdicts: &mut [Verdict]) {
    for middle in 1..verdicts.len().saturating_sub(1) {
        let is_faded = matches!(verdicts[middle], Verdict::Not(CutReason::NoTone | CutReason::OtherSpeed { .. }));
        if is_faded && verdicts[middle - 1] == Verdict::Hover && verdicts[middle + 1] == Verdict::Hover {
            verdicts[middle] = Verdict::Hover;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hover_is_halved_and_cut_across_its_segments() {
        let span = |from_s, to_s| Span { from_s, to_s };
        let hover = Hover { segments: vec![span(1.0, 3.0), span(5.0, 11.0)], cuts: Vec::new() };
        // 8 s in all: the later 4; and of the first 4 the later 2
        assert_eq!(hover.later_half(60.0).segments, [span(7.0, 11.0)]);
        assert_eq!(hover.later_half(4.0).segments, [span(5.0, 7.0)]);
        let cut = hover.clone().after_take_off(6.0);
        assert_eq!(cut.segments, [span(6.0, 11.0)]);
        let gone = |from_s, to_s| Cut { span: span(from_s, to_s), reason: CutReason::TakeOff };
        assert_eq!(cut.cuts, [gone(1.0, 3.0), gone(5.0, 6.0)]);
        assert_eq!(hover.clone().after_take_off(0.0), hover);
    }
}
