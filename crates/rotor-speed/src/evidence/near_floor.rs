//! A floor nearer to the lines than the wide one: the crests of the waves that an echo makes in the spectrum of noise are a part of it, and so are
//! lines that lie close.

use super::floor::{SHAPE_HZ, bin_at};
use super::level_table::{LEVELS, LEVELS_PER_DB, Level, UNKNOWN};
use std::sync::Arc;

/// Width of the median that is the near floor, Hz: narrower than the crests of an echo of 10 ms, wider than several lines of a long frame.
/// *Decision.*
const NEAR_FLOOR_HZ: f64 = 45.0;

/// The median of the power around each point of the shape of the floor.
pub(super) struct NearFloor {
    bin_hz: f64,
    /// Bins to either side of a point.
    half: usize,
    values: Vec<f64>,
}

impl NearFloor {
    /// For frames whose bins are `bin_hz` apart.
    pub(super) fn of_bins(bin_hz: f64) -> Self {
        Self { bin_hz, half: (NEAR_FLOOR_HZ / bin_hz / 2.0) as usize, values: Vec::new() }
    }

    /// The near floor every [`SHAPE_HZ`].
    pub(super) fn of(&mut self, power: &[f64]) -> Vec<f64> {
        let middles = (0..).map(|point| bin_at(point, self.bin_hz)).take_while(|&bin| bin < power.len());
        middles
            .map(|bin| {
                self.values.clear();
                let around = bin.saturating_sub(self.half)..(bin + self.half + 1).min(power.len());
                self.values.extend_from_slice(&power[around]);
                let middle = self.values.len() / 2;
                *self.values.select_nth_unstable_by(middle, f64::total_cmp).1
            })
            .collect()
    }

    /// This floor over the wide floor of each bin, in steps of a level.
    pub(super) fn over(&self, near: &[f64], wide: &[f64], added: f64) -> Arc<[i8]> {
        let steps = |(point, near): (usize, &f64)| {
            let ratio = (near + added) / (wide[bin_at(point, self.bin_hz)] + added);
            (10.0 * LEVELS_PER_DB * ratio.log10()).round() as i8
        };
        near.iter().enumerate().map(steps).collect()
    }
}

/// Levels over the wide floor → levels over the near one.
pub(super) fn levels_over(levels: &[Level], near_floor: &[i8], bin_hz: f64) -> Arc<[Level]> {
    let steps = |bin: usize| {
        let point = (bin as f64 * bin_hz / SHAPE_HZ).round() as usize;
        near_floor.get(point).or(near_floor.last()).copied().unwrap_or_default()
    };
    let most = LEVELS as Level - 1;
    let over = |(bin, level): (usize, &Level)| match *level {
        UNKNOWN => UNKNOWN,
        level => level.saturating_sub_signed(steps(bin)).min(most),
    };
    levels.iter().enumerate().map(over).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::level_table::level_of;

    #[test]
    fn crests_are_a_part_of_the_near_floor_and_lines_stand_over_it() {
        let bin_hz = 0.625;
        // noise of two levels by turns of 50 Hz, with a line on a crest
        let crest = |bin: usize| ((bin as f64 * bin_hz / 50.0).round() as u32).is_multiple_of(2);
        let mut power: Vec<f64> = (0..1600).map(|bin| if crest(bin) { 4.0 } else { 1.0 }).collect();
        let at = |hz: f64| (hz / bin_hz) as usize;
        power[at(400.0)] = 400.0;
        let wide = vec![2.0; power.len()];
        let mut floor = NearFloor::of_bins(bin_hz);
        let near = floor.of(&power);
        let levels: Vec<Level> = power.iter().map(|power| level_of(power / 2.0)).collect();
        let levels = levels_over(&levels, &floor.over(&near, &wide, 0.0), bin_hz);
        let half_a_step_db = 0.5 / LEVELS_PER_DB;
        for (hz, expected_db) in [(400.0, 20.0), (500.0, 0.0), (550.0, 0.0), (600.0, 0.0)] {
            let db = crate::evidence::level_table::level_db(f64::from(levels[at(hz)]));
            assert!((db - expected_db).abs() <= 2.0 * half_a_step_db, "{hz}: {db}");
        }
    }
}
