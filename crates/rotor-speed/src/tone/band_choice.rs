//! Bands → those that can be trusted: a codec's cut takes some away.

use crate::survey::Survey;
use hovertone_analysis::{Band, NoTone, Warning};
use hovertone_signal::channels::ChannelBand;
use hovertone_signal::spectrogram::{band_limit_hz, power_db};
use std::ops::RangeInclusive;

/// A band whose middle is nearer than this share to where the recording ends loses rotors on that side. *Decision.*
const LIMIT_MARGIN_SHARE: f64 = 0.02;
/// Range of frequencies below and above the middle of a band in which its noise is measured, as a share of the middle. *Decision.*
const FLOOR_SHARE: f64 = 0.5;
/// Smallest number of bins of such a range: the lines of four rotors then fill less than half of them. *Numeric.*
const FLOOR_BINS_MIN: usize = 20;
/// The noise is the lowest of so many equal parts of the sorted bins. *Numeric.*
const FLOOR_QUANTILE_PARTS: usize = 4;

/// Leaves out bands that the recording does not hold, with one warning for the first and one for each.
///
/// # Errors
/// The reason, where none remains.
pub(crate) fn bands_worth_following(
    bands: Vec<Band>,
    survey: &Survey,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Band>, NoTone> {
    let limit_hz = survey.mean_power().and_then(|power| band_limit_hz(&power, survey.bin_hz));
    let Some(above_hz) = limit_hz else { return Ok(bands) };
    let middle_hz = |band: &Band| (band.band_hz_low + band.band_hz_high) / 2.0;
    let (kept, cut): (Vec<Band>, Vec<Band>) =
        bands.into_iter().partition(|band| middle_hz(band) * (1.0 + LIMIT_MARGIN_SHARE) <= above_hz);
    let Some(first) = cut.first() else { return Ok(kept) };
    warnings.push(Warning::BandCutByCodec { above_hz });
    warnings.extend(cut.iter().map(|band| {
        let reason = format!("its frequency is near {:.0} Hz, and the recording has no sound there", middle_hz(band));
        Warning::HarmonicLeftOut { harmonic: band.harmonic, reason }
    }));
    if kept.is_empty() { Err(NoTone::BandCutByCodec { tone_hz: middle_hz(first), above_hz }) } else { Ok(kept) }
}

/// Leaves out lines for the same reason, for which the bands have their warnings. The others learn how the noise falls within their bands.
pub(crate) fn lines_worth_hearing(lines: Vec<ChannelBand>, survey: &Survey) -> Vec<ChannelBand> {
    let power = survey.mean_power().unwrap_or_default();
    let limit_hz = band_limit_hz(&power, survey.bin_hz).unwrap_or(f64::INFINITY);
    lines
        .into_iter()
        .filter(|line| (line.band_hz_low + line.band_hz_high) / 2.0 * (1.0 + LIMIT_MARGIN_SHARE) <= limit_hz)
        .map(|line| ChannelBand {
            noise_fall_db: noise_fall_db(&power, survey.bin_hz, line.band_hz_low..=line.band_hz_high),
            ..line
        })
        .collect()
}

/// Fall of the noise from the lower edge of a band to the upper one, dB, by the noise below and above the middle of the band. 0 where few bins tell
/// it.
///
/// The noise is a low quantile of the bins in a wide range of frequencies, in which lines fill a small part.
fn noise_fall_db(power: &[f64], bin_hz: f64, band_hz: RangeInclusive<f64>) -> f64 {
    let (low_hz, high_hz) = band_hz.into_inner();
    let floor_db = |from_hz: f64, to_hz: f64| {
        let bins = (from_hz / bin_hz).ceil() as usize..(to_hz / bin_hz).floor() as usize;
        let mut sorted = power.get(bins).filter(|bins| bins.len() >= FLOOR_BINS_MIN)?.to_vec();
        sorted.sort_by(f64::total_cmp);
        Some(power_db(sorted[sorted.len() / FLOOR_QUANTILE_PARTS]))
    };
    let middle_hz = (low_hz + high_hz) / 2.0;
    let range_hz = FLOOR_SHARE * middle_hz;
    match (floor_db(middle_hz - range_hz, middle_hz), floor_db(middle_hz, middle_hz + range_hz)) {
        (Some(below_db), Some(above_db)) => (below_db - above_db) * (high_hz - low_hz) / range_hz,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fall_of_the_noise_is_measured_beside_lines() {
        let bin_hz = 5.0;
        // 12 dB in an octave, with lines of four rotors 30 dB above
        let mut power: Vec<f64> = (0..2000).map(|bin| 1e6 / f64::from(bin.max(1)).powi(4)).collect();
        for harmonic in 1..40 {
            for rotor_hz in [176.0f64, 182.0, 190.0, 201.0] {
                power[(rotor_hz * f64::from(harmonic) / bin_hz) as usize] *= 1000.0;
            }
        }
        let (low_hz, high_hz) = (1900.0f64, 2100.0f64);
        let expected_db = 40.0 * (high_hz / low_hz).log10();
        let fall_db = noise_fall_db(&power, bin_hz, low_hz..=high_hz);
        assert!((fall_db - expected_db).abs() < 0.1 * expected_db, "{fall_db} {expected_db}");
        // too few bins
        assert_eq!(noise_fall_db(&power, bin_hz, 95.0..=105.0), 0.0);
    }
}
