//! Levels of the lines of a rotor, against levels of nothing.
//!
//! With the loudness g, the fall s and the offset d of the shaft lines, the line of order k of a propeller with B blades has the mean level
//! `g − s · 10 log₁₀(k/B)`, plus d where k is no multiple of B; it scatters about its mean. Lines below the blade pass are weaker, as a slow
//! force radiates little: their mean is g less some dB. A measured level has the noise of the frames.
//! The evidence is the integral of the product of all likelihood ratios over g, s and d, on a grid. Lines may be missing, all shaft lines
//! may be inaudible, so may all lines above some harmonic, and a place without a line may hold a line of something else. An echo that comes half
//! a period of the blade pass later weakens every other line of the blade pass: so does a reflection from the ground.

use super::levels::NoiseLevel;
use super::settings::LevelPrior;
use hovertone_signal::statistics::log_sum_exp;

/// Mean levels of a line that the tables hold, dB, in steps of 1 dB. *Numeric.*
const LINE_DB_MIN: i32 = -45;
const LINE_DB_MAX: i32 = 80;
/// Deviations of a line from its mean level over which the tables are integrated, in standard deviations. *Numeric.*
const DEVIATIONS: [f64; 13] = [-3.0, -2.5, -2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0];
/// Range of levels that a line of something else may have, dB. *Decision.*
const FOREIGN_RANGE_DB: f64 = 45.0;
/// Steps of the integral over the loudness, dB. *Numeric.*
const LOUDNESS_DB: [f64; 20] = [
    -4.0, -1.0, 2.0, 5.0, 8.0, 11.0, 14.0, 17.0, 20.0, 23.0, 26.0, 29.0, 32.0, 35.0, 38.0, 41.0, 47.0, 53.0, 59.0, 65.0,
];
/// Steps of the integral over the fall. *Numeric.*
const FALLS: [f64; 5] = [0.0, 0.6, 1.2, 2.0, 3.0];
/// Steps of the integral over the offset of the shaft lines, dB. *Numeric.*
const SHAFT_DB: [f64; 16] =
    [-39.0, -36.0, -33.0, -30.0, -27.0, -24.0, -21.0, -18.0, -15.0, -12.0, -9.0, -6.0, -3.0, 0.0, 3.0, 6.0];
/// Steps of the integral over the level that an echo takes from every other line, dB. *Numeric.*
const ECHO_DB: [f64; 3] = [-6.0, -12.0, -18.0];
/// Harmonics of the blade pass above which all lines are inaudible: wander smears them, and recorders and codecs cut them. Each is as
/// probable. *Decision.*
const LAST_HARMONICS: [u32; 10] = [2, 3, 4, 6, 8, 12, 16, 24, 40, LAST_HARMONIC];
/// The highest harmonic of the blade pass that is compared. *Decision.*
pub(super) const LAST_HARMONIC: u32 = 64;
/// Level of one order along a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct OrderLevel {
    pub(super) order: u32,
    pub(super) level_db: f64,
}

