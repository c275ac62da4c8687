//! The speed of a tone family, by the lines of the survey.

use super::by_beliefs::SAME_LINE_SHARE;
use super::{Discovery, FoundSpeed, config_for, speed_of};
use crate::config::Config;
use crate::error::Error;
use crate::pipeline::{passes_after_survey, speed_of_found_tone};
use crate::stages::{Silence, Surveyed, at_ratio};
use hovertone_analysis::{NoTone, Outcome, Reading, SeenHarmonic, SpeedAnalysis, ToneFamily};
use hovertone_signal::passes::Passes;
use hovertone_vehicle::RotorSpeed;

/// Other speeds of the same rotor are looked for up to this factor: below an octave, so that it stays settled. *Decision.*
pub(super) const OTHER_SPEED_FACTOR: f64 = 1.9;
/// The analysis must find the family's own tone, within this share. *Decision.*
const SAME_TONE_SHARE: f64 = 0.08;

/// The speed of the family at `rotor`, read in its most plausible way that its lines do not refute.
pub(super) fn speed_of_family(
    passes: &mut Passes<'_>,
    surveyed: &Surveyed,
    families: Vec<ToneFamily>,
    rotor: usize,
    config: &Config,
    discovery: &Discovery,
) -> Result<FoundSpeed, Error> {
    let Some(first) = families[rotor].readings.first() else {
        let analysis = Silence::because(NoTone::NoSeries).analysis(surveyed.heard());
        return Ok(FoundSpeed { families, rotor: None, config: config.clone(), analysis, alternatives: Vec::new() });
    };
    let mut config_of_found = config.clone();
    config_of_found.ridge.company_share_min = config.ridge.company_share_min.max(discovery.config.company_share_min);
    let mut is_first = true;
    let mut analysed = |reading: &Reading, factor: f64| -> Result<(Config, SpeedAnalysis), Error> {
        let found = config_for(&config_of_found, reading, factor);
        if !std::mem::take(&mut is_first) {
            passes.expect_more(passes_after_survey(&found));
        }
        let analysis = speed_of_found_tone(passes, surveyed, &found)?;
        Ok((found, analysis))
    };
    let mut reading = first;
    let (mut found, mut analysis) = analysed(reading, OTHER_SPEED_FACTOR)?;
    // lines that one reading cannot explain refute it, not the others
    let is_refuted = |analysis: &SpeedAnalysis| {
        matches!(analysis.outcome, Outcome::NoRotorTone { reason: NoTone::ForeignSeries { .. } })
    };
    for other in families[rotor].plausible_readings(discovery.config.plausible_min).into_iter().skip(1) {
        if !is_refuted(&analysis) {
            break;
        }
        let next = analysed(other, OTHER_SPEED_FACTOR)?;
        if !is_refuted(&next.1) {
            (reading, (found, analysis)) = (other, next);
        }
    }
    if !speed_of(&analysis, &found).is_none_or(|speed| is_near(speed.speed, reading)) {
        (found, analysis) = analysed(reading, 1.0 + SAME_TONE_SHARE)?;
    }
    // the analysis knows the tone better than the survey
    let ratio = speed_of(&analysis, &found).map(|speed| speed.speed.rad_s() / reading.speed.rad_s());
    let alternatives = match ratio {
        Some(ratio) if !families[rotor].is_settled => {
            let plausible = families[rotor].plausible_readings(discovery.config.plausible_min);
            plausible.into_iter().map(|reading| at_ratio(reading, ratio)).collect()
        }
        _ => Vec::new(),
    };
    let mut families = families;
    if let Some(ratio) = ratio.filter(|ratio| (ratio - 1.0).abs() < SAME_LINE_SHARE) {
        families[rotor] = family_at_ratio(&families[rotor], ratio);
    }
    Ok(FoundSpeed { rotor: Some(rotor), config: found, analysis, alternatives, families })
}

/// A family whose frequencies are multiplied by this ratio.
fn family_at_ratio(family: &ToneFamily, ratio: f64) -> ToneFamily {
    ToneFamily {
        fundamental_hz: ratio * family.fundamental_hz,
        harmonics: family.harmonics.iter().map(|line| SeenHarmonic { hz: ratio * line.hz, ..*line }).collect(),
        readings: family.readings.iter().map(|reading| at_ratio(reading, ratio)).collect(),
        ..family.clone()
    }
}

fn is_near(speed: RotorSpeed, reading: &Reading) -> bool {
    (speed.rad_s() / reading.speed.rad_s() - 1.0).abs() < SAME_TONE_SHARE
}
