//! Levels of the lines of a rotor, against levels of nothing.
//!
//! With the loudness g, the fall s, the smear c and the offset d of the shaft lines, the line of order k of a propeller with B blades has the
//! mean level `g − s · 10 log₁₀(k/B) − c · (k/B − 1) − F(k)` over the local floor, plus d where k is no multiple of B. F(k) is the floor at the
//! line against the mean floor of the recording: noise falls with frequency, and hides the lowest lines. A line scatters about its mean, in some
//! recordings more than in others. Lines below the blade pass are weaker, as a slow force radiates little: their mean is g less some dB. A
//! measured level has the noise of the frames.
//! The evidence is the integral of the product of all likelihood ratios over g, s, c, d and the scatter, on a grid. Lines may be missing, all
//! shaft lines may be inaudible, so may all lines above some harmonic, and a place without a line may hold a line of something else. A
//! reflection may take most of a line of the blade pass away (a notch), or weaken every other one: an echo that comes half a period of the
//! blade pass later.

use super::levels::NoiseLevel;
use super::ratio_table::{LineScatter, RatioTable, STEP_DB};
use super::rotor_lines::RotorLines;
use super::votes::AUDIBLE_BESIDE_MESH;
use hovertone_signal::statistics::log_sum_exp;
use hovertone_vehicle::LineLevels;

/// Steps of the integral over the loudness, dB. *Numeric.*
const LOUDNESS_DB: [i32; 22] = [-4, -1, 2, 5, 8, 11, 14, 17, 20, 23, 26, 29, 32, 35, 38, 41, 47, 53, 59, 65, 71, 77];
/// Steps of the integral over the fall. *Numeric.*
const FALLS: [f64; 5] = [0.0, 0.6, 1.2, 2.0, 3.0];
/// Steps of the integral over the smear, dB for each harmonic. *Numeric.*
const SMEARS_DB: [f64; 3] = [1.0, 2.0, 4.0];
/// Steps of the integral over the offset of the shaft lines, dB. *Numeric.*
const SHAFT_DB: [i32; 16] = [-39, -36, -33, -30, -27, -24, -21, -18, -15, -12, -9, -6, -3, 0, 3, 6];
/// Steps of the integral over the level that an echo takes from every other line, dB. *Numeric.*
const ECHO_DB: [i32; 3] = [-6, -12, -18];
/// Lowest sum of loudness and offset, dB. *Numeric.*
const SUM_DB_MIN: i32 = LOUDNESS_DB[0] + SHAFT_DB[0];
/// Number of sums of loudness and offset. *Numeric.*
const SUMS: usize = 43;
/// Logarithm of a likelihood, over the largest, that counts as nothing. *Numeric.*
const NOTHING_NATS: f64 = -60.0;
/// Harmonics of the blade pass above which all lines are inaudible: wander smears them, and recorders and codecs cut them. Each is as
/// probable. *Decision.*
const LAST_HARMONICS: [u32; 13] = [2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 28, 40, LAST_HARMONIC];
/// The highest harmonic of the blade pass that is compared. *Decision.*
pub(super) const LAST_HARMONIC: u32 = 64;

/// Level of one order along a path.
#[derive(Clone, Copy, Debug)]
pub struct OrderLevel {
    /// The order.
    pub order: u32,
    /// Mean over the frames of the level over the floor.
    pub level_db: f64,
    /// The floor there, against the mean floor of the recording, in dB.
    pub floor_db: f64,
}

/// Levels of all lines of a rotor along a path.
#[derive(Clone, Debug, Default)]
pub(crate) struct RotorLevels {
    /// Of the whole orders of the shaft.
    pub(super) shaft: Vec<OrderLevel>,
    /// Of the harmonics of the gear mesh, each with its number instead of its order.
    pub(super) mesh: Vec<OrderLevel>,
}

impl RotorLevels {
    /// The same levels as if the floor were flat.
    fn over_flat_floor(&self) -> Self {
        let flat = |levels: &[OrderLevel]| levels.iter().map(|level| OrderLevel { floor_db: 0.0, ..*level }).collect();
        Self { shaft: flat(&self.shaft), mesh: flat(&self.mesh) }
    }
}

/// Sums of log-likelihood ratios of the lines up to each of the last harmonics, in nats.
type UpTo = [f64; LAST_HARMONICS.len()];

/// The model for the noise of one recording. Its tables are filled as levels are asked for, and serve propellers of all numbers of blades.
pub(super) struct LevelModel<'a> {
    prior: &'a LineLevels,
    below: RatioTable,
    scatters: Vec<Scatter>,
    /// Logarithms of the weights of the integrals.
    loudness_nats: Vec<f64>,
    falls: Vec<(Fall, f64)>,
    /// Weights of the offsets of shaft lines.
    offset_weights: Vec<f64>,
}