/// The evidence of levels for a rotor with so many blades, in nats: log-likelihood ratio against noise with lines of something else.
pub(super) fn evidence_nats(levels: &[OrderLevel], noise: NoiseLevel, blades: u32, prior: &LevelPrior) -> f64 {
    let (below, others): (Vec<OrderLevel>, Vec<OrderLevel>) = levels.iter().partition(|level| level.order < blades);
    let (blade_pass, shaft): (Vec<OrderLevel>, Vec<OrderLevel>) =
        others.iter().partition(|level| level.order.is_multiple_of(blades));
    let foreign = prior.foreign.max(noise.lines_share);
    let below_lines = LineRatios::of(&below, noise, prior.below_std_db, prior.below_missing, foreign);
    let blade_lines = LineRatios::of(&blade_pass, noise, prior.line_std_db, prior.blade_pass_missing, foreign);
    let shaft_lines = LineRatios::of(&shaft, noise, prior.shaft_line_std_db, prior.shaft_missing, foreign);
    let loudness = ln_weights(&LOUDNESS_DB, prior.blade_pass_db, prior.blade_pass_std_db);
    let falls = ln_weights(&FALLS, prior.fall, prior.fall_std);
    let offsets = ln_weights_of_shaft_lines(prior);
    let mean_db = |level: &OrderLevel, at: Loudness| {
        at.loudness_db - at.fall * 10.0 * (f64::from(level.order) / f64::from(blades)).log10()
    };
    let cells = FALLS.iter().zip(&falls).flat_map(|(&fall, fall_weight)| {
        LOUDNESS_DB
            .iter()
            .zip(&loudness)
            .map(move |(&loudness_db, weight)| (Loudness { loudness_db, fall }, fall_weight + weight))
    });
    let last_orders = LAST_HARMONICS.map(|harmonic| harmonic * blades);
    let shares = f64::from(LAST_HARMONICS.len() as u32).ln();
    log_sum_exp(cells.map(|(at, weight)| {
        let blade_nats = blade_nats(&blade_lines, last_orders, blades, prior, |level| mean_db(level, at));
        let with_offset: Vec<[f64; LAST_HARMONICS.len()]> =
            SHAFT_DB.iter().map(|offset| shaft_lines.sums(last_orders, |level| mean_db(level, at) + offset)).collect();
        let [below_nats] = below_lines.sums([blades], |_| at.loudness_db + prior.below_db);
        let up_to = |last: usize| {
            let audible = log_sum_exp(offsets.iter().zip(&with_offset).map(|(weight, nats)| weight + nats[last]));
            let terms = [prior.shaft_inaudible.ln(), (1.0 - prior.shaft_inaudible).ln() + audible];
            below_nats + blade_nats[last] + log_sum_exp(terms.into_iter())
        };
        weight + log_sum_exp((0..LAST_HARMONICS.len()).map(up_to)) - shares
    }))
}

/// The evidence of the lines of the blade pass up to each of the last orders, integrated over echoes.
fn blade_nats<const N: usize>(
    lines: &LineRatios<'_>,
    last_orders: [u32; N],
    blades: u32,
    prior: &LevelPrior,
    mean_db: impl Fn(&OrderLevel) -> f64,
) -> [f64; N] {
    let without = lines.sums(last_orders, &mean_db);
    let echoes: Vec<[f64; N]> = ECHO_DB
        .into_iter()
        .flat_map(|echo_db| [0, 1].map(|weakened| (echo_db, weakened)))
        .map(|(echo_db, weakened)| {
            let is_weakened = |level: &OrderLevel| level.order / blades % 2 == weakened;
            lines.sums(last_orders, |level| mean_db(level) + if is_weakened(level) { echo_db } else { 0.0 })
        })
        .collect();
    let share = prior.echo / echoes.len() as f64;
    std::array::from_fn(|last| {
        let with = echoes.iter().map(|nats| share.ln() + nats[last]);
        log_sum_exp(with.chain([(1.0 - prior.echo).ln() + without[last]]))
    })
}

#[derive(Clone, Copy)]
struct Loudness {
    loudness_db: f64,
    fall: f64,
}

/// Log-likelihood ratios of lines, as a table over their mean levels.
struct LineRatios<'a> {
    levels: &'a [OrderLevel],
    /// `nats[line][mean level]`.
    nats: Vec<Vec<f64>>,
}

impl<'a> LineRatios<'a> {
    fn of(levels: &'a [OrderLevel], noise: NoiseLevel, line_std_db: f64, missing: f64, foreign: f64) -> Self {
        // mean level of a line of level x in noise: the powers add
        let noise_power = 10f64.powf(noise.mean_db / 10.0);
        let in_noise = |x: f64| 10.0 * (10f64.powf(x / 10.0) + noise_power).log10();
        let weights = ln_weights(&DEVIATIONS, 0.0, 1.0).into_iter().map(f64::exp).collect::<Vec<f64>>();
        let scattered: Vec<[f64; DEVIATIONS.len()]> = (LINE_DB_MIN..=LINE_DB_MAX)
            .map(|mean_db| DEVIATIONS.map(|deviation| in_noise(f64::from(mean_db) + deviation * line_std_db)))
            .collect();
        let nats = levels
            .iter()
            .map(|OrderLevel { level_db, .. }| {
                let nothing = (1.0 - foreign) * noise_density(*level_db - noise.mean_db, noise.std_db)
                    + foreign / FOREIGN_RANGE_DB;
                let ratio = |means_db: &[f64; DEVIATIONS.len()]| {
                    let audible: f64 = weights
                        .iter()
                        .zip(means_db)
                        .map(|(weight, mean_db)| weight * noise_density(*level_db - mean_db, noise.std_db))
                        .sum();
                    ((1.0 - missing) * audible / nothing + missing).ln()
                };
                scattered.iter().map(ratio).collect()
            })
            .collect();
        Self { levels, nats }
    }

