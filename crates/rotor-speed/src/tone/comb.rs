//! Survey → how well each shaft speed explains each row, as a comb over the whitened spectrum: where a rotor hovers, and how it moves.

use crate::survey::Survey;
use crate::thresholds::{HOVER_WIDTH_SHARE, MESH_LINES, MOST, SERIES_LEVEL_DB_MAX, SERIES_LINES};
use crate::tone::ToneConfig;
use hovertone_signal::spectrogram::whitened_db;
use hovertone_vehicle::BLADES_MAX;
use std::ops::RangeInclusive;

/// Distance of neighbouring speeds or fundamentals on the search grid, as a share. *Numeric.*
pub(super) const GRID_STEP_SHARE: f64 = 0.003;
/// Speeds of a row whose comb reaches this share of the best one's stand out of it.
const OUTSTANDING_SHARE: f64 = MOST;

/// A line that a rotor is expected to make.
#[derive(Clone, Copy, Debug)]
struct Tooth {
    order: f64,
    weight: f64,
}

/// The lines of a rotor that turns once a second, and the places between, where it can have none.
#[derive(Clone, Debug)]
pub(crate) struct Comb {
    teeth: Vec<Tooth>,
    gaps: Vec<Tooth>,
}

impl Comb {
    pub(crate) fn for_tone(tone: &ToneConfig) -> Self {
        let order = tone.order.lines_per_turn();
        let is_blade_pass = order <= BLADES_MAX;
        let blades = tone.blades.map(f64::from).or(is_blade_pass.then_some(order));
        let mut teeth = Vec::new();
        let mut gaps = Vec::new();
        if let Some(blades) = blades {
            teeth.extend(series(blades, SERIES_LINES));
            // a shaft makes lines at whole orders only: what sounds at half orders belongs to a slower shaft
            if blades.fract() == 0.0 {
                let total: f64 = teeth.iter().map(|tooth: &Tooth| tooth.weight).sum();
                gaps = (1..=(4 * blades as u32))
                    .map(|j| Tooth { order: f64::from(j) - 0.5, weight: f64::from(j).powf(-0.5) })
                    .collect();
                scale(&mut gaps, total);
            }
        }
        if !is_blade_pass {
            teeth.extend(series(order, MESH_LINES));
            // a mesh at twice its frequency would have its own first line halfway; a codec that cuts the third makes that likely
            gaps.extend([1.0, 2.0].map(|k: f64| Tooth { order: (k - 0.5) * order, weight: k.powf(-0.5) }));
        }
        Self { teeth, gaps }
    }

    /// Mean level of the lines of a shaft at `speed_rev_s` over the floor, less that of the places between, in dB.
    fn score_db(&self, whitened: &[f64], bin_hz: f64, speed_rev_s: f64) -> f64 {
        let sum = |teeth: &[Tooth]| -> f64 {
            teeth.iter().map(|tooth| tooth.weight * level_db(whitened, tooth.order * speed_rev_s / bin_hz)).sum()
        };
        let total: f64 = self.teeth.iter().map(|tooth| tooth.weight).sum();
        (sum(&self.teeth) - sum(&self.gaps)) / total
    }
}

/// A tone and its harmonics, each counting less than the one before.
fn series(order: f64, harmonics: u32) -> Vec<Tooth> {
    (1..=harmonics).map(f64::from).map(|k| Tooth { order: k * order, weight: k.powf(-0.5) }).collect()
}

fn scale(teeth: &mut [Tooth], total: f64) {
    let sum: f64 = teeth.iter().map(|tooth| tooth.weight).sum();
    teeth.iter_mut().for_each(|tooth| tooth.weight *= total / sum);
}

/// Speeds or fundamentals from one to another, in equal steps of the logarithm.
pub(super) fn search_grid(low: f64, high: f64) -> Vec<f64> {
    let count = ((high / low).ln() / GRID_STEP_SHARE).ceil() as usize + 1;
    (0..count).map(|i| low * (GRID_STEP_SHARE * i as f64).exp()).collect()
}

/// Level over the floor at a place between bins: the highest within the grid's step, 0 beyond the spectrum.
fn level_db(whitened: &[f64], place: f64) -> f64 {
    let half = place * GRID_STEP_SHARE / 2.0;
    let (first, last) = ((place - half).round() as usize, (place + half).round() as usize);
    let highest = whitened.get(first..=last).map_or(0.0, |levels| levels.iter().copied().fold(0.0, f64::max));
    highest.min(SERIES_LEVEL_DB_MAX)
}

/// How well each speed explains each row of a survey.
pub(crate) struct CombMap {
    speeds_rev_s: Vec<f64>,
    /// One row of scores for each row of the survey.
    scores_db: Vec<Vec<f64>>,
}

impl CombMap {
    /// Scores every speed of the range in every row.
    pub(crate) fn from_survey(survey: &Survey, tone: &ToneConfig, search_rev_s: &RangeInclusive<f64>) -> Self {
        let comb = Comb::for_tone(tone);
        let speeds_rev_s = search_grid(*search_rev_s.start(), *search_rev_s.end());
        let scores_db = survey
            .rows
            .iter()
            .map(|row| {
                let whitened = whitened_db(&row.power);
                speeds_rev_s.iter().map(|&speed| comb.score_db(&whitened, survey.bin_hz, speed)).collect()
            })
            .collect();
        Self { speeds_rev_s, scores_db }
    }

