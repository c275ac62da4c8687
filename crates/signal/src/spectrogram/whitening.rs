//! Spectrum → level of each bin over the local noise floor, so that a line counts by its height over the noise and not by its
//! loudness.

use super::power_db;
use crate::statistics::median;

/// Half width of the surroundings of a bin, as a share of its frequency: wide against the lines of a rotor, narrow against the
/// changes of the noise spectrum with frequency. *Decision.*
const FLOOR_HALF_WIDTH_SHARE: f64 = 0.12;
/// Smallest number of bins of the surroundings on either side, so that the median of the surroundings lies below a line.
/// *Numeric.*
const FLOOR_HALF_WIDTH_BINS_MIN: usize = 8;
/// Distance between the bins at which the floor is computed, as a share of the half width; between them the floor is
/// interpolated. *Numeric.*
const FLOOR_STEP_SHARE: f64 = 0.25;

/// Level of each bin over the noise floor, dB. The floor is the median level of the surroundings: ±12 % of the frequency, at
/// least ±8 bins, interpolated linearly between the bins at which it is computed.
///
/// - Input: one-sided power spectrum from 0 Hz, any unit. Output: as many levels. Silence gives 0 dB.
/// - At either end of the spectrum the surroundings lie on one side, and a sloping floor is off by its slope there.
pub fn whitened_db<P: Copy + Into<f64>>(power: &[P]) -> Vec<f64> {
    let level_db: Vec<f64> = power.iter().map(|&power| power_db(power.into())).collect();
    // bin and level of the floor at a few bins
    let mut floors: Vec<(usize, f64)> = Vec::new();
    let mut bin = 0;
    while bin < level_db.len() {
        let half = ((FLOOR_HALF_WIDTH_SHARE * bin as f64) as usize).max(FLOOR_HALF_WIDTH_BINS_MIN);
        let surroundings = &level_db[bin.saturating_sub(half)..(bin + half + 1).min(level_db.len())];
        floors.push((bin, median(surroundings).unwrap_or_default()));
        bin += ((FLOOR_STEP_SHARE * half as f64) as usize).max(1);
    }
    let mut right = 0;
    level_db
        .iter()
        .enumerate()
        .map(|(bin, level)| {
            while right + 1 < floors.len() && floors[right].0 < bin {
                right += 1;
            }
            let (a, b) = (floors[right.saturating_sub(1)], floors[right]);
            let share = if b.0 > a.0 { ((bin - a.0) as f64 / (b.0 - a.0) as f64).min(1.0) } else { 0.0 };
            level - (a.1 + share * (b.1 - a.1))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_stands_over_a_sloping_floor_by_its_own_height() {
        let power: Vec<f64> = (0..2000)
            .map(|bin| {
                let floor = 1e-6 / (1.0 + bin as f64).powi(2);
                if bin == 400 { floor * 1e3 } else { floor }
            })
            .collect();
        let over = whitened_db(&power);
        assert!((over[400] - 30.0).abs() < 0.5, "{}", over[400]);
        // the last bins have surroundings on one side only
        for (bin, level) in over.iter().enumerate().take(1700).skip(50) {
            assert!(bin == 400 || level.abs() < 0.5, "bin {bin}: {level}");
        }
    }

    #[test]
    fn silence_has_no_level_over_its_floor() {
        assert!(whitened_db(&[0.0; 300]).iter().all(|&level| level == 0.0));
        assert!(whitened_db::<f64>(&[]).is_empty());
    }
}
