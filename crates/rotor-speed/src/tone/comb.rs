//! Survey → shaft speed: which speed explains the lines, as a comb over the whitened spectrum.

use crate::survey::Survey;
use crate::tone::ToneConfig;
use hovertone_signal::spectrogram::whitened_db;
use hovertone_signal::statistics::mean;
use hovertone_vehicle::BLADES_MAX;
use std::ops::RangeInclusive;

/// Distance of neighbouring speeds on the search grid, as a share. *Numeric.*
const GRID_STEP_SHARE: f64 = 0.003;
/// A line counts up to this level, so that one strong line does not outweigh a series. *Decision.*
const LEVEL_DB_MAX: f64 = 40.0;
/// Harmonics of the blade pass that are looked at: as many as stand out of the noise of small multirotors. *Decision.*
const BLADE_PASS_HARMONICS: u32 = 8;
/// Harmonics of the gear mesh that are looked at: the third of the AR.Drone's is at 12 kHz already. *Decision.*
const GEAR_MESH_HARMONICS: u32 = 3;
/// Speeds this near count as the same when rows are pooled: a hover wanders. *Decision.*
const POOL_HALF_WIDTH_SHARE: f64 = 0.012;
/// Every other (or third …) line stronger by this on average means that the lines between are shaft lines, and the blade
/// pass is twice (or three times …) higher. True series of small multirotors recorded so far show at most 2 dB; halved ones
/// 6 dB once and 8 dB or more in all other cases. Levels that scatter by 4 dB from line to line reach 7 dB once in 150. *Decision.*
const ALTERNATION_DB: f64 = 7.0;
/// Lines between that are weaker by less than this on average belong to the same series. *Decision.*
const SERIES_DB: f64 = 3.0;
/// Lines between must stand this far over the floor to be lines at all. *Decision.*
const BETWEEN_DB_MIN: f64 = 6.0;
/// How many lines of a series are looked at for that. *Decision.*
const ALTERNATION_HARMONICS: u32 = 9;

/// Speeds this near belong to rotors of one vehicle, and are no runner-up of each other. *Decision.*
const SAME_VEHICLE_SHARE: f64 = 0.25;

/// Speeds of a row whose comb reaches this share of the best one's stand out of it. *Decision.*
const OUTSTANDING_SHARE: f64 = 0.5;
/// The line of a gear mesh that stands this far over the floor is heard; this much is much stronger or weaker. *Decision.*
const MESH_DB_MIN: f64 = 6.0;
/// Lines of a series are looked for within this share, and a bin. *Decision.*
const LINE_HALF_WIDTH_SHARE: f64 = 0.015;

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
    blades: Option<f64>,
    mesh_order: Option<f64>,
}

