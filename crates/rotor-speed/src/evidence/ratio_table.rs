//! Log-likelihood ratios of the lines of one class: of a line about a mean level, against noise with lines of something else.

use super::level_table::LEVEL_DB_MIN;
use super::levels::NoiseLevel;
use hovertone_vehicle::LineLevels;

/// Mean levels of a line that the tables hold, dB, in steps of 1 dB. *Numeric.*
const LINE_DB: std::ops::RangeInclusive<i32> = -45..=95;
/// Number of these steps. *Numeric.*
const LINE_STEPS: usize = 141;
/// Step of the mean levels of an integral, dB. *Numeric.*
pub(super) const STEP_DB: usize = 3;
/// Steps of a measured level to a dB. *Numeric.*
const STEPS_PER_DB: f64 = 16.0;
/// Number of these steps: to 60 dB, the highest level. *Numeric.*
const MEASURED_STEPS: usize = 1441;
/// Deviations of a line from its mean level over which the tables are integrated, in standard deviations. *Numeric.*
const DEVIATIONS: [f64; 13] = [-3.0, -2.5, -2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0];
/// Range of levels that a line of something else may have, dB. *Decision.*
const FOREIGN_RANGE_DB: f64 = 45.0;

/// How the lines of one class scatter about their mean level.
pub(super) struct LineScatter<'a> {
    /// Its standard deviation.
    pub(super) std_db: f64,
    /// Share of lines that are missing.
    pub(super) missing: f64,
    /// Share of lines in a notch.
    pub(super) notched: f64,
    pub(super) prior: &'a LineLevels,
}

/// Log-likelihood ratios of the lines of one class, as a table over their measured and mean levels. A row is filled when it is first asked for.
pub(super) struct RatioTable {
    noise: NoiseLevel,
    missing: f64,
    notched: f64,
    foreign: f64,
    weights: [f64; DEVIATIONS.len()],
    /// For each mean level, the levels in noise of the lines that scatter about it, and of those in a notch.
    scattered_db: Vec<[[f64; DEVIATIONS.len()]; 2]>,
    /// `nats[measured level]`, with the mean levels in the order of [`in_steps`]; empty where it was not asked for.
    nats: Vec<Vec<f64>>,
}

impl RatioTable {
    pub(super) fn new(noise: NoiseLevel, scatter: &LineScatter<'_>, foreign: f64) -> Self {
        let LineScatter { std_db, missing, notched, prior } = *scatter;
        // mean level of a line of level x in noise: the powers add
        let noise_power = 10f64.powf(noise.mean_db / 10.0);
        let in_noise = |x: f64| 10.0 * (10f64.powf(x / 10.0) + noise_power).log10();
        let about = |mean_db: f64, std_db: f64| DEVIATIONS.map(|deviation| in_noise(mean_db + deviation * std_db));
        let scattered_db = LINE_DB
            .map(f64::from)
            .map(|mean_db| [about(mean_db, std_db), about(mean_db + prior.notch_db, prior.notch_std_db)])
            .collect();
        let sum: f64 = DEVIATIONS.iter().map(|deviation| normal(*deviation)).sum();
        let weights = DEVIATIONS.map(|deviation| normal(deviation) / sum);
        Self { noise, missing, notched, foreign, weights, scattered_db, nats: vec![Vec::new(); MEASURED_STEPS] }
    }

    /// The row of a measured level.
    pub(super) fn row(&mut self, level_db: f64) -> usize {
        let row = ((level_db - LEVEL_DB_MIN) * STEPS_PER_DB).round().clamp(0.0, (MEASURED_STEPS - 1) as f64) as usize;
        if self.nats[row].is_empty() {
            self.nats[row] = self.ratios(LEVEL_DB_MIN + row as f64 / STEPS_PER_DB);
        }
        row
    }

    /// The ratio of a measured level for each mean level.
    fn ratios(&self, level_db: f64) -> Vec<f64> {
        let density = |mean_db: f64| noise_density(level_db - mean_db, self.noise.std_db);
        let nothing = (1.0 - self.foreign) * density(self.noise.mean_db) + self.foreign / FOREIGN_RANGE_DB;
        let mean_density = |means_db: &[f64; DEVIATIONS.len()]| -> f64 {
            self.weights.iter().zip(means_db).map(|(weight, &mean_db)| weight * density(mean_db)).sum()
        };
        let ratio = |[whole_db, in_notch_db]: &[[f64; DEVIATIONS.len()]; 2]| {
            let whole = (1.0 - self.missing - self.notched) * mean_density(whole_db);
            let in_notch = if self.notched > 0.0 { self.notched * mean_density(in_notch_db) } else { 0.0 };
            ((whole + in_notch) / nothing + self.missing).ln()
        };
        let ratios: Vec<f64> = self.scattered_db.iter().map(ratio).collect();
        in_steps(&ratios)
    }

