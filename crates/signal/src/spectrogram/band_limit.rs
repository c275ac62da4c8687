//! Mean spectrum → the frequency above which a codec or a recorder left nothing.

use super::power_db;
use crate::statistics::median;

/// The spectrum is read in strips this wide: wide against a line and its lobes, narrow against a filter's flank.
const STRIP_HZ: f64 = 150.0;
/// A codec's edge falls within this many strips. Microphones and rooms lose no more than a few dB over so little.
const FLANK_STRIPS: usize = 3;
/// Below the edge, the sound reaches over so many strips (2 kHz), three quarters of them, to that level: a rotor's highest line is an
/// edge too, but stands alone.
const PLATEAU_STRIPS: usize = 13;
/// A codec's edge is at least this deep. What remains above is the last bit, or what the decoder's filter lets through.
const CLIFF_DB: f64 = 18.0;
/// Above the edge no strip rises to within this of what was just below it.
const STAYS_DB: f64 = 12.0;

/// The highest frequency that a recording holds, where it ends in a cliff below half the sample rate; `None` where it reaches
/// up to there or just grows quieter.
pub fn band_limit_hz(power: &[f64], bin_hz: f64) -> Option<f64> {
    let bins = ((STRIP_HZ / bin_hz).round() as usize).max(1);
    let strips_db: Vec<f64> = power.chunks_exact(bins).filter_map(median).map(power_db).collect();
    // the last strip holds the recorder's own filter
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

/// The level that three quarters of the strips reach.
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
