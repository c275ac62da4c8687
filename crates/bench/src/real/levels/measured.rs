//! The levels of one recording by class of line, and its evidence: the same code for simulated and for real sound.

use super::super::judgement::Verdict;
use hovertone::speed::{ComparedSpeed, EvidenceNear, LinesNear};

/// Standard deviations of the noise above which a line is audible, as in `docs/measurements.md`.
const AUDIBLE_STDS: f64 = 2.5;
/// Harmonics of the blade pass that are measured.
const HARMONICS: u32 = 12;
/// Fewest audible lines of the blade pass that tell a fall.
const FALL_LINES_MIN: usize = 3;
/// Least level of the first line of the blade pass for which lines below it are measured.
const BELOW_FIRST_DB_MIN: f64 = 15.0;
/// A compared speed this close to the true one is the true octave, as a share: rotors of a vehicle lie within it.
const SAME_OCTAVE_SHARE: f64 = 0.15;

/// What is measured of one recording; absent where too few lines are audible.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Measured {
    pub(super) first_db: Option<f64>,
    pub(super) first_power_db: Option<f64>,
    pub(super) fall: Option<f64>,
    pub(super) scatter_db: Option<f64>,
    pub(super) shaft_offset_db: Option<f64>,
    pub(super) below_db: Option<f64>,
    pub(super) blade_pass_share: Option<f64>,
    pub(super) shaft_share: Option<f64>,
    pub(super) below_share: Option<f64>,
    pub(super) noise_lines_share: Option<f64>,
    pub(super) votes_nats: Option<f64>,
    pub(super) levels_nats: Option<f64>,
    /// Logarithm of the odds of the true octave against its best rival; infinite without a rival, or without the truth.
    pub(super) octave_nats: Option<f64>,
}

/// A recording with what is measured of it, and with the answer of the estimator.
#[derive(Clone, Debug)]
pub(super) struct Heard {
    pub(super) name: String,
    pub(super) measured: Measured,
    pub(super) verdict: Verdict,
    /// The told speed, or that of the first reading, over the true one.
    pub(super) told_share: Option<f64>,
}

/// A quantity of the tables.
pub(super) struct Quantity {
    pub(super) title: &'static str,
    pub(super) of: fn(&Measured) -> Option<f64>,
}

pub(super) const QUANTITIES: [Quantity; 13] = [
    Quantity { title: "first line of the blade pass over the floor (dB)", of: |it| it.first_db },
    Quantity { title: "the same over the mean floor of the recording (dB)", of: |it| it.first_power_db },
    Quantity { title: "fall for a tenfold order (10 dB)", of: |it| it.fall },
    Quantity { title: "scatter of blade pass lines (dB)", of: |it| it.scatter_db },
    Quantity { title: "offset of audible shaft lines (dB)", of: |it| it.shaft_offset_db },
    Quantity { title: "lines below the blade pass (dB)", of: |it| it.below_db },
    Quantity { title: "audible share, blade pass", of: |it| it.blade_pass_share },
    Quantity { title: "audible share, shaft lines", of: |it| it.shaft_share },
    Quantity { title: "audible share, below the blade pass", of: |it| it.below_share },
    Quantity { title: "lines of something else (share)", of: |it| it.noise_lines_share },
    Quantity { title: "votes, median over the frames (nats)", of: |it| it.votes_nats },
    Quantity { title: "evidence of the levels (nats)", of: |it| it.levels_nats },
    Quantity { title: "true octave over its best rival (nats)", of: |it| it.octave_nats },
];

impl Measured {
    /// From what the estimator sees near the true speed.
    pub(super) fn of(seen: &EvidenceNear, blades: u32, true_rev_s: f64) -> Self {
        let of_lines = seen.lines.as_ref().map(|lines| Self::of_lines(lines, blades)).unwrap_or_default();
        Self { levels_nats: seen.levels_nats, octave_nats: octave_nats(&seen.speeds, true_rev_s), ..of_lines }
    }

    fn of_lines(lines: &LinesNear, blades: u32) -> Self {
        let audible_db = lines.noise.mean_db + AUDIBLE_STDS * lines.noise.std_db;
        let all: Vec<Line> = lines
            .levels
            .iter()
            .filter(|line| line.order <= HARMONICS * blades)
            .map(|line| Line {
                harmonic: f64::from(line.order) / f64::from(blades),
                is_blade_pass: line.order.is_multiple_of(blades),
                level_db: line.level_db,
                power_db: line.level_db + line.floor_db,
            })
            .collect();
        let of_class = |is_of: fn(&Line) -> bool| -> Class {
            let lines: Vec<Line> = all.iter().copied().filter(is_of).collect();
            let audible: Vec<Line> = lines.iter().copied().filter(|line| line.level_db > audible_db).collect();
            Class { count: lines.len(), audible }
        };
        let blade_pass = of_class(|line| line.is_blade_pass);
        let shaft = of_class(|line| !line.is_blade_pass && line.harmonic > 1.0);
        let below = of_class(|line| line.harmonic < 1.0);
        let fit = Fit::of(&blade_pass.audible);
        let first = all.iter().find(|line| line.harmonic == 1.0).copied();
        let first_db = first.map(|line| line.level_db);
        let loud = first.filter(|first| first.level_db >= BELOW_FIRST_DB_MIN);
        Self {
            first_db,
            first_power_db: first.map(|line| line.power_db),
            fall: fit.map(|fit| fit.fall),
            scatter_db: fit.and_then(|fit| fit.scatter_db),
            shaft_offset_db: fit
                .and_then(|fit| mean(shaft.audible.iter().map(|line| line.power_db - fit.level_db(line.harmonic)))),
            below_db: loud.and_then(|first| mean(below.audible.iter().map(|line| line.power_db - first.power_db))),
            blade_pass_share: blade_pass.audible_share(),
            shaft_share: shaft.audible_share(),
            below_share: loud.and_then(|_| below.audible_share()),
            noise_lines_share: Some(lines.noise.lines_share),
            votes_nats: Some(lines.votes_nats),
            ..Self::default()
        }
    }
}

