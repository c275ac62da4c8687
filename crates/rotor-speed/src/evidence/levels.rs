//! Levels of orders along a path.

use super::excess::Excess;
use super::level_model::{LAST_HARMONIC, OrderLevel, RotorLevels};
use super::level_table;
use super::rotor_lines::RotorLines;
use crate::thresholds::{MESH_LINES, MOST, NEARLY_ALL, NOISE_STDS_MAX};
use hovertone_signal::statistics::{STD_PER_MEDIAN_DEVIATION, mean, median};
use hovertone_vehicle::LineLevels;

/// Share of frames in which a line must be inside the band.
const INSIDE_SHARE_MIN: f64 = NEARLY_ALL;
/// Share of frames in which its level must be known: lines of hum or of a voice may be left out.
const KNOWN_SHARE_MIN: f64 = MOST;
/// Lowest frequency of a line, Hz: handling and wind are below. *Decision.*
pub(super) const LINE_HZ_MIN: f64 = 25.0;
/// Fractions of an order at which no rotor on this path, nor one at twice or half its speed, has a line. *Decision.*
const NOISE_FRACTIONS: [f64; 6] = [0.23, 0.37, 0.42, 0.58, 0.63, 0.77];
/// Orders around which the noise is measured. *Numeric.*
const NOISE_ORDERS: u32 = 30;
/// Distance from a gear mesh at which orders are those of its sidebands: shaft speeds to either side. *Physics.*
const SIDEBANDS: f64 = 2.0;
/// Standard deviations of the noise above which a level is that of a line.
const LINE_STDS: f64 = NOISE_STDS_MAX;
/// Standard deviation of the noise, dB: the least, by skirts of lines, and the most that some seconds of noise can have. *Decision.*
const NOISE_STD_DB: std::ops::RangeInclusive<f64> = 1.0..=2.0;

/// Level along the path at an order, dB over the floor: the mean over the frames of the highest level within a bin. Lines of something else
/// that cross the path for a moment count little. `None` outside the band, and where it is known in few frames.
pub(super) fn level_db(excess: &Excess, speeds_rev_s: &[f64], order: f64) -> Option<f64> {
    let (mut sum, mut count, mut inside) = (0u32, 0u32, 0u32);
    let mut hz_sum = 0.0;
    for (frame, speed_rev_s) in excess.frames.iter().zip(speeds_rev_s) {
        let hz = order * speed_rev_s;
        hz_sum += hz;
        inside += u32::from(frame.holds(hz, excess.bin_hz));
        if let Some(level) = frame.level_near(hz, excess.bin_hz) {
            sum += u32::from(level);
            count += 1;
        }
    }
    let frames = excess.frames.len() as f64;
    let is_inside = f64::from(inside) >= INSIDE_SHARE_MIN * frames;
    let is_known = count > 0 && f64::from(count) >= KNOWN_SHARE_MIN * frames;
    (is_inside && is_known && hz_sum >= LINE_HZ_MIN * frames)
        .then(|| level_table::level_db(f64::from(sum) / f64::from(count)))
}

/// Levels of all lines that are compared, along a path. Orders near those of a gear mesh belong to the mesh and its sidebands.
pub(super) fn levels_of_lines(excess: &Excess, speeds_rev_s: &[f64], lines: &RotorLines) -> RotorLevels {
    let floors = FloorAlong::of(excess, speeds_rev_s);
    let level = |number: u32, of_order: f64| {
        let order = f64::from(number) * of_order;
        let level_db = level_db(excess, speeds_rev_s, order)?;
        Some(OrderLevel { order: number, level_db, floor_db: floors.db(order) })
    };
    let is_of_mesh = |order: &u32| {
        lines.mesh_order.is_some_and(|mesh_order| {
            let harmonic = (f64::from(*order) / mesh_order).round().max(1.0);
            (f64::from(*order) - harmonic * mesh_order).abs() <= SIDEBANDS
        })
    };
    let shaft = lines.blades.into_iter().flat_map(|blades| 1..=LAST_HARMONIC * blades).filter(|it| !is_of_mesh(it));
    let mesh = lines.mesh_order.into_iter().flat_map(|order| (1..=MESH_LINES).map(move |k| (k, order)));
    RotorLevels {
        shaft: shaft.filter_map(|order| level(order, 1.0)).collect(),
        mesh: mesh.filter_map(|(k, order)| level(k, order)).collect(),
    }
}

