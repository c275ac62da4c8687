//! Log-likelihood ratios of the lines of one class: of a line about a mean level, against noise with lines of something else.

use super::level_table::LEVEL_DB_MIN;
use super::levels::NoiseLevel;
use hovertone_vehicle::LineLevels;

/// Mean levels of a line that the tables hold, dB, in steps of 1 dB. *Numeric.*
const LINE_DB: std::ops::RangeInclusive<i32> = -45..=95;
/// Steps of a measured level to a dB. *Numeric.*
const STEPS_PER_DB: f64 = 16.0;
/// Number of these steps: to 90 dB. *Numeric.*
const MEASURED_STEPS: usize = 1921;
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
    /// `nats[measured level][mean level]`; empty where it was not asked for.
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
        self.scattered_db.iter().map(ratio).collect()
    }

    /// The ratios of a row, from a mean level upwards.
    pub(super) fn from(&self, row: usize, mean_db: f64) -> RatiosFrom<'_> {
        RatiosFrom { nats: &self.nats[row], place: mean_db.round() as i32 - LINE_DB.start() }
    }
}

/// The ratios of one measured level, from a mean level upwards.
pub(super) struct RatiosFrom<'a> {
    nats: &'a [f64],
    place: i32,
}

impl RatiosFrom<'_> {
    /// The ratio so many dB above; outside of the table that at its end.
    pub(super) fn above(&self, db: i32) -> f64 {
        self.nats[(self.place + db).clamp(0, LINE_DB.end() - LINE_DB.start()) as usize]
    }
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
