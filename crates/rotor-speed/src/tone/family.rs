//! Survey → tone families: which series of lines a recording holds, and what each can mean.

use super::levels::LevelRows;
use super::pattern::{Look, Pattern};
use super::profile::OrderProfile;
use super::reading::readings_of_tone;
use super::series::Series;
use crate::survey::Survey;
use crate::tone::DiscoveryConfig;
use hovertone_analysis::{Remark, SeenHarmonic, Span, ToneFamily};
use hovertone_vehicle::KnownRotor;

/// A fundamental that turns out to be a fraction of the true one is multiplied this often at most. *Numeric.*
const LOOKS_MAX: usize = 3;
/// Fundamentals this near those of the mains, or of its full wave, are said to be so. *Physics.*
const MAINS_HZ: [f64; 4] = [50.0, 60.0, 100.0, 120.0];
/// How near, as a share. *Decision.*
const MAINS_SHARE: f64 = 0.004;
/// A family that sounds for less than this share of the time is a beep or a call. *Decision.*
const BRIEF_SHARE: f64 = 0.25;

/// The families of a recording, strongest first, up to one that is enough.
pub(crate) fn families_from_surveys(
    survey: &Survey,
    detail: &Survey,
    known: &KnownRotor,
    config: &DiscoveryConfig,
    is_enough: &dyn Fn(&ToneFamily) -> bool,
) -> Vec<ToneFamily> {
    let mut coarse = LevelRows::from_survey(survey, config.scan_rows_max);
    let whole = coarse.clone();
    let fine = LevelRows::from_survey(detail, config.scan_rows_max);
    let mut families: Vec<ToneFamily> = Vec::new();
    for _ in 0..config.families_max {
        let Some(series) = Series::strongest(&coarse, config) else { break };
        families.extend(family_of(&series, &whole, &fine, known, config));
        if families.last().is_some_and(is_enough) {
            break;
        }
        series.take_out_of(&mut coarse);
    }
    families
}

fn family_of(
    series: &Series,
    coarse: &LevelRows<'_>,
    fine: &LevelRows<'_>,
    known: &KnownRotor,
    config: &DiscoveryConfig,
) -> Option<ToneFamily> {
    let (pattern, series) = pattern_of(series, coarse, fine, config)?;
    let (pattern, ratio) = pattern.or_single_line()?;
    let series = series.times(ratio);
    let heard = pattern.lines_db.iter().zip(1u32..).filter_map(|(db, number)| Some((number, (*db)?)));
    let lines: Vec<u32> = heard.clone().map(|(number, _)| number).collect();
    // a line that stands alone, more than an octave above the others, may be another sound's
    let together = lines.windows(2).position(|pair| pair[1] > 2 * pair[0]).map_or(lines.len(), |last| last + 1);
    let refined = series.by_lines_in(coarse, fine, &lines[..together]).unwrap_or_else(|| series.clone());
    let harmonics: Vec<SeenHarmonic> =
        heard.map(|(number, level_db)| SeenHarmonic { number, hz: f64::from(number) * refined.hz, level_db }).collect();
    let level_db = harmonics.iter().map(|line| line.level_db).fold(0.0, f64::max);
    let present: Vec<&Span> =
        coarse.rows.iter().zip(&series.row_hz).filter(|(_, hz)| hz.is_some()).map(|(row, _)| &row.span).collect();
    let span = Span { from_s: present.first()?.from_s, to_s: present.last()?.to_s };
    let time_share = present.len() as f64 / coarse.rows.len() as f64;
    let row_hz: Vec<f64> = refined.row_hz.iter().copied().flatten().collect();
    let is_near_mains = MAINS_HZ.into_iter().any(|mains_hz| (refined.hz / mains_hz - 1.0).abs() < MAINS_SHARE);
    let remark = if is_near_mains {
        Some(Remark::NearMains)
    } else if time_share < BRIEF_SHARE {
        Some(Remark::Brief)
    } else {
        (harmonics.len() == 1).then_some(Remark::SingleLine)
    };
    (level_db >= config.listed_db_min).then_some(ToneFamily {
        fundamental_hz: refined.hz,
        spread_hz: hovertone_signal::statistics::std(&row_hz),
        harmonics,
        level_db,
        time_share,
        span,
        readings: readings_of_tone(refined.hz, known, config),
        is_settled: false,
        remark,
    })
}

/// What the series looks like, and the series itself once it is not a fraction of a faster one.
fn pattern_of(
    series: &Series,
    coarse: &LevelRows<'_>,
    fine: &LevelRows<'_>,
    config: &DiscoveryConfig,
) -> Option<(Pattern, Series)> {
    let mut series = series.clone();
    for _ in 0..LOOKS_MAX {
        let in_fine = series.in_rows_of(coarse, fine);
        let is_fine = series.hz < config.detail_below_hz && in_fine.row_hz.iter().any(Option::is_some);
        let profile =
            if is_fine { OrderProfile::from_rows(fine, &in_fine)? } else { OrderProfile::from_rows(coarse, &series)? };
        match Look::at(&profile, config) {
            Look::Pattern(pattern) => return Some((pattern, series)),
            Look::Faster(factor) => series = series.times(f64::from(factor)),
        }
    }
    None
}