/// The floor of a recording at the orders of a path.
pub(super) struct FloorAlong<'a> {
    excess: &'a Excess,
    mean_rev_s: f64,
}

impl<'a> FloorAlong<'a> {
    /// Along the mean of these speeds.
    pub(super) fn of(excess: &'a Excess, speeds_rev_s: &[f64]) -> Self {
        Self { excess, mean_rev_s: mean(speeds_rev_s).unwrap_or_default() }
    }

    /// Against the mean floor, dB.
    pub(super) fn db(&self, order: f64) -> f64 {
        self.excess.floor.db(order * self.mean_rev_s)
    }
}

/// Level where no line is, and its standard deviation.
#[derive(Clone, Copy, Debug)]
pub struct NoiseLevel {
    /// The median.
    pub mean_db: f64,
    /// By the median deviation.
    pub std_db: f64,
    /// Share of the places that hold a line of something else.
    pub lines_share: f64,
    /// Number of places.
    pub places: f64,
}

impl NoiseLevel {
    /// The median of those that hold the fewest lines of something else: at most this share, or as few as there are. `None` of none.
    pub(super) fn of_emptiest(mut noises: Vec<Self>, lines_share_max: f64) -> Option<Self> {
        let fewest = noises.iter().map(|noise| noise.lines_share).fold(f64::INFINITY, f64::min);
        noises.retain(|noise| noise.lines_share <= fewest.max(lines_share_max));
        let median_of = |value: fn(&Self) -> f64| median(&noises.iter().map(value).collect::<Vec<f64>>());
        Some(Self {
            mean_db: median_of(|noise| noise.mean_db)?,
            std_db: median_of(|noise| noise.std_db)?,
            lines_share: median_of(|noise| noise.lines_share)?,
            places: median_of(|noise| noise.places)?,
        })
    }

    /// Share of all places that hold a line of something else: the mean of that of recordings in general and of what this one shows, each by its
    /// places.
    pub(super) fn foreign_share(&self, prior: &LineLevels) -> f64 {
        let LineLevels { foreign, foreign_places, .. } = *prior;
        (foreign * foreign_places + self.lines_share * self.places) / (foreign_places + self.places)
    }

    /// Whether a level is that of a line.
    pub(super) fn is_below(&self, level_db: f64) -> bool {
        level_db > self.mean_db + LINE_STDS * self.std_db
    }
}

/// Levels between the orders of a path. The median and the median deviation do not feel single lines. `None` without a band.
pub(super) fn noise_level(excess: &Excess, speeds_rev_s: &[f64]) -> Option<NoiseLevel> {
    let levels: Vec<f64> = (1..=NOISE_ORDERS)
        .flat_map(|order| NOISE_FRACTIONS.map(|fraction| f64::from(order) + fraction))
        .filter_map(|order| level_db(excess, speeds_rev_s, order))
        .collect();
    let mean_db = median(&levels)?;
    let deviations: Vec<f64> = levels.iter().map(|level| (level - mean_db).abs()).collect();
    let std_db = STD_PER_MEDIAN_DEVIATION * median(&deviations)?;
    let std_db = std_db.clamp(*NOISE_STD_DB.start(), *NOISE_STD_DB.end());
    let places = levels.len() as f64;
    let noise = NoiseLevel { mean_db, std_db, lines_share: 0.0, places };
    let lines = levels.iter().filter(|&&level| noise.is_below(level)).count();
    Some(NoiseLevel { lines_share: lines as f64 / places, ..noise })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_noise_is_the_median_of_the_emptiest() {
        let noise = |mean_db: f64, lines_share: f64| NoiseLevel { mean_db, std_db: 1.5, lines_share, places: 180.0 };
        let some = vec![noise(-1.0, 0.01), noise(5.0, 0.4), noise(-2.0, 0.0), noise(0.0, 0.02)];
        assert_eq!(NoiseLevel::of_emptiest(some, 0.05).unwrap().mean_db, -1.0);
        // where lines are everywhere, the fewest count
        assert_eq!(NoiseLevel::of_emptiest(vec![noise(5.0, 0.4), noise(3.0, 0.3)], 0.05).unwrap().mean_db, 3.0);
        assert!(NoiseLevel::of_emptiest(Vec::new(), 0.05).is_none());
    }
}