impl Comb {
    pub(crate) fn for_tone(tone: &ToneConfig) -> Self {
        let order = tone.order.lines_per_turn();
        let is_blade_pass = order <= BLADES_MAX;
        let blades = tone.blades.map(f64::from).or(is_blade_pass.then_some(order));
        let mut teeth = Vec::new();
        let mut gaps = Vec::new();
        if let Some(blades) = blades {
            teeth.extend(series(blades, BLADE_PASS_HARMONICS));
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
            teeth.extend(series(order, GEAR_MESH_HARMONICS));
            // a mesh at twice its frequency would have its own first line halfway; a codec that cuts the third makes that likely
            gaps.extend([1.0, 2.0].map(|k: f64| Tooth { order: (k - 0.5) * order, weight: k.powf(-0.5) }));
        }
        Self { teeth, gaps, blades, mesh_order: (!is_blade_pass).then_some(order) }
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

/// Level over the floor at a place between bins: the highest within the grid's step, 0 beyond the spectrum.
fn level_db(whitened: &[f64], place: f64) -> f64 {
    let half = place * GRID_STEP_SHARE / 2.0;
    let (first, last) = ((place - half).round() as usize, (place + half).round() as usize);
    let highest = whitened.get(first..=last).map_or(0.0, |levels| levels.iter().copied().fold(0.0, f64::max));
    highest.min(LEVEL_DB_MAX)
}

/// Levels of every other (third …) line of a series against the lines between.
struct Alternation {
    /// How far the lines stand over the mean of the two beside them.
    over_db: f64,
    /// How far the lines between stand over the floor.
    between_db: f64,
    /// Share of the lines that stand over both beside them.
    over_both_share: f64,
}

impl Alternation {
    fn is_of_a_faster_shaft(&self) -> bool {
        self.over_db > ALTERNATION_DB && self.over_both_share >= 2.0 / 3.0
    }

    fn is_of_one_series(&self) -> bool {
        self.over_db < SERIES_DB && self.between_db > BETWEEN_DB_MIN
    }
}

/// How well each speed explains each row of a survey.
pub(crate) struct CombMap {
    speeds_rev_s: Vec<f64>,
    /// One row of scores for each row of the survey.
    scores_db: Vec<Vec<f64>>,
    comb: Comb,
    pooled_db: Vec<f64>,
    bin_hz: f64,
}

impl CombMap {
    /// Scores every speed of the range in every row.
    pub(crate) fn from_survey(survey: &Survey, tone: &ToneConfig, search_rev_s: &RangeInclusive<f64>) -> Self {
        let comb = Comb::for_tone(tone);
        let (&low, &high) = (search_rev_s.start(), search_rev_s.end());
        let count = ((high / low).ln() / GRID_STEP_SHARE).ceil() as usize + 1;
        let speeds_rev_s: Vec<f64> = (0..count).map(|i| low * (GRID_STEP_SHARE * i as f64).exp()).collect();
        let mut pooled_db = vec![0.0; survey.rows.first().map_or(0, |row| row.power.len())];
        let scores_db = survey
            .rows
            .iter()
            .map(|row| {
                let whitened = whitened_db(&row.power);
                pooled_db.iter_mut().zip(&whitened).for_each(|(sum, level)| *sum += level / survey.rows.len() as f64);
                speeds_rev_s.iter().map(|&speed| comb.score_db(&whitened, survey.bin_hz, speed)).collect()
            })
            .collect();
        Self { speeds_rev_s, scores_db, comb, pooled_db, bin_hz: survey.bin_hz }
    }

    /// The speed that explains most of the recording. Squares count strong rows more than many weak ones.
    pub(crate) fn leading_speed_rev_s(&self) -> Option<f64> {
        let reach = (POOL_HALF_WIDTH_SHARE / GRID_STEP_SHARE).round() as usize;
        let pooled = |i: usize| -> f64 {
            let window = i.saturating_sub(reach)..(i + reach + 1).min(self.speeds_rev_s.len());
            self.scores_db.iter().map(|row| row[window.clone()].iter().copied().fold(0.0, f64::max).powi(2)).sum()
        };
        let best = (0..self.speeds_rev_s.len()).map(|i| (i, pooled(i))).max_by(|a, b| a.1.total_cmp(&b.1));
        let (best, _) = best.filter(|&(_, support)| support > 0.0)?;
        Some(self.without_alternation(self.refined_rev_s(self.speeds_rev_s[best])))
    }

    /// A speed and the best of those that belong to no rotor of the same vehicle, each with its mean score over the rows in dB.
    pub(crate) fn best_two(&self, speed_rev_s: f64) -> Vec<(f64, f64)> {
        let reach = (POOL_HALF_WIDTH_SHARE / GRID_STEP_SHARE).round() as usize;
        let rows = self.scores_db.len().max(1) as f64;
        let mean_db = |i: usize| -> f64 {
            let window = i.saturating_sub(reach)..(i + reach + 1).min(self.speeds_rev_s.len());
            self.scores_db.iter().map(|row| row[window.clone()].iter().copied().fold(0.0, f64::max)).sum::<f64>() / rows
        };
        let is_near = |other: f64, share: f64| (other / speed_rev_s).ln().abs() < share;
        let best = |is_wanted: &dyn Fn(f64) -> bool| {
            let wanted = (0..self.speeds_rev_s.len()).filter(|&i| is_wanted(self.speeds_rev_s[i]));
            wanted.map(|i| (self.speeds_rev_s[i], mean_db(i))).max_by(|a, b| a.1.total_cmp(&b.1))
        };
        let own = best(&|other| is_near(other, POOL_HALF_WIDTH_SHARE)).map(|(_, score_db)| (speed_rev_s, score_db));
        own.into_iter().chain(best(&|other| !is_near(other, SAME_VEHICLE_SHARE))).collect()
    }

    /// A speed that pooling has found to within its reach: the mean of what the rows around it say, each as its score.
    fn refined_rev_s(&self, speed_rev_s: f64) -> f64 {
        let said = (0..self.scores_db.len())
            .filter_map(|row| self.best_near(row, speed_rev_s, 2.0 * POOL_HALF_WIDTH_SHARE))
            .filter(|&(_, score)| score > 0.0);
        weighted_mean(said.map(|(speed, score)| (speed, score.powi(2)))).unwrap_or(speed_rev_s)
    }

    /// Settles the octave by how levels alternate. Lines between the blade pass and its harmonics can be those of the shaft,
    /// for two blades one between each two, for three blades two; but then they are much the weaker. So a speed whose every
    /// other (third …) line is by far the strongest is multiplied, and one whose lines between are as strong is divided.
    fn without_alternation(&self, speed_rev_s: f64) -> f64 {
        let Some(blades) = self.comb.blades.filter(|blades| blades.fract() == 0.0) else { return speed_rev_s };
        let is_searched = |speed: f64| {
            self.speeds_rev_s.first().is_some_and(|&low| speed >= low)
                && self.speeds_rev_s.last().is_some_and(|&high| speed <= high)
        };
        for factor in [2u32, 3, 5].into_iter().filter(|&factor| (blades as u32).is_multiple_of(factor)) {
            let times = f64::from(factor);
            if self.mesh_settles(speed_rev_s, times) {
                continue;
            }
            if is_searched(times * speed_rev_s)
                && self.alternation(blades * speed_rev_s, factor).is_some_and(|it| it.is_of_a_faster_shaft())
            {
                return times * speed_rev_s;
            }
            if is_searched(speed_rev_s / times)
                && self.alternation(blades * speed_rev_s / times, factor).is_some_and(|it| it.is_of_one_series())
            {
                return speed_rev_s / times;
            }
        }
        speed_rev_s
    }

    /// How the `factor`-th, 2 `factor`-th … line of a series stand to the lines beside them.
    fn alternation(&self, tone_hz: f64, factor: u32) -> Option<Alternation> {
        let line_db = |k: u32| self.line_db(f64::from(k) * tone_hz);
        let triples: Vec<(f64, f64, f64)> = (1..=ALTERNATION_HARMONICS / factor)
            .map(|index| index * factor)
            .filter_map(|k| Some((line_db(k)?, line_db(k - 1)?, line_db(k + 1)?)))
            .collect();
        let over_db: Vec<f64> = triples.iter().map(|(line, before, after)| line - (before + after) / 2.0).collect();
        let between_db: Vec<f64> = triples.iter().map(|(_, before, after)| (before + after) / 2.0).collect();
        let over_both = triples.iter().filter(|(line, before, after)| line > before && line > after).count();
        Some(Alternation {
            over_db: mean(&over_db)?,
            between_db: mean(&between_db)?,
            over_both_share: over_both as f64 / triples.len() as f64,
        })
    }

    /// How far the strongest line around a frequency stands over the floor of the whole recording.
    fn line_db(&self, hz: f64) -> Option<f64> {
        let place = hz / self.bin_hz;
        let half = LINE_HALF_WIDTH_SHARE * place + 1.0;
        let levels = self.pooled_db.get((place - half) as usize..=(place + half) as usize)?;
        Some(levels.iter().copied().fold(f64::MIN, f64::max))
    }

    /// What the gear mesh says of a shaft at this speed, where the blade pass doubts its octave: whether its own line is heard, that
    /// of a shaft so many times faster is not much stronger, and those of one slower, to either side of it, are not as strong.
    fn mesh_settles(&self, speed_rev_s: f64, times: f64) -> bool {
        let mesh_db = |share: f64| self.comb.mesh_order.and_then(|order| self.line_db(order * share * speed_rev_s));
        mesh_db(1.0).is_some_and(|own_db| {
            own_db >= MESH_DB_MIN
                && mesh_db(times).is_none_or(|faster_db| faster_db < own_db + MESH_DB_MIN)
                && [1.0 / times, 1.0 + 1.0 / times]
                    .into_iter()
                    .any(|share| mesh_db(share).is_none_or(|slower_db| slower_db < own_db - MESH_DB_MIN))
        })
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
    use crate::survey::{SurveyBuilder, SurveySettings};
    use crate::tone::ToneConfig;
    use hovertone_vehicle::Order;
    use std::f64::consts::TAU;

    fn leading_rev_s(orders: &[f64], speed_rev_s: f64) -> f64 {
        let lines: Vec<(f64, f64)> = orders.iter().map(|&order| (order, 1.0)).collect();
        leading_of_lines(&lines, &ToneConfig::of_order(Order::new(orders[0]).unwrap()), speed_rev_s)
    }

    fn leading_of_lines(lines: &[(f64, f64)], tone: &ToneConfig, speed_rev_s: f64) -> f64 {
        map_of_lines(lines, tone, speed_rev_s).leading_speed_rev_s().unwrap()
    }

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
        let mut builder = SurveyBuilder::new(SurveySettings::default(), rate, 0.0);
        builder.push(&samples);
        CombMap::from_survey(&builder.finish(3.0), tone, &(15.0..=280.0))
    }

    #[test]
    fn the_leading_speed_is_right_within_the_grid_and_not_to_one_side() {
        let errors: Vec<f64> = (0..20)
            .map(|step| 41.0 * 1.085f64.powi(step))
            .map(|speed_rev_s| leading_rev_s(&[2.0, 4.0, 6.0, 8.0], speed_rev_s) / speed_rev_s - 1.0)
            .collect();
        // the survey resolves 5 Hz, a sixteenth of the lowest blade pass here; eight lines share the reading
        for (step, error) in errors.iter().enumerate() {
            assert!(error.abs() < 0.008, "step {step}: {error}");
        }
        assert!(mean(&errors).unwrap().abs() < 0.002, "{errors:?}");
    }

    #[test]
    fn a_gear_mesh_settles_the_octave_where_the_blade_pass_alternates() {
        // every second line of the blade pass far the stronger, as echoes can make it: of four rotors or of one
        let blade_pass = [(2.0, 0.03), (4.0, 1.0), (6.0, 0.03), (8.0, 1.0), (10.0, 0.03), (12.0, 1.0)];
        let mesh = [(69.0, 0.3), (138.0, 0.3), (207.0, 0.1)];
        let with_mesh: Vec<(f64, f64)> = mesh.into_iter().chain(blade_pass).collect();
        let mut tone = ToneConfig::of_order(Order::new(69.0).unwrap());
        tone.blades = Some(2);
        let heard = leading_of_lines(&with_mesh, &tone, 60.17);
        assert!((heard / 60.17 - 1.0).abs() < 0.01, "{heard}");
    }

    #[test]
    fn the_runner_up_of_a_blade_pass_is_its_octave_and_has_fewer_lines() {
        let map =
            map_of_lines(&[(2.0, 1.0), (4.0, 1.0), (6.0, 1.0)], &ToneConfig::of_order(Order::new(2.0).unwrap()), 80.0);
        let weighed = map.best_two(map.leading_speed_rev_s().unwrap());
        let &[(speed_rev_s, own_db), (other_rev_s, other_db)] = weighed.as_slice() else { panic!("{weighed:?}") };
        assert!((speed_rev_s / 80.0 - 1.0).abs() < 0.01 && own_db > 1.2 * other_db, "{weighed:?}");
        assert!([0.5, 2.0, 3.0].iter().any(|ratio| (other_rev_s / 80.0 / ratio - 1.0).abs() < 0.03), "{weighed:?}");
    }

    #[test]
    fn a_gear_mesh_is_found_to_a_thousandth() {
        for speed_rev_s in [33.3, 51.0, 60.17] {
            let error = leading_rev_s(&[69.0, 138.0, 207.0], speed_rev_s) / speed_rev_s - 1.0;
            assert!(error.abs() < 0.0015, "{speed_rev_s}: {error}");
        }
    }
}
