//! Survey → tone families: which series of lines a recording holds, and what each can mean. They decide nothing: the rotor is heard by the
//! evidence.

use super::levels::LevelRows;
use super::reading::readings_of_tone;
use super::series::Series;
use crate::survey::Survey;
use crate::thresholds::FEW;
use crate::tone::DiscoveryConfig;
use hovertone_analysis::{Remark, SeenHarmonic, Span, ToneFamily};
use hovertone_signal::statistics::std;
use hovertone_vehicle::KnownRotor;

/// Fundamentals this near those of the mains, or of its full wave, are said to be so. *Physics.*
const MAINS_HZ: [f64; 4] = [50.0, 60.0, 100.0, 120.0];
/// How near, as a share. *Decision.*
const MAINS_SHARE: f64 = 0.004;
/// A family that sounds for less than this share of the time is a beep or a call.
const BRIEF_SHARE: f64 = FEW;

/// A line of a series: number of the harmonic, and level over the noise in dB.
type Line = (u32, f64);

/// The rotor's family first, where the fundamental of its lines is known; then the others, strongest first, where a finer survey is given.
pub(crate) fn families_from_surveys(
    survey: &Survey,
    finer: Option<&Survey>,
    rotor_hz: Option<f64>,
    known: &KnownRotor,
    config: &DiscoveryConfig,
) -> Vec<ToneFamily> {
    let mut rows = LevelRows::from_survey(survey, config.scan_rows_max);
    let finer = finer.map(|finer| LevelRows::from_survey(finer, config.scan_rows_max));
    let mut families = Vec::new();
    if let Some(rotor_hz) = rotor_hz {
        let series = Series::near(&rows, rotor_hz, config);
        let lines = series.heard_lines(&rows, config);
        families.push(family_of(&series, &lines, &rows, finer.as_ref()));
        series.take_out_of(&mut rows, &lines);
    }
    let Some(finer) = finer else { return families };
    // lines at which two of the others meet belong to both
    let beside_rotor = rows.clone();
    for _ in families.len()..config.families_max {
        let Some(strongest) = Series::strongest(&rows, config) else { break };
        let own = strongest.heard_lines(&rows, config);
        if own.iter().all(|line| line.1 < config.listed_db_min) {
            break;
        }
        let heard = strongest.heard_lines(&beside_rotor, config);
        let (series, lines) = with_all_harmonics(&strongest, &heard);
        let family = family_of(&series, &lines, &rows, Some(&finer));
        families.push(ToneFamily { readings: readings_of_tone(family.fundamental_hz, known, config), ..family });
        strongest.take_out_of(&mut rows, &heard);
    }
    families
}

fn family_of(series: &Series, lines: &[Line], rows: &LevelRows<'_>, finer: Option<&LevelRows<'_>>) -> ToneFamily {
    let numbers: Vec<u32> = lines.iter().map(|(number, _)| *number).collect();
    // a line that stands alone, more than an octave above the others, may be another sound's
    let together = numbers.windows(2).position(|pair| pair[1] > 2 * pair[0]).map_or(numbers.len(), |last| last + 1);
    let refined = finer.and_then(|finer| series.by_lines_in(rows, finer, &numbers[..together]));
    let refined = refined.unwrap_or_else(|| series.clone());
    let harmonic = |&(number, level_db): &Line| SeenHarmonic { number, hz: f64::from(number) * refined.hz, level_db };
    let harmonics: Vec<SeenHarmonic> = lines.iter().map(harmonic).collect();
    let present = rows.rows.iter().zip(&series.row_hz).filter(|(_, hz)| hz.is_some()).map(|(row, _)| row.span);
    let present: Vec<Span> = present.collect();
    let ends = present.first().zip(present.last()).map(|(first, last)| Span { from_s: first.from_s, to_s: last.to_s });
    let time_share = present.len() as f64 / rows.rows.len().max(1) as f64;
    let row_hz: Vec<f64> = refined.row_hz.iter().copied().flatten().collect();
    let is_near_mains = MAINS_HZ.into_iter().any(|mains_hz| (refined.hz / mains_hz - 1.0).abs() < MAINS_SHARE);
    let remark = if is_near_mains {
        Some(Remark::NearMains)
    } else if time_share < BRIEF_SHARE {
        Some(Remark::Brief)
    } else {
        (harmonics.len() == 1).then_some(Remark::SingleLine)
    };
    ToneFamily {
        fundamental_hz: refined.hz,
        spread_hz: std(&row_hz),
        level_db: harmonics.iter().map(|line| line.level_db).fold(0.0, f64::max),
        harmonics,
        time_share,
        span: ends.unwrap_or(Span { from_s: 0.0, to_s: 0.0 }),
        readings: Vec::new(),
        is_settled: false,
        remark,
    }
}

/// The series that has the loudest line and agrees with most of what is heard and what is not: only every second line may sound.
fn with_all_harmonics(series: &Series, lines: &[Line]) -> (Series, Vec<Line>) {
    let last = lines.last().map_or(0, |line| line.0);
    let loudest = lines.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(1, |line| line.0);
    let is_heard = |number: u32| lines.iter().any(|line| line.0 == number);
    let agreeing = |factor: u32| (1..=last).filter(|n| is_heard(*n) == n.is_multiple_of(factor)).count();
    // of equals the slowest
    let factors = (1..=loudest).rev().filter(|factor| loudest.is_multiple_of(*factor));
    let factor = factors.max_by_key(|&factor| agreeing(factor)).unwrap_or(1);
    let own = lines.iter().filter(|line| line.0.is_multiple_of(factor));
    (series.times(f64::from(factor)), own.map(|&(number, level_db)| (number / factor, level_db)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fundamental and numbers of the harmonics of lines that are each 3 dB below the one before.
    fn numbers_of(heard: &[u32]) -> (f64, Vec<u32>) {
        let series = Series { hz: 1.0, row_hz: Vec::new() };
        let lines = heard.iter().zip(1u32..).map(|(&number, place)| (number, 40.0 - 3.0 * f64::from(place)));
        let (series, lines) = with_all_harmonics(&series, &lines.collect::<Vec<_>>());
        (series.hz, lines.into_iter().map(|line| line.0).collect())
    }

    #[test]
    fn a_series_has_its_loudest_line_and_most_of_its_places() {
        assert_eq!(numbers_of(&[1, 2, 3, 4]), (1.0, vec![1, 2, 3, 4]));
        assert_eq!(numbers_of(&[1, 3, 5]), (1.0, vec![1, 3, 5]));
        assert_eq!(numbers_of(&[2, 4, 6, 8]), (2.0, vec![1, 2, 3, 4]));
        assert_eq!(numbers_of(&[2, 1, 4, 6, 8]), (2.0, vec![1, 2, 3, 4]));
        assert_eq!(numbers_of(&[1, 7]), (1.0, vec![1, 7]));
        assert_eq!(numbers_of(&[3]), (3.0, vec![1]));
        assert_eq!(numbers_of(&[]), (1.0, Vec::new()));
    }
}