/// The lines of recordings whose levels scatter as much.
struct Scatter {
    /// Logarithm of their share.
    share_nats: f64,
    blade_pass: RatioTable,
    shaft: RatioTable,
}

impl<'a> LevelModel<'a> {
    /// The model that tells speeds apart. Motors and other rotors have lines at the orders of a rotor: at least as many as there are in general.
    pub(super) fn of_speeds(noise: NoiseLevel, prior: &'a LineLevels) -> Self {
        Self::new(noise, prior, prior.foreign.max(noise.lines_share))
    }

    /// The model that tells a rotor from none: lines of something else are as frequent as this recording shows.
    pub(super) fn of_presence(noise: NoiseLevel, prior: &'a LineLevels) -> Self {
        Self::new(noise, prior, noise.foreign_share(prior))
    }

    fn new(noise: NoiseLevel, prior: &'a LineLevels, foreign: f64) -> Self {
        let table = |std_db: f64, missing: f64, notched: f64| {
            RatioTable::new(noise, &LineScatter { std_db, missing, notched, prior }, foreign)
        };
        Self {
            prior,
            below: table(prior.below_std_db, prior.below_missing, 0.0),
            scatters: LineLevels::SCATTERS
                .iter()
                .map(|(factor, share)| Scatter {
                    share_nats: share.ln(),
                    blade_pass: table(factor * prior.line_std_db, prior.blade_pass_missing, prior.notched),
                    shaft: table(factor * prior.shaft_line_std_db, prior.shaft_missing, 0.0),
                })
                .collect(),
            loudness_nats: ln_weights(&LOUDNESS_DB.map(f64::from), prior.blade_pass_db, prior.blade_pass_std_db),
            falls: falls(prior),
            offset_weights: weights_of_shaft_lines(prior),
        }
    }

    /// The evidence of levels for a rotor, in nats: log-likelihood ratio against noise with lines of something else. A gear mesh is a series of its
    /// own, whose lines have the levels of a blade pass; beside it, the propeller may be inaudible.
    pub(super) fn evidence_nats(&mut self, levels: &RotorLevels, lines: &RotorLines) -> f64 {
        let shaft_nats = lines.blades.map_or(0.0, |blades| self.shaft_nats(&levels.shaft, blades));
        match lines.mesh_order {
            None => shaft_nats,
            Some(_) => {
                let audible = [(1.0 - AUDIBLE_BESIDE_MESH).ln(), AUDIBLE_BESIDE_MESH.ln() + shaft_nats];
                self.shaft_nats(&levels.mesh, 1) + log_sum_exp(audible.into_iter())
            }
        }
    }

    /// The evidence of the lines of a shaft with so many blades, in nats.
    pub(super) fn shaft_nats(&mut self, levels: &[OrderLevel], blades: u32) -> f64 {
        let below = lines_of(&mut self.below, levels, |order| order < blades);
        let lines: Vec<LinesOfClasses> =
            self.scatters.iter_mut().map(|scatter| LinesOfClasses::of(scatter, levels, blades)).collect();
        let of_scatter = self.scatters.iter().zip(&lines);
        log_sum_exp(
            of_scatter
                .map(|(scatter, lines)| scatter.share_nats + self.nats_of_scatter(scatter, lines, &below, blades)),
        )
    }

    /// The evidence as if the floor were flat. Where lines lie close, as those of a slow comb, they are a part of the floor: then it hides lines that
    /// are not there. So the floor tells octaves apart, and no rotor from none.
    pub(super) fn flat_nats(&mut self, levels: &RotorLevels, lines: &RotorLines) -> f64 {
        self.evidence_nats(&levels.over_flat_floor(), lines)
    }

    /// The same of the propeller alone; 0 where none is followed.
    pub(super) fn flat_propeller_nats(&mut self, levels: &RotorLevels, lines: &RotorLines) -> f64 {
        lines.blades.map_or(0.0, |blades| self.shaft_nats(&levels.over_flat_floor().shaft, blades))
    }

    /// The same of the gear mesh alone; 0 where none is followed.
    pub(super) fn flat_mesh_nats(&mut self, levels: &RotorLevels, lines: &RotorLines) -> f64 {
        lines.mesh_order.map_or(0.0, |_| self.shaft_nats(&levels.over_flat_floor().mesh, 1))
    }