#[derive(Clone, Copy)]
struct Line {
    /// Its order over the blades.
    harmonic: f64,
    is_blade_pass: bool,
    /// Over the floor.
    level_db: f64,
    /// Over the mean floor of the recording.
    power_db: f64,
}

struct Class {
    count: usize,
    audible: Vec<Line>,
}

impl Class {
    fn audible_share(&self) -> Option<f64> {
        (self.count > 0).then(|| self.audible.len() as f64 / self.count as f64)
    }
}

/// The straight line in log order through the lines of the blade pass.
#[derive(Clone, Copy)]
struct Fit {
    first_db: f64,
    fall: f64,
    scatter_db: Option<f64>,
}

impl Fit {
    fn of(lines: &[Line]) -> Option<Self> {
        if lines.len() < FALL_LINES_MIN {
            return None;
        }
        let decades = |line: &Line| 10.0 * line.harmonic.log10();
        let (middle, mean_db) = (mean(lines.iter().map(decades))?, mean(lines.iter().map(|line| line.power_db))?);
        let product = |line: &Line| (decades(line) - middle) * (line.power_db - mean_db);
        let products: f64 = lines.iter().map(product).sum();
        let squares: f64 = lines.iter().map(|line| (decades(line) - middle).powi(2)).sum();
        let slope = products / squares;
        let fit = Self { first_db: mean_db - slope * middle, fall: -slope, scatter_db: None };
        let left: f64 = lines.iter().map(|line| (line.power_db - fit.level_db(line.harmonic)).powi(2)).sum();
        let scatter_db = (lines.len() > FALL_LINES_MIN).then(|| (left / (lines.len() - 2) as f64).sqrt());
        Some(Self { scatter_db, ..fit })
    }

    fn level_db(&self, harmonic: f64) -> f64 {
        self.first_db - self.fall * 10.0 * harmonic.log10()
    }
}

/// `None` where no rotor is heard.
fn octave_nats(speeds: &[ComparedSpeed], true_rev_s: f64) -> Option<f64> {
    let is_true = |it: &&ComparedSpeed| (it.speed_rev_s / true_rev_s - 1.0).abs() < SAME_OCTAVE_SHARE;
    let best = |belief: f64, it: &ComparedSpeed| belief.max(it.belief);
    let truth = speeds.iter().filter(is_true).fold(0.0, best);
    let rival = speeds.iter().filter(|it| !is_true(it)).fold(0.0, best);
    (!speeds.is_empty())
        .then(|| truth.ln() - rival.ln())
        .map(|nats| if nats.is_nan() { f64::NEG_INFINITY } else { nats })
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0_u32), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone::speed::{NoiseLevel, OrderLevel};

    /// Levels of a rotor by formula come back: 20 dB, a fall of 1.5, shaft lines 6 dB lower, order 1 at −14 dB.
    #[test]
    fn the_levels_of_a_formula_are_measured() {
        let level_db = |order: u32| {
            let fall_db = 15.0 * (f64::from(order) / 2.0).log10();
            match order {
                1 => 20.0 - 14.0,
                order if order.is_multiple_of(2) => 20.0 - fall_db,
                _ => 14.0 - fall_db,
            }
        };
        let levels = (1..=40).map(|order| OrderLevel { order, level_db: level_db(order), floor_db: 0.0 }).collect();
        let noise = NoiseLevel { mean_db: -2.0, std_db: 0.5, lines_share: 0.1, places: 100.0 };
        let lines = LinesNear { speed_rev_s: 80.0, votes_nats: 3.0, levels, noise, levels_nats: 50.0 };
        let speed = |speed_rev_s, belief| ComparedSpeed { speed_rev_s, belief };
        let speeds = vec![speed(81.0, 0.9), speed(160.0, 0.06), speed(40.0, 0.04)];
        let measured = Measured::of(&EvidenceNear { lines: Some(lines), levels_nats: Some(90.0), speeds }, 2, 80.0);
        let is_near = |found: Option<f64>, expected: f64| {
            assert!((found.unwrap() - expected).abs() < 1e-9, "{found:?} {expected}");
        };
        is_near(measured.first_db, 20.0);
        is_near(measured.fall, 1.5);
        is_near(measured.scatter_db, 0.0);
        is_near(measured.shaft_offset_db, -6.0);
        is_near(measured.below_db, -14.0);
        is_near(measured.blade_pass_share, 1.0);
        // of the odd orders 3 to 23, those up to 19 are above −0.75 dB
        is_near(measured.shaft_share, 9.0 / 11.0);
        is_near(measured.octave_nats, (0.9_f64 / 0.06).ln());
        assert_eq!((measured.below_share, measured.levels_nats), (Some(1.0), Some(90.0)));
    }

    #[test]
    fn a_truth_that_is_not_compared_has_no_odds() {
        let wrong = [ComparedSpeed { speed_rev_s: 160.0, belief: 1.0 }];
        assert_eq!(octave_nats(&wrong, 80.0), Some(f64::NEG_INFINITY));
        assert_eq!(octave_nats(&wrong, 160.0), Some(f64::INFINITY));
        assert_eq!(octave_nats(&[], 80.0), None);
    }
}
