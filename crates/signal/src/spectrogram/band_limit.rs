//! Mean spectrum → the cutoff frequency of a lossy codec or a recorder's filter.

use super::power_db;
use crate::statistics::median;

/// Width of the strips of spectrum that are compared, Hz: wide against a line and its lobes, narrow against the flank of a
/// filter. *Numeric.*
const STRIP_HZ: f64 = 150.0;
/// Width of the flank of a codec's filter, in strips. Over this width, microphones and rooms lose no more than a few dB.
/// *Decision.*
const FLANK_STRIPS: usize = 3;
/// Strips below the cutoff (2 kHz) of which three quarters must be loud. The highest line of a rotor ends in a flank too, but
/// has no loud plateau below it. *Decision.*
const PLATEAU_STRIPS: usize = 13;
/// Smallest drop of level over the flank, dB. Above the cutoff remain the rounding noise and the stop band of the decoder's
/// filter. *Decision.*
const CLIFF_DB: f64 = 18.0;
/// Smallest distance of every strip above the flank from the plateau below it, dB. *Decision.*
const STAYS_DB: f64 = 12.0;

/// Cutoff frequency of a recording, Hz: the lower edge of a steep flank below half the sample rate. `None` where the sound
/// reaches up to half the sample rate, or falls off gradually.
///
/// Method: the median level of strips of 150 Hz. The cutoff is the first strip after which the level falls by 18 dB within
/// three strips and stays low, with a loud plateau of 2 kHz before it.
///
/// - `power`: mean one-sided power spectrum, any unit, from 0 Hz to half the sample rate; `bin_hz`: distance between bins.
/// - Accuracy: two strips (tested between 3.4 and 16 kHz).
pub fn band_limit_hz(power: &[f64], bin_hz: f64) -> Option<f64> {
    let bins = ((STRIP_HZ / bin_hz).round() as usize).max(1);
    let strips_db: Vec<f64> = power.chunks_exact(bins).filter_map(median).map(power_db).collect();
    // the last strip holds the flank of the recorder's anti-aliasing filter
    let strips_db = &strips_db[..strips_db.len().saturating_sub(1)];
    let loudest_from = |strip: usize| strips_db[strip..].iter().copied().fold(f64::MIN, f64::max);
    (1..strips_db.len().saturating_sub(2 * FLANK_STRIPS))
        .find(|&strip| {
            let plateau_db = &strips_db[(strip + 1).saturating_sub(PLATEAU_STRIPS)..=strip];
            let below = lower_quartile(plateau_db).min(strips_db[strip]);
            let above = strips_db[strip + FLANK_STRIPS];
            below - above >= CLIFF_DB && loudest_from(strip + FLANK_STRIPS) <= below - STAYS_DB
        })
        .map(|strip| (strip + 1) as f64 * bins as f64 * bin_hz)
}

/// Lower quartile: three quarters of the values reach it.
fn lower_quartile(levels_db: &[f64]) -> f64 {
    let mut levels_db = levels_db.to_vec();
    levels_db.sort_by(f64::total_cmp);
    levels_db.get(levels_db.len() / 4).copied().unwrap_or(f64::MIN)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A noise floor that falls slowly, with lines, cut at a frequency.
    fn cut_at(limit_hz: f64) -> Vec<f64> {
        (0..4410)
            .map(|bin| {
                let hz = 5.0 * f64::from(bin);
                let level_db = -60.0 - hz / 1000.0 + if bin % 100 < 3 { 40.0 } else { 0.0 };
                let cut_db = ((hz - limit_hz) / 5.0).clamp(0.0, 60.0);
                10f64.powf((level_db - cut_db) / 10.0)
            })
            .collect()
    }

    #[test]
    fn a_cliff_is_found_where_it_is() {
        for limit_hz in [3400.0, 7000.0, 10500.0, 16000.0] {
            let found = band_limit_hz(&cut_at(limit_hz), 5.0).unwrap();
            assert!((found - limit_hz).abs() <= 2.0 * STRIP_HZ, "{limit_hz}: {found}");
        }
    }

    #[test]
    fn a_recording_that_reaches_the_top_or_fades_has_none() {
        assert_eq!(band_limit_hz(&cut_at(1e9), 5.0), None);
        let fading: Vec<f64> = (1..4410).map(|bin| 1.0 / f64::from(bin).powi(4)).collect();
        assert_eq!(band_limit_hz(&fading[100..], 5.0), None);
        // a rotor's last line, wide from wander, over a flat floor
        let lone: Vec<f64> = (0..4410).map(|bin| if (2440..2540).contains(&bin) { 1e-5 } else { 1e-9 }).collect();
        assert_eq!(band_limit_hz(&lone, 5.0), None);
        assert_eq!(band_limit_hz(&[], 5.0), None);
        assert_eq!(band_limit_hz(&[0.0; 4410], 5.0), None);
    }
}
