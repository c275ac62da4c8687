//! Rows of levels → the strongest series of lines in them: a fundamental, followed from row to row.

use super::comb::{GRID_STEP_SHARE, search_grid};
use super::levels::{LevelRow, LevelRows};
use crate::thresholds::{
    CLEAR_DB, FLIGHT_WIDTH_SHARE, HOVER_WIDTH_SHARE, MOST, SEARCHED_NOISE_STDS_MAX, SERIES_LEVEL_DB_MAX, SERIES_LINES,
};
use crate::tone::DiscoveryConfig;
use hovertone_signal::statistics::{mean_by_square, median};

/// Places between lines, at half orders, where a series has none. *Decision.*
const GAP_COUNT: u32 = 4;
/// In the scan a line counts up to this level, so that one strong line does not outweigh a series.
const SCAN_LEVEL_DB_MAX: f32 = SERIES_LEVEL_DB_MAX as f32;
/// A row is looked through this near the fundamental of the whole: rotors in flight change their speed by this.
const ROW_HALF_WIDTH_SHARE: f64 = FLIGHT_WIDTH_SHARE;
/// Speeds this near count as the same when rows are pooled: a hover wanders. *Numeric.*
const POOL_HALF_WIDTH_SHARE: f64 = HOVER_WIDTH_SHARE / 2.0;
/// A row has the family when it scores this share of what its typical rows do.
const PRESENT_SCORE_SHARE: f64 = MOST;
/// Where the peak of a harmonic is looked for beside its expected place, as a share. *Numeric.*
const REFINE_HALF_WIDTH_SHARE: f64 = HOVER_WIDTH_SHARE / 2.0;
/// Peaks lower than this do not take part in the refinement of a fundamental.
const REFINE_LEVEL_DB_MIN: f64 = CLEAR_DB;
/// Lines of a series that are listed at most. *Numeric.*
const LINES_MAX: u32 = 40;
/// A line may lie this many bins beside its place. *Numeric.*
const LINE_BINS: isize = 1;
/// A line stands out of the noise by so many standard deviations: the highest of its places does by 1.5 on average.
const LINE_STDS: f64 = SEARCHED_NOISE_STDS_MAX;
/// Fundamentals end at this share of the highest frequency: the last bins have no floor above them. *Numeric.*
const HZ_MAX_SHARE: f64 = 0.9;
/// Half width of what is taken away around each line, as a share. *Decision.*
const MASK_HALF_WIDTH_SHARE: f64 = 0.025;
/// The same in bins, at least. *Numeric.*
const MASK_HALF_WIDTH_BINS: f64 = 3.0;

/// A series of lines over time.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    /// Fundamental: the median over the rows that have it.
    pub(crate) hz: f64,
    /// Fundamental in each row; absent where the series is not present.
    pub(crate) row_hz: Vec<Option<f64>>,
}

impl Series {
    /// The strongest series of the rows; `None` where none scores enough in any row.
    pub(crate) fn strongest(levels: &LevelRows<'_>, config: &DiscoveryConfig) -> Option<Self> {
        let hz_max = config.fundamental_hz_max.min(HZ_MAX_SHARE * levels.hz_max());
        if hz_max <= config.fundamental_hz_min || levels.rows.is_empty() {
            return None;
        }
        let grid_hz = search_grid(config.fundamental_hz_min, hz_max);
        let scores = scores_db(levels, &grid_hz);
        let leading = leading_place(&scores)?;
        let reach = (ROW_HALF_WIDTH_SHARE / GRID_STEP_SHARE) as usize;
        let window = leading.saturating_sub(reach)..(leading + reach + 1).min(grid_hz.len());
        let windows: Vec<&[f64]> = scores.iter().map(|row| &row[window.clone()]).collect();
        Self::followed(levels, &grid_hz[window], &windows, config)
    }

    /// The series near a fundamental that is known; in all rows where it scores enough in none.
    pub(crate) fn near(levels: &LevelRows<'_>, hz: f64, config: &DiscoveryConfig) -> Self {
        let grid_hz = search_grid(hz * (1.0 - ROW_HALF_WIDTH_SHARE), hz * (1.0 + ROW_HALF_WIDTH_SHARE));
        let scores = scores_db(levels, &grid_hz);
        let windows: Vec<&[f64]> = scores.iter().map(Vec::as_slice).collect();
        let everywhere = || Self { hz, row_hz: vec![Some(hz); levels.rows.len()] };
        Self::followed(levels, &grid_hz, &windows, config).unwrap_or_else(everywhere)
    }