    /// Sums of the ratios of the lines up to each of the last orders, which rise, where `mean_db` gives the mean level of each line.
    fn sums<const N: usize>(&self, last_orders: [u32; N], mean_db: impl Fn(&OrderLevel) -> f64) -> [f64; N] {
        let index = |level: &OrderLevel| (mean_db(level).round() as i32).clamp(LINE_DB_MIN, LINE_DB_MAX) - LINE_DB_MIN;
        let mut sums = [0.0; N];
        let (mut sum, mut next) = (0.0, 0);
        for (level, nats) in self.levels.iter().zip(&self.nats) {
            while next < N && level.order > last_orders[next] {
                sums[next] = sum;
                next += 1;
            }
            if next == N {
                break;
            }
            sum += nats[index(level) as usize];
        }
        sums[next..].fill(sum);
        sums
    }
}

/// Factor of Student's density with eight degrees of freedom, `35 √2/128`. *Numeric.*
const STUDENT_FACTOR: f64 = 0.386_699;

/// Density of a deviation from the mean level: Student's t with eight degrees of freedom, `35 √2/(128 s) · (1 + x²/(8 s²))^(−9/2)`. Skirts of
/// loud lines make deviations of several standard deviations more frequent than a normal distribution allows.
fn noise_density(deviation_db: f64, std_db: f64) -> f64 {
    let base = 1.0 / (1.0 + (deviation_db / std_db).powi(2) / 8.0);
    STUDENT_FACTOR / std_db * base.powi(4) * base.sqrt()
}

/// Logarithms of the weights of the offsets of shaft lines: blades are alike, or unlike.
fn ln_weights_of_shaft_lines(prior: &LevelPrior) -> Vec<f64> {
    let unlike = ln_weights(&SHAFT_DB, prior.shaft_db, prior.shaft_std_db);
    let alike = ln_weights(&SHAFT_DB, prior.faint_shaft_db, prior.faint_shaft_std_db);
    let (unlike_nats, alike_nats) = ((1.0 - prior.faint_shaft).ln(), prior.faint_shaft.ln());
    let sum = |(unlike, alike): (f64, f64)| log_sum_exp([unlike_nats + unlike, alike_nats + alike].into_iter());
    unlike.into_iter().zip(alike).map(sum).collect()
}

/// Logarithms of normal weights of the points of a grid, which sum to 1.
fn ln_weights(grid: &[f64], mean: f64, std: f64) -> Vec<f64> {
    let logarithms: Vec<f64> = grid.iter().map(|value| -0.5 * ((value - mean) / std).powi(2)).collect();
    let sum = log_sum_exp(logarithms.iter().copied());
    logarithms.into_iter().map(|logarithm| logarithm - sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOISE: NoiseLevel = NoiseLevel { mean_db: -1.0, std_db: 1.0, lines_share: 0.05 };

    fn evidence(levels_db: &[f64], blades: u32) -> f64 {
        let levels: Vec<OrderLevel> =
            (1..).zip(levels_db).map(|(order, &level_db)| OrderLevel { order, level_db }).collect();
        evidence_nats(&levels, NOISE, blades, &LevelPrior::default())
    }

    #[test]
    fn levels_of_a_blade_pass_are_evidence_and_noise_is_evidence_against() {
        let flight = [-1.0, 15.0, -1.0, 12.0, -1.0, 10.0, -1.0, 9.0];
        assert!(evidence(&flight, 2) > 10.0, "{}", evidence(&flight, 2));
        assert!(evidence(&[-1.0; 8], 2) < 0.0);
    }

    #[test]
    fn a_rotor_at_half_the_speed_would_miss_every_other_blade_pass() {
        // the same lines at half the speed: orders 4, 8 … of 16
        let lines = [15.0, 12.0, 10.0, 9.0];
        let at = |step: usize, orders: usize| -> Vec<f64> {
            (1..=orders).map(|order| if order % step == 0 { lines[(order / step - 1) % 4] } else { -1.0 }).collect()
        };
        assert!(evidence(&at(2, 8), 2) > evidence(&at(4, 16), 2) + 5.0);
    }
}