    /// The evidence where the lines scatter as much.
    fn nats_of_scatter(&self, scatter: &Scatter, lines: &LinesOfClasses, below: &[Line], blades: u32) -> f64 {
        let shares = f64::from(LAST_HARMONICS.len() as u32).ln();
        let at_fall = self.falls.iter().map(|(fall, weight)| {
            let even = Likelihoods::of(&sums(&scatter.blade_pass, &lines.even, blades, fall));
            let odd = Likelihoods::of(&sums(&scatter.blade_pass, &lines.odd, blades, fall));
            let shaft = Likelihoods::of(&sums(&scatter.shaft, &lines.shaft, blades, fall));
            let largest_nats: UpTo =
                std::array::from_fn(|last| even.largest_nats[last] + odd.largest_nats[last] + shaft.largest_nats[last]);
            let most_nats = largest_nats.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let shares_of_last = largest_nats.map(|nats| (nats - most_nats).exp());
            let inaudible = shaft.largest_nats.map(|nats| self.prior.shaft_inaudible * (-nats).exp());
            let at_loudness = LOUDNESS_DB.iter().zip(&self.loudness_nats).map(|(&loudness_db, weight)| {
                let mean_db = f64::from(loudness_db) + self.prior.below_db;
                let below_nats: f64 = below.iter().map(|line| self.below.at(line.row, mean_db - line.floor_db)).sum();
                let of_blades = self.of_blades(&even, &odd, loudness_db);
                let of_shaft = self.of_unlike_blades(&shaft, &inaudible, loudness_db);
                let up_to = shares_of_last.iter().zip(of_blades).zip(of_shaft);
                let sum: f64 = up_to.map(|((share, blade), shaft)| share * blade * shaft).sum();
                weight + below_nats + most_nats + sum.max(f64::MIN_POSITIVE).ln() - shares
            });
            weight + log_sum_exp(at_loudness)
        });
        log_sum_exp(at_fall)
    }

    /// The lines of the blade pass, integrated over echoes: over the largest likelihoods. An echo weakens the even harmonics, or the odd ones.
    fn of_blades(&self, even: &Likelihoods, odd: &Likelihoods, loudness_db: i32) -> UpTo {
        let whole = sum_index(loudness_db);
        let share = self.prior.echo / (2 * ECHO_DB.len()) as f64;
        let weak = ECHO_DB.map(|echo_db| sum_index(loudness_db + echo_db));
        let weakened = |of: &Likelihoods, last: usize| -> f64 { weak.iter().map(|&weak| of.of_sum[weak][last]).sum() };
        std::array::from_fn(|last| {
            let (even_whole, odd_whole) = (even.of_sum[whole][last], odd.of_sum[whole][last]);
            let echoes = weakened(even, last) * odd_whole + even_whole * weakened(odd, last);
            share * echoes + (1.0 - self.prior.echo) * even_whole * odd_whole
        })
    }

    /// The other lines of the shaft, integrated over their level against the blade pass: over the largest likelihood. They may be inaudible.
    fn of_unlike_blades(&self, shaft: &Likelihoods, inaudible: &UpTo, loudness_db: i32) -> UpTo {
        let mut audible = [0.0; LAST_HARMONICS.len()];
        for (offset_db, weight) in SHAFT_DB.iter().zip(&self.offset_weights) {
            let of_last = &shaft.of_sum[sum_index(loudness_db + offset_db)];
            audible.iter_mut().zip(of_last).for_each(|(sum, likelihood)| *sum += weight * likelihood);
        }
        let share = 1.0 - self.prior.shaft_inaudible;
        std::array::from_fn(|last| inaudible[last] + share * audible[last])
    }
}

/// Likelihood ratios of the lines of one class, over the largest one up to each of the last harmonics.
struct Likelihoods {
    /// The largest one or that of no line, whichever is larger, as a logarithm.
    largest_nats: UpTo,
    /// For each sum of loudness and offset.
    of_sum: Vec<UpTo>,
}

impl Likelihoods {
    fn of(Sums { up_to, distinct }: &Sums) -> Self {
        let largest_nats: UpTo = std::array::from_fn(|last| up_to.iter().map(|sum| sum[last]).fold(0.0, f64::max));
        let of_sum = up_to.iter().map(|sum| {
            let over_largest = |last: usize| match sum[last] - largest_nats[last] {
                nats if nats < NOTHING_NATS => 0.0,
                nats => nats.exp(),
            };
            let mut of_last = [0.0; LAST_HARMONICS.len()];
            (0..*distinct).for_each(|last| of_last[last] = over_largest(last));
            let whole = of_last[distinct - 1];
            of_last[*distinct..].fill(whole);
            of_last
        });
        Self { largest_nats, of_sum: of_sum.collect() }
    }
}

/// How the levels fall with the harmonics of the blade pass.
#[derive(Clone, Copy)]
struct Fall {
    /// For a tenfold harmonic, in units of 10 dB.
    decade: f64,
    /// From one harmonic to the next, dB: lines that move within a frame are smeared in proportion to their order.
    smear_db: f64,
}