    /// The fundamental with the highest score in each row, where that is enough.
    fn followed(levels: &LevelRows<'_>, grid_hz: &[f64], scores: &[&[f64]], config: &DiscoveryConfig) -> Option<Self> {
        let best: Vec<(usize, f64)> = scores
            .iter()
            .filter_map(|row| row.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1)))
            .collect();
        let typical_db = mean_by_square(best.iter().map(|&(_, score)| score.max(0.0))).unwrap_or(0.0);
        let score_db_min = config.row_score_db_min.max(PRESENT_SCORE_SHARE * typical_db);
        let row_hz: Vec<Option<f64>> = best
            .iter()
            .zip(&levels.rows)
            .map(|(&(place, score), row)| {
                (score >= score_db_min)
                    .then(|| refined_hz(grid_hz[place], levels.bin_hz, 1..=SERIES_LINES, |a, b| row.peak(a, b)))
            })
            .collect();
        let present: Vec<f64> = row_hz.iter().copied().flatten().collect();
        Some(Self { hz: median(&present)?, row_hz })
    }

    /// The same series with its fundamental multiplied.
    pub(crate) fn times(&self, factor: f64) -> Self {
        Self { hz: self.hz * factor, row_hz: self.row_hz.iter().map(|hz| hz.map(|hz| hz * factor)).collect() }
    }

    /// The lines that stand out of the noise, each with its level: the median over the rows that have the series.
    pub(crate) fn heard_lines(&self, levels: &LevelRows<'_>, config: &DiscoveryConfig) -> Vec<(u32, f64)> {
        let present: Vec<(&LevelRow<'_>, f64)> =
            levels.rows.iter().zip(&self.row_hz).filter_map(|(row, hz)| Some((row, (*hz)?))).collect();
        let noise_db = levels.noise_std_db / (present.len().max(1) as f64).sqrt();
        let heard_db = config.line_over_floor_db.max(LINE_STDS * noise_db);
        let line_db = |number: u32| {
            let beside_db = |bins: isize| {
                let level_db = |(row, hz): &(&LevelRow<'_>, f64)| {
                    row.level_near_db((f64::from(number) * hz / levels.bin_hz).round() as isize + bins)
                };
                median(&present.iter().map(level_db).collect::<Option<Vec<f64>>>()?)
            };
            (-LINE_BINS..=LINE_BINS).filter_map(beside_db).reduce(f64::max)
        };
        let lines = (1..=LINES_MAX).filter_map(|number| Some((number, line_db(number)?)));
        lines.filter(|line| line.1 >= heard_db).collect()
    }

    /// The same series in rows of another survey of the same sound.
    pub(crate) fn in_rows_of(&self, own: &LevelRows<'_>, other: &LevelRows<'_>) -> Self {
        let hz_at = |row: &LevelRow<'_>| {
            let within = own.rows.iter().zip(&self.row_hz).filter_map(|(mine, hz)| {
                let middle_s = mine.span.middle_s();
                hz.filter(|_| middle_s >= row.span.from_s && middle_s <= row.span.to_s)
            });
            let hz = median(&within.collect::<Vec<_>>())?;
            Some(refined_hz(hz, other.bin_hz, 1..=SERIES_LINES, |a, b| row.peak(a, b)))
        };
        Self { hz: self.hz, row_hz: other.rows.iter().map(hz_at).collect() }
    }

    /// The same series in the rows of a finer spectrum, by these of its lines alone: where a line is not heard, the noise has peaks too. `None` where
    /// no row has it.
    pub(crate) fn by_lines_in(&self, own: &LevelRows<'_>, finer: &LevelRows<'_>, lines: &[u32]) -> Option<Self> {
        let row_hz: Vec<Option<f64>> = self
            .in_rows_of(own, finer)
            .row_hz
            .into_iter()
            .zip(&finer.rows)
            .map(|(hz, row)| {
                hz.map(|hz| refined_hz(hz, finer.bin_hz, lines.iter().copied(), |a, b| row.power_peak(a, b)))
            })
            .collect();
        let present: Vec<f64> = row_hz.iter().copied().flatten().collect();
        Some(Self { hz: median(&present)?, row_hz })
    }

    /// Takes lines of the series out of the rows, so that the next strongest shows.
    pub(crate) fn take_out_of(&self, levels: &mut LevelRows<'_>, lines: &[(u32, f64)]) {
        let bin_hz = levels.bin_hz;
        for (row, hz) in levels.rows.iter_mut().zip(&self.row_hz) {
            // where it is not present, something of it may still sound
            let hz = hz.unwrap_or(self.hz);
            for (number, _) in lines {
                let place = f64::from(*number) * hz / bin_hz;
                let half = (MASK_HALF_WIDTH_SHARE * place).max(MASK_HALF_WIDTH_BINS).min(hz / bin_hz / 3.0);
                row.level_to_floor(place - half, place + half);
            }
        }
    }
}

