//! Spectrum with its loud lines → levels without the side lobes of those lines, which would pass for lines beside them.

use hovertone_signal::peak::hann_peak_offset_bins;
use hovertone_signal::spectrogram::power_db;
use std::f64::consts::PI;

/// Smallest level of a line over the floor, dB, whose skirt is looked at: the highest side lobe is 31 dB below the line. *Numeric.*
const LOUD_DB_MIN: f32 = 20.0;
/// Half width of the main lobe of a Hann window, in bins. *Physics.*
const MAIN_LOBE_BINS: f64 = 2.0;
/// What the skirt may exceed the formula by, dB: the loudest bin is up to 1.4 dB below its line, a transform that is 8 % longer than its window adds
/// 2 dB, and the floor adds to the skirt. *Numeric.*
const MARGIN_DB: f64 = 6.0;
/// What lies this far below the loudest line of a spectrum, dB, is rounding and distortion: 16 bits round a sine at a quarter of full scale with
/// lines 75 dB and more below it. *Decision.*
const RANGE_DB: f64 = 75.0;

/// Levels to the floor what the skirts of loud lines explain.
///
/// The side lobes of a Hann window are below 1 / (π x (x² − 1)) of the amplitude of their line, x bins from it (Harris 1978). A bin within that, and
/// beyond the main lobe, is no line. The same holds for a bin far below the loudest line.
///
/// `power` is the spectrum, `level_db` the level of each bin over the floor.
pub(super) fn level_skirts(power: &[f32], level_db: &mut [f32]) {
    let lines: Vec<LoudLine> =
        (2..level_db.len().min(power.len())).filter_map(|bin| line_at(power, level_db, bin)).collect();
    let Some(loudest_db) = lines.iter().map(|line| line.db).max_by(f64::total_cmp) else { return };
    for (level, &power) in level_db.iter_mut().zip(power) {
        if *level > 0.0 && power_db(f64::from(power)) < loudest_db - RANGE_DB {
            *level = 0.0;
        }
    }
    // further away the range is what limits
    let reach = ((10f64.powf((RANGE_DB + MARGIN_DB) / 10.0).sqrt() / PI).cbrt() + 1.0) as usize;
    for line in &lines {
        let middle = line.place.round() as usize;
        let around = middle.saturating_sub(reach)..=(middle + reach).min(level_db.len() - 1);
        for bin in around.filter(|&bin| (bin as f64 - line.place).abs() >= MAIN_LOBE_BINS) {
            let x = (bin as f64 - line.place).abs();
            let below_db = power_db((PI * x * (x * x - 1.0)).powi(2));
            if level_db[bin] > 0.0 && power_db(f64::from(power[bin])) < line.db - below_db + MARGIN_DB {
                level_db[bin] = 0.0;
            }
        }
    }
}

/// A line with a skirt.
struct LoudLine {
    /// Its place, in bins.
    place: f64,
    /// Its level, dB re a sine of full scale.
    db: f64,
}

fn line_at(power: &[f32], level_db: &[f32], bin: usize) -> Option<LoudLine> {
    if level_db[bin] < LOUD_DB_MIN {
        return None;
    }
    let [before, top, after] = [bin - 1, bin, bin + 1].map(|bin| power.get(bin).copied().map(f64::from));
    let offset = hann_peak_offset_bins(before?, top?, after?)?;
    Some(LoudLine { place: bin as f64 + offset, db: power_db(top?) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_signal::spectrogram::{Stft, Window, whitened_db};
    use std::f64::consts::TAU;

    /// Levels of a second of sound, with and without the skirts.
    fn levels(sound: impl Fn(f64) -> f64) -> (Vec<f32>, Vec<f32>) {
        let rate_hz = 8000.0;
        let mut noise = 1u64;
        let samples: Vec<f32> = (0..8000)
            .map(|n| {
                noise = noise.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (sound(f64::from(n) / rate_hz) + 1e-4 * ((noise >> 40) as f64 / f64::from(1 << 23) - 1.0)) as f32
            })
            .collect();
        let mut spectra: Vec<Vec<f32>> = Vec::new();
        Stft::<f64>::new(rate_hz, Window::Hann, 1.0, 1.0, 1).push(&samples, |frame| {
            spectra.push(frame.power.iter().map(|&power| power as f32).collect());
        });
        let with: Vec<f32> = whitened_db(&spectra[0]).into_iter().map(|level| level as f32).collect();
        let mut without = with.clone();
        level_skirts(&spectra[0], &mut without);
        (with, without)
    }

    fn loud(levels: &[f32]) -> Vec<usize> {
        (0..levels.len()).filter(|&bin| levels[bin] >= 20.0).collect()
    }

    #[test]
    fn a_sine_is_its_main_lobe_alone() {
        for hz in [437.2, 437.31, 437.5] {
            let (with, without) = levels(|t| 0.5 * (TAU * hz * t).sin());
            assert!(loud(&with).len() > 6, "{:?}", loud(&with));
            assert!(loud(&without).iter().all(|&bin| (bin as f64 - hz).abs() < 2.0), "{hz}: {:?}", loud(&without));
            assert!(!loud(&without).is_empty());
        }
    }

    #[test]
    fn a_weaker_line_beside_a_loud_one_stays() {
        // 40 dB weaker at 8 bins, where the skirt is 64 dB below its line
        let (_, without) = levels(|t| 0.5 * (TAU * 437.31 * t).sin() + 0.005 * (TAU * 445.0 * t).sin());
        assert!(loud(&without).contains(&445), "{:?}", loud(&without));
    }
}
