//! A series and its rows → levels over order: what sounds at its multiples, and what between them.

use super::levels::LevelRows;
use super::series::Series;
use hovertone_signal::statistics::{mean, median};

/// Places to an order: 60 is divided by 2, 3, 4, 5 and 6, so that the lines of a shaft with as many blades fall on places. *Numeric.*
pub(crate) const PLACES: usize = 60;
/// Harmonics of the series that the profile covers. *Decision.*
pub(crate) const ORDERS: usize = 18;
/// A line may lie this share beside its place: the fundamental is known to this. *Decision.*
const TOLERANCE_SHARE: f64 = 0.0015;
/// The floor is the lower quarter of what lies within this many places: lines of six blades, as wide as they get, fill
/// less than the rest. *Numeric.*
const FLOOR_HALF_WIDTH: usize = 45;
/// Share of the places below the floor. *Numeric.*
const FLOOR_SHARE: f64 = 0.25;
/// The scatter is that between this share and the quarter, which a normal distribution has 0.607 standard deviations apart. *Numeric.*
const SCATTER_SHARE: f64 = 0.1;
/// Standard deviations from the first of these shares to the second. *Numeric.*
const STDS_BETWEEN: f64 = 0.607;
/// Below this the window's own skirt at 0 Hz sounds. *Numeric.*
const QUIET_PLACE_MIN: usize = 8;
/// A line between harmonics stands over both its sides by this, else it is the skirt of one of them. *Decision.*
const PEAK_DB: f64 = 2.0;
/// Where its sides are, beside the tolerance. *Numeric.*
const SIDE_PLACES: [usize; 3] = [2, 3, 4];

/// Mean level over the floor at every sixtieth of an order.
#[derive(Clone, Debug)]
pub(crate) struct OrderProfile {
    level_db: Vec<f64>,
    /// Scatter of the floor: what a line must stand out of.
    pub(crate) noise_db: f64,
}

impl OrderProfile {
    /// Mean over the rows in which the series is present; `None` where it is in none.
    pub(crate) fn from_rows(levels: &LevelRows<'_>, series: &Series) -> Option<Self> {
        let mut sums = vec![0.0; ORDERS * PLACES + PLACES / 2];
        let mut counts = vec![0u32; sums.len()];
        for (row, hz) in levels.rows.iter().zip(&series.row_hz) {
            let Some(hz) = hz else { continue };
            let step = hz / PLACES as f64 / levels.bin_hz;
            for (place, (sum, count)) in sums.iter_mut().zip(&mut counts).enumerate() {
                let middle = place as f64 * step;
                if let Some(level) = row.highest_db(middle - step / 2.0, middle + step / 2.0) {
                    *sum += level;
                    *count += 1;
                }
            }
        }
        let rows = counts.first().copied().filter(|&rows| rows > 0)?;
        let level_db: Vec<f64> = sums
            .iter()
            .zip(&counts)
            .take_while(|&(_, &count)| count == rows)
            .map(|(sum, _)| sum / f64::from(rows))
            .collect();
        let mut profile = Self { level_db, noise_db: 0.0 };
        profile.noise_db = profile.scatter_db();
        Some(profile)
    }

    /// Harmonics that lie within the recording.
    pub(crate) fn order_count(&self) -> usize {
        self.level_db.len().saturating_sub(PLACES / 4) / PLACES
    }

    /// How far the line at a place stands over the floor around it; `None` beyond the recording.
    pub(crate) fn line_db(&self, place: usize) -> Option<f64> {
        Some(self.highest_db(place)? - self.quantile_db(place, FLOOR_SHARE)?)
    }

    /// Whether what sounds at a place stands over both its sides.
    pub(crate) fn is_peak(&self, place: usize) -> bool {
        let half = tolerance(place);
        let side_db = |at: &dyn Fn(usize) -> Option<usize>| {
            let levels = SIDE_PLACES.iter().filter_map(|step| self.level_db.get(at(half + step)?).copied());
            mean(&levels.collect::<Vec<_>>())
        };
        let sides = [side_db(&|step| place.checked_sub(step)), side_db(&|step| Some(place + step))];
        let line_db = self.highest_db(place);
        line_db.is_some_and(|line_db| sides.into_iter().flatten().all(|side_db| line_db >= side_db + PEAK_DB))
    }

    fn highest_db(&self, place: usize) -> Option<f64> {
        let half = tolerance(place);
        let levels = self.level_db.get(place.saturating_sub(half)..=place + half)?;
        Some(levels.iter().copied().fold(f64::MIN, f64::max))
    }

    /// The level that a share of the surroundings of a place stays below.
    fn quantile_db(&self, place: usize, share: f64) -> Option<f64> {
        let first = place.saturating_sub(FLOOR_HALF_WIDTH).max(QUIET_PLACE_MIN);
        let mut levels = self.level_db.get(first..(place + FLOOR_HALF_WIDTH + 1).min(self.level_db.len()))?.to_vec();
        levels.sort_by(f64::total_cmp);
        levels.get((share * levels.len() as f64) as usize).copied()
    }

    /// Scatter of the floor, the typical one of all orders.
    fn scatter_db(&self) -> f64 {
        let scatter = |order: usize| {
            let middle = order * PLACES + PLACES / 2;
            Some((self.quantile_db(middle, FLOOR_SHARE)? - self.quantile_db(middle, SCATTER_SHARE)?) / STDS_BETWEEN)
        };
        median(&(0..ORDERS).filter_map(scatter).collect::<Vec<_>>()).unwrap_or_default()
    }
}

/// How far beside its place a line may lie.
fn tolerance(place: usize) -> usize {
    1 + (TOLERANCE_SHARE * place as f64).round() as usize
}