    /// Best speed of a row within a share of `speed_rev_s`, and its score.
    pub(crate) fn best_near(&self, row: usize, speed_rev_s: f64, half_width_share: f64) -> Option<(f64, f64)> {
        self.best(row, |speed| (speed / speed_rev_s - 1.0).abs() <= half_width_share)
    }

    /// Mean of the speeds within a share of `speed_rev_s` that stand out of a row: all its rotors'.
    pub(crate) fn mean_near(&self, row: usize, speed_rev_s: f64, half_width_share: f64) -> Option<f64> {
        let (_, best_db) = self.best_near(row, speed_rev_s, half_width_share)?;
        let scores = self.speeds_rev_s.iter().copied().zip(self.scores_db.get(row)?.iter().copied());
        let near = scores.filter(|(speed, _)| (speed / speed_rev_s - 1.0).abs() <= half_width_share);
        weighted_mean(near.map(|(speed, score)| (speed, (score - OUTSTANDING_SHARE * best_db).max(0.0).powi(2))))
    }

    /// The middle of all rotors within a share of the speed of one of them: the mean of what these rows say, each as its best score.
    pub(crate) fn middle_near(
        &self,
        rows: impl Iterator<Item = usize>,
        speed_rev_s: f64,
        half_width_share: f64,
    ) -> f64 {
        let of_row = |row: usize| {
            let (_, best_db) = self.best_near(row, speed_rev_s, half_width_share)?;
            Some((self.mean_near(row, speed_rev_s, half_width_share)?, best_db.powi(2)))
        };
        weighted_mean(rows.filter_map(of_row)).unwrap_or(speed_rev_s)
    }

    /// The mean of the best speeds of all rows near a speed, each as its score: of several rotors one is the best in some rows, and another in
    /// others.
    pub(crate) fn refined_rev_s(&self, speed_rev_s: f64) -> f64 {
        let best = (0..self.scores_db.len()).filter_map(|row| self.best_near(row, speed_rev_s, HOVER_WIDTH_SHARE));
        weighted_mean(best.map(|(speed, score_db)| (speed, score_db.max(0.0).powi(2)))).unwrap_or(speed_rev_s)
    }

    /// Best speed of a row over the whole search, and its score.
    pub(crate) fn best_of_row(&self, row: usize) -> Option<(f64, f64)> {
        self.best(row, |_| true)
    }

    fn best(&self, row: usize, is_wanted: impl Fn(f64) -> bool) -> Option<(f64, f64)> {
        let scores = self.scores_db.get(row)?;
        self.speeds_rev_s
            .iter()
            .copied()
            .zip(scores.iter().copied())
            .filter(|&(speed, _)| is_wanted(speed))
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// The mean of values with their weights. `None` without a weight above 0.
fn weighted_mean(weighted: impl Iterator<Item = (f64, f64)>) -> Option<f64> {
    let (sum, weights) =
        weighted.fold((0.0, 0.0), |(sum, weights), (value, weight)| (sum + value * weight, weights + weight));
    (weights > 0.0).then(|| sum / weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::survey::{RowsBuilder, SurveySettings};
    use crate::tone::ToneConfig;
    use hovertone_signal::statistics::mean;
    use hovertone_vehicle::Order;
    use std::f64::consts::TAU;

    fn map_of_lines(lines: &[(f64, f64)], tone: &ToneConfig, speed_rev_s: f64) -> CombMap {
        let rate = 44100.0;
        let mut noise = 1u64;
        let samples: Vec<f32> = (0..3 * 44100)
            .map(|n| {
                noise = noise.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                let turn = TAU * speed_rev_s * f64::from(n) / rate;
                let sound: f64 = lines.iter().map(|(order, level)| 0.05 * level * (order * turn).cos()).sum();
                (sound + 0.02 * ((noise >> 40) as f64 / f64::from(1 << 23) - 1.0)) as f32
            })
            .collect();
        let mut builder = RowsBuilder::new(rate, 0.0, SurveySettings::default().coarse_rows());
        builder.push(&samples);
        CombMap::from_survey(&Survey::of_rows(builder.finish(3.0)), tone, &(15.0..=280.0))
    }

    /// Error of the speed of all rows near the true one, as a share.
    fn error(orders: &[f64], speed_rev_s: f64) -> f64 {
        let lines: Vec<(f64, f64)> = orders.iter().map(|&order| (order, 1.0)).collect();
        let map = map_of_lines(&lines, &ToneConfig::of_order(Order::new(orders[0]).unwrap()), speed_rev_s);
        map.refined_rev_s(1.01 * speed_rev_s) / speed_rev_s - 1.0
    }

    #[test]
    fn the_speed_of_all_rows_is_right_within_the_grid_and_not_to_one_side() {
        let errors: Vec<f64> = (0..20).map(|step| error(&[2.0, 4.0, 6.0, 8.0], 41.0 * 1.085f64.powi(step))).collect();
        // the survey resolves 5 Hz, a sixteenth of the lowest blade pass here; eight lines share the reading
        for (step, error) in errors.iter().enumerate() {
            assert!(error.abs() < 0.008, "step {step}: {error}");
        }
        assert!(mean(&errors).unwrap().abs() < 0.002, "{errors:?}");
    }

    #[test]
    fn a_gear_mesh_is_found_to_two_thousandths() {
        for speed_rev_s in [33.3, 51.0, 60.17] {
            let error = error(&[69.0, 138.0, 207.0], speed_rev_s);
            assert!(error.abs() < 0.002, "{speed_rev_s}: {error}");
        }
    }
}