/// The score of each fundamental in each row.
fn scores_db(levels: &LevelRows<'_>, grid_hz: &[f64]) -> Vec<Vec<f64>> {
    let weights = Weights::new();
    let of_row = |row: &LevelRow<'_>| {
        let widened = row.widened(GRID_STEP_SHARE / 2.0);
        grid_hz.iter().map(|&hz| score_db(&widened, &weights, hz / levels.bin_hz)).collect()
    };
    levels.rows.iter().map(of_row).collect()
}

/// Orders at which a series has lines and where it has none, each with its share of the sum.
struct Weights {
    orders: Vec<(f64, f32)>,
}

impl Weights {
    fn new() -> Self {
        let weighted = |orders: Vec<f64>, sign: f64| {
            let sum: f64 = (1..=orders.len()).map(|k| (k as f64).powf(-0.5)).sum();
            let share = move |index: usize| (sign * (index as f64 + 1.0).powf(-0.5) / sum) as f32;
            orders.into_iter().enumerate().map(move |(index, order)| (order, share(index)))
        };
        let lines = (1..=SERIES_LINES).map(f64::from).collect();
        let gaps = (0..GAP_COUNT).map(|k| f64::from(k) + 0.5).collect();
        Self { orders: weighted(lines, 1.0).chain(weighted(gaps, -1.0)).collect() }
    }
}

/// Mean level of the lines of a fundamental at `place` bins, less that of the places between.
fn score_db(widened: &[f32], weights: &Weights, place: f64) -> f64 {
    let level_db = |order: f64| {
        widened.get((order * place).round() as usize).map_or(0.0, |level| level.clamp(0.0, SCAN_LEVEL_DB_MAX))
    };
    f64::from(weights.orders.iter().map(|&(order, weight)| weight * level_db(order)).sum::<f32>())
}

/// The place that explains most of the rows. Squares count strong rows more than many weak ones.
fn leading_place(scores: &[Vec<f64>]) -> Option<usize> {
    let reach = (POOL_HALF_WIDTH_SHARE / GRID_STEP_SHARE).round() as usize;
    let count = scores.first()?.len();
    let mut support = vec![0.0; count];
    for row in scores {
        for (place, sum) in support.iter_mut().enumerate() {
            let window = &row[place.saturating_sub(reach)..(place + reach + 1).min(count)];
            *sum += window.iter().copied().fold(0.0, f64::max).powi(2);
        }
    }
    let (place, &best) = support.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    (best > 0.0).then_some(place)
}

/// Least squares through the peaks of these harmonics: f = Σ w k p / Σ w k², w the level. `peak_between` finds the place and level of the peak
/// between two places, in bins.
fn refined_hz(
    hz: f64,
    bin_hz: f64,
    lines: impl Iterator<Item = u32>,
    peak_between: impl Fn(f64, f64) -> Option<(f64, f64)>,
) -> f64 {
    let (mut products, mut squares) = (0.0, 0.0);
    for line in lines.map(f64::from) {
        let place = line * hz / bin_hz;
        let half = (REFINE_HALF_WIDTH_SHARE * place).max(1.0);
        if let Some((peak, level_db)) =
            peak_between(place - half, place + half).filter(|it| it.1 >= REFINE_LEVEL_DB_MIN)
        {
            products += level_db * line * peak * bin_hz;
            squares += level_db * line * line;
        }
    }
    if squares > 0.0 { products / squares } else { hz }
}