    /// The ratio of a row at a mean level; outside of the table that at its end.
    pub(super) fn at(&self, row: usize, mean_db: f64) -> f64 {
        self.nats[row][place_in_steps((place(mean_db).max(0) as usize).min(LINE_STEPS - 1))]
    }

    /// Adds to each sum the ratio of a row, from a mean level upwards in steps of [`STEP_DB`]; outside of the table that at its end.
    pub(super) fn add_to(&self, sums: &mut [f64], row: usize, mean_db: f64) {
        let nats = &self.nats[row];
        let place = place(mean_db);
        let (last, step) = (LINE_STEPS as i32 - 1, STEP_DB as i32);
        // the first sums lie below the table, and the last ones above
        let below = (((step - 1 - place).max(0) / step) as usize).min(sums.len());
        let inside = (((last - place + step).max(0) / step) as usize).clamp(below, sums.len());
        let (under, rest) = sums.split_at_mut(below);
        let (within, over) = rest.split_at_mut(inside - below);
        under.iter_mut().for_each(|sum| *sum += nats[0]);
        if !within.is_empty() {
            let from = place_in_steps((place + step * below as i32) as usize);
            within.iter_mut().zip(&nats[from..]).for_each(|(sum, ratio)| *sum += ratio);
        }
        let highest = nats[place_in_steps(LINE_STEPS - 1)];
        over.iter_mut().for_each(|sum| *sum += highest);
    }
}

/// Place of a mean level in the table, which may be outside.
fn place(mean_db: f64) -> i32 {
    mean_db.round() as i32 - LINE_DB.start()
}

/// Values of all mean levels, in an order in which those [`STEP_DB`] apart follow each other: they are added together.
fn in_steps(values: &[f64]) -> Vec<f64> {
    (0..STEP_DB).flat_map(|first| values.iter().skip(first).step_by(STEP_DB).copied()).collect()
}

/// Place of a mean level in that order.
fn place_in_steps(place: usize) -> usize {
    place % STEP_DB * LINE_STEPS.div_ceil(STEP_DB) + place / STEP_DB
}

/// Normal density but for its factor.
fn normal(deviation: f64) -> f64 {
    (-0.5 * deviation * deviation).exp()
}

/// Factor of Student's density with eight degrees of freedom, `35 √2/128`. *Numeric.*
const STUDENT_FACTOR: f64 = 0.386_699;

/// Density of a deviation from the mean level: Student's t with eight degrees of freedom, `35 √2/(128 s) · (1 + x²/(8 s²))^(−9/2)`. Skirts of
/// loud lines make deviations of several standard deviations more frequent than a normal distribution allows.
fn noise_density(deviation_db: f64, std_db: f64) -> f64 {
    let base = 1.0 / (1.0 + (deviation_db / std_db).powi(2) / 8.0);
    STUDENT_FACTOR / std_db * base.powi(4) * base.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_are_added_from_below_to_above_the_table() {
        let noise = NoiseLevel { mean_db: -1.0, std_db: 1.0, lines_share: 0.05, places: 180.0 };
        let prior = LineLevels::default();
        let mut table =
            RatioTable::new(noise, &LineScatter { std_db: 4.0, missing: 0.1, notched: 0.1, prior: &prior }, 0.05);
        let row = table.row(12.0);
        assert!(table.at(row, 12.0) > table.at(row, -20.0));
        for mean_db in [-200.0, -170.4, -47.0, -46.0, -45.0, -44.0, -3.3, 20.0, 93.0, 95.0, 96.0, 200.0] {
            let mut sums = [1.0; 43];
            table.add_to(&mut sums, row, mean_db);
            for (step, sum) in sums.iter().enumerate() {
                let expected = 1.0 + table.at(row, mean_db.round() + (STEP_DB * step) as f64);
                assert_eq!(*sum, expected, "{mean_db} dB, step {step}");
            }
        }
    }
}
