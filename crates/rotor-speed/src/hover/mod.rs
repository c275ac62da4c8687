//! Survey → hover: the spans of steady flight, and the reasons for cutting away the rest.

mod manoeuvre;
mod phases;
mod settings;

pub(crate) use phases::restless_s;
pub use settings::{HoverConfig, HoverPart};

use crate::survey::Survey;
use crate::thresholds::{FEW, SAME_SPEED_SHARE};
use crate::tone::CombMap;
use hovertone_analysis::{Cut, CutReason, Hover, Span};
use hovertone_signal::statistics::{mean_by_square, median};

/// Largest part of a steady span that is cut away at an edge, as a share of the span.
const EDGE_SHARE_MAX: f64 = FEW;

/// The hover that is searched for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WantedHover {
    /// Shaft speed.
    pub(crate) speed_rev_s: f64,
    /// Half width of the band around this speed, as a share.
    pub(crate) band_half_width_share: f64,
    /// Whether several rotors turn. Then the loudest rotor changes, and the mean of all rotors follows the motion of the vehicle.
    pub(crate) has_several_rotors: bool,
}

/// The spans in which the rotors turn near the wanted speed, with about the loudness of the hover.
pub(crate) fn hover_from_survey(survey: &Survey, map: &CombMap, wanted: &WantedHover, config: &HoverConfig) -> Hover {
    let verdicts = verdicts_of_rows(survey, map, wanted, config);
    let mut hover = Hover::default();
    let mut row = 0;
    while row < verdicts.len() {
        let end = row + verdicts[row..].iter().take_while(|verdict| verdict.is_same_kind(&verdicts[row])).count();
        let span = Span { from_s: survey.rows[row].span.from_s, to_s: survey.rows[end - 1].span.to_s };
        match verdicts[row].reason() {
            None => {
                let row_s = survey.rows[row].span.length_s();
                let cut_s = |is_cut: bool| if is_cut { row_s.min(EDGE_SHARE_MAX * span.length_s()) } else { 0.0 };
                add_trimmed(&mut hover, span, cut_s(row > 0), cut_s(end < verdicts.len()), config);
            }
            Some(reason) => hover.cuts.push(Cut { span, reason }),
        }
        row = end;
    }
    phases::name_cuts(&mut hover, wanted.speed_rev_s);
    hover
}

/// Adds a steady span to the hover, shortened at both ends.
fn add_trimmed(hover: &mut Hover, span: Span, before_s: f64, after_s: f64, config: &HoverConfig) {
    let kept = Span { from_s: span.from_s + before_s, to_s: span.to_s - after_s };
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

/// Whether a row belongs to the hover.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict {
    Hover,
    Not(CutReason),
}

impl Verdict {
    /// The reason for cutting the row away.
    fn reason(self) -> Option<CutReason> {
        match self {
            Self::Hover => None,
            Self::Not(reason) => Some(reason),
        }
    }

    /// Whether two neighbouring rows form one span.
    fn is_same_kind(self, other: &Self) -> bool {
        match (self, other) {
            (
                Self::Not(CutReason::OtherSpeed { speed_rev_s: a }),
                Self::Not(CutReason::OtherSpeed { speed_rev_s: b }),
            ) => (a / b - 1.0).abs() < SAME_SPEED_SHARE,
            (a, b) => a == *b,
        }
    }
}

/// Decides for each row whether it belongs to the hover.
fn verdicts_of_rows(survey: &Survey, map: &CombMap, wanted: &WantedHover, config: &HoverConfig) -> Vec<Verdict> {
    let WantedHover { speed_rev_s, band_half_width_share: half_width_share, .. } = *wanted;
    let rows = 0..survey.rows.len();
    let near_db: Vec<f64> = rows
        .clone()
        .map(|row| map.best_near(row, speed_rev_s, half_width_share).map_or(0.0, |(_, score)| score.max(0.0)))
        .collect();
    // typical score of the rows with the tone, even where these are few
    let typical_db = mean_by_square(near_db.iter().copied());
    let score_db_min = typical_db.map_or(f64::INFINITY, |typical_db| config.comb_share_min * typical_db);
    let level_db: Vec<f64> = survey.rows.iter().map(|row| row.level_db(survey.bin_hz)).collect();
    let with_tone: Vec<f64> =
        rows.clone().filter(|&row| near_db[row] >= score_db_min).map(|row| level_db[row]).collect();
    let Some(hover_level_db) = median(&with_tone) else {
        return vec![Verdict::Not(CutReason::NoTone); survey.rows.len()];
    };
    let speeds_rev_s: Vec<Option<f64>> = near_db
        .iter()
        .enumerate()
        .map(
            |(row, &near_db)| if near_db >= score_db_min { speed_of_row(map, row, wanted, score_db_min) } else { None },
        )
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

/// The speed of a row with the tone. `None` where its score is below the minimum.
fn speed_of_row(map: &CombMap, row: usize, wanted: &WantedHover, score_db_min: f64) -> Option<f64> {
    let WantedHover { speed_rev_s, band_half_width_share, has_several_rotors } = *wanted;
    if has_several_rotors {
        // the loudest rotor changes; the mean of all moves as the vehicle does
        map.mean_near(row, speed_rev_s, band_half_width_share)
    } else {
        map.best_near(row, speed_rev_s, band_half_width_share)
            .filter(|&(_, score)| score >= score_db_min)
            .map(|(speed, _)| speed)
    }
}

/// Counts a single weak row within a hover as hover: the tone fades there, and the ridge has a gap.
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
