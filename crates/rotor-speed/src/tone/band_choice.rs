//! Bands → those that can be trusted: a codec's cut and mains hum take some away.

use crate::survey::Survey;
use hovertone_analysis::{Band, NoTone, Warning};
use hovertone_signal::channels::ChannelBand;
use hovertone_signal::spectrogram::band_limit_hz;

/// A band whose middle is nearer than this share to where the recording ends loses rotors on that side.
const LIMIT_MARGIN_SHARE: f64 = 0.02;
/// Hum this much weaker (as a ratio of power) than the strongest other line of a band does not pull its ridge.
const HUM_POWER_SHARE_MAX: f64 = 0.1;
/// A line of hum this far beyond the edge of a band still shows its side lobes inside: four cells of the longest frames.
const HUM_REACH_HZ: f64 = 10.0;
/// One band that is left where hum took others is no witness.
const BANDS_BESIDE_HUM_MIN: usize = 2;
/// Bins on either side of a line of hum that are its own.
const HUM_HALF_BINS: f64 = 3.0;

/// Leaves out bands that the recording does not hold or whose loudest line is mains hum, with a warning for each.
///
/// # Errors
/// The reason, where none remains.
pub(crate) fn bands_worth_following(
    bands: Vec<Band>,
    survey: &Survey,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Band>, NoTone> {
    let limit_hz = survey.mean_power().and_then(|power| band_limit_hz(&power, survey.bin_hz));
    let fine_power = survey.fine.mean_power(|_| true).unwrap_or_default();
    let middle_hz = |band: &Band| (band.band_hz_low + band.band_hz_high) / 2.0;
    let mut reasons = Vec::new();
    let mut kept = Vec::new();
    let mut is_cut = false;
    for band in bands {
        let beyond_hz = limit_hz.filter(|limit_hz| middle_hz(&band) * (1.0 + LIMIT_MARGIN_SHARE) > *limit_hz);
        let hum_hz = loud_hum_in((band.band_hz_low, band.band_hz_high), survey, &fine_power);
        match (beyond_hz, hum_hz) {
            (Some(limit_hz), _) => {
                if !is_cut {
                    warnings.push(Warning::BandCutByCodec { above_hz: limit_hz });
                    is_cut = true;
                }
                let reason = format!("near {:.0} Hz, where the recording holds nothing", middle_hz(&band));
                warnings.push(Warning::HarmonicLeftOut { harmonic: band.harmonic, reason });
                reasons.push(NoTone::BandCutByCodec { tone_hz: middle_hz(&band), above_hz: limit_hz });
            }
            (None, Some((line_hz, mains_hz))) => {
                let reason = format!("mains hum at {line_hz:.1} Hz is louder in its band");
                warnings.push(Warning::HarmonicLeftOut { harmonic: band.harmonic, reason });
                reasons.push(NoTone::MainsHum { mains_hz });
            }
            (None, None) => kept.push(band),
        }
    }
    let has_hum = reasons.iter().any(|reason| matches!(reason, NoTone::MainsHum { .. }));
    match reasons.into_iter().next() {
        Some(reason) if kept.is_empty() || has_hum && kept.len() < BANDS_BESIDE_HUM_MIN => Err(reason),
        _ => Ok(kept),
    }
}

/// Leaves out lines for the same reasons; said of the bands already.
pub(crate) fn lines_worth_hearing(lines: Vec<ChannelBand>, survey: &Survey) -> Vec<ChannelBand> {
    let limit_hz = survey.mean_power().and_then(|power| band_limit_hz(&power, survey.bin_hz)).unwrap_or(f64::INFINITY);
    let fine_power = survey.fine.mean_power(|_| true).unwrap_or_default();
    lines
        .into_iter()
        .filter(|line| (line.band_hz_low + line.band_hz_high) / 2.0 * (1.0 + LIMIT_MARGIN_SHARE) <= limit_hz)
        .filter(|line| loud_hum_in((line.band_hz_low, line.band_hz_high), survey, &fine_power).is_none())
        .collect()
}

/// A line of hum in or beside a band that is not much weaker than what else is there, and the mains' frequency.
fn loud_hum_in((low_hz, high_hz): (f64, f64), survey: &Survey, fine_power: &[f64]) -> Option<(f64, f64)> {
    let hum = survey.hum.as_ref()?;
    let line_hz = hum.line_in(low_hz - HUM_REACH_HZ, high_hz + HUM_REACH_HZ)?;
    let loudest = loudest_without(fine_power, survey.fine.bin_hz, (low_hz, high_hz), &hum.lines_hz);
    let place = (line_hz / survey.fine.bin_hz).round() as usize;
    let is_loud = fine_power.get(place).is_some_and(|hum| *hum > HUM_POWER_SHARE_MAX * loudest);
    is_loud.then_some((line_hz, hum.mains_hz))
}

/// Power of the loudest bin of a band that is not a line of hum.
fn loudest_without(power: &[f64], bin_hz: f64, (low_hz, high_hz): (f64, f64), lines_hz: &[f64]) -> f64 {
    let bins = (low_hz / bin_hz).ceil() as usize..=(high_hz / bin_hz).floor() as usize;
    bins.filter(|&bin| lines_hz.iter().all(|hz| (hz / bin_hz - bin as f64).abs() > HUM_HALF_BINS))
        .filter_map(|bin| power.get(bin))
        .copied()
        .fold(0.0, f64::max)
}