impl Fall {
    /// The fall up to a harmonic, which may be between two.
    fn db(&self, harmonic: f64) -> f64 {
        self.decade * 10.0 * harmonic.log10() + self.smear_db * (harmonic - 1.0)
    }
}

/// The falls over which the evidence is integrated, with the logarithms of their weights.
fn falls(prior: &LineLevels) -> Vec<(Fall, f64)> {
    let steady = ln_weights(&FALLS, prior.fall, prior.fall_std);
    let steady = FALLS
        .iter()
        .zip(steady)
        .map(|(&decade, nats)| (Fall { decade, smear_db: 0.0 }, nats + (1.0 - prior.smeared).ln()));
    let share = prior.smeared / f64::from(SMEARS_DB.len() as u32);
    let smeared = SMEARS_DB.iter().map(|&smear_db| (Fall { decade: prior.fall, smear_db }, share.ln()));
    steady.chain(smeared).collect()
}

/// Index of a sum of loudness and offset.
fn sum_index(sum_db: i32) -> usize {
    (sum_db - SUM_DB_MIN) as usize / STEP_DB
}

/// One line, with the row of its measured level.
#[derive(Clone, Copy)]
struct Line {
    order: u32,
    row: usize,
    floor_db: f64,
}

/// The lines of each class.
struct LinesOfClasses {
    /// Even harmonics of the blade pass.
    even: Vec<Line>,
    /// Odd harmonics of the blade pass.
    odd: Vec<Line>,
    /// Other lines of the shaft above the blade pass.
    shaft: Vec<Line>,
}

impl LinesOfClasses {
    fn of(scatter: &mut Scatter, levels: &[OrderLevel], blades: u32) -> Self {
        Self {
            even: lines_of(&mut scatter.blade_pass, levels, |order| order.is_multiple_of(2 * blades)),
            odd: lines_of(&mut scatter.blade_pass, levels, |order| order % (2 * blades) == blades),
            shaft: lines_of(&mut scatter.shaft, levels, |order| order > blades && !order.is_multiple_of(blades)),
        }
    }
}

/// The lines of the wanted orders.
fn lines_of(table: &mut RatioTable, levels: &[OrderLevel], is_wanted: impl Fn(u32) -> bool) -> Vec<Line> {
    let wanted = levels.iter().filter(|level| is_wanted(level.order));
    wanted.map(|level| Line { order: level.order, row: table.row(level.level_db), floor_db: level.floor_db }).collect()
}

/// Sums of the ratios of the lines of one class.
struct Sums {
    /// For each sum of loudness and offset.
    up_to: Vec<UpTo>,
    /// Number of last harmonics with sums of their own: beyond, there are no more lines.
    distinct: usize,
}

/// The sums where the levels fall with the order. The orders rise.
fn sums(table: &RatioTable, lines: &[Line], blades: u32, fall: &Fall) -> Sums {
    let mut up_to = vec![[0.0; LAST_HARMONICS.len()]; SUMS];
    let (mut sums, mut next) = ([0.0; SUMS], 0);
    let mut keep = |sums: &[f64; SUMS], last: usize| {
        up_to.iter_mut().zip(sums).for_each(|(up_to, &sum)| up_to[last] = sum);
    };
    for line in lines {
        while line.order > LAST_HARMONICS[next] * blades {
            keep(&sums, next);
            next += 1;
        }
        let fall_db = line.floor_db + fall.db(f64::from(line.order) / f64::from(blades));
        table.add_to(&mut sums, line.row, f64::from(SUM_DB_MIN) - fall_db);
    }
    (next..LAST_HARMONICS.len()).for_each(|last| keep(&sums, last));
    Sums { up_to, distinct: next + 1 }
}

/// Weights of the offsets of shaft lines: blades are alike, or unlike.
fn weights_of_shaft_lines(prior: &LineLevels) -> Vec<f64> {
    let grid = SHAFT_DB.map(f64::from);
    let unlike = ln_weights(&grid, prior.shaft_db, prior.shaft_std_db);
    let alike = ln_weights(&grid, prior.faint_shaft_db, prior.faint_shaft_std_db);
    let weight =
        |(unlike, alike): (f64, f64)| (1.0 - prior.faint_shaft) * unlike.exp() + prior.faint_shaft * alike.exp();
    unlike.into_iter().zip(alike).map(weight).collect()
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

    const NOISE: NoiseLevel = NoiseLevel { mean_db: -1.0, std_db: 1.0, lines_share: 0.05, places: 180.0 };

    fn evidence(levels_db: &[f64], blades: u32) -> f64 {
        let levels: Vec<OrderLevel> =
            (1..).zip(levels_db).map(|(order, &level_db)| OrderLevel { order, level_db, floor_db: 0.0 }).collect();
        LevelModel::of_speeds(NOISE, &LineLevels::default()).shaft_nats(&levels, blades)
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
