//! The local floor of the power of a frame.

use std::collections::VecDeque;

/// Width of the running median of the floor, Hz: wider than several lines of a small rotor's comb, narrower than the slope of noise.
/// *Decision.*
const FLOOR_HZ: f64 = 120.0;
/// Number of values of which a median is taken. More bins within the width share their noise. *Numeric.*
const VALUES: f64 = 48.0;

/// A running median over frequency, with its memory.
pub(super) struct Floor {
    /// Bins from one value to the next.
    stride: usize,
    /// Number of values to either side of the middle.
    half: usize,
    window: VecDeque<f64>,
    sorted: Vec<f64>,
}

impl Floor {
    /// For frames whose bins are `bin_hz` apart.
    pub(super) fn of_bins(bin_hz: f64) -> Self {
        let bins = FLOOR_HZ / bin_hz;
        let stride = ((bins / VALUES) as usize).max(1);
        Self::of_values(stride, (bins / stride as f64 / 2.0) as usize)
    }

    fn of_values(stride: usize, half: usize) -> Self {
        Self { stride, half, window: VecDeque::new(), sorted: Vec::new() }
    }

    /// Medians of the power around every `stride`-th bin, of every `stride`-th bin; the first is around the first bin.
    fn medians(&mut self, power: &[f64]) -> Vec<f64> {
        self.window.clear();
        self.sorted.clear();
        let mut coming = power.iter().step_by(self.stride);
        coming.by_ref().take(self.half).for_each(|&value| self.add(value));
        (0..power.len().div_ceil(self.stride))
            .map(|middle| {
                if let Some(&value) = coming.next() {
                    self.add(value);
                }
                if middle > self.half {
                    self.drop_first();
                }
                self.sorted[self.sorted.len() / 2]
            })
            .collect()
    }

    /// The floor of each bin: the nearest median.
    pub(super) fn of(&mut self, power: &[f64]) -> Vec<f64> {
        let medians = self.medians(power);
        let nearest = |bin: usize| (bin + self.stride / 2) / self.stride;
        (0..power.len()).filter_map(|bin| medians.get(nearest(bin)).or(medians.last()).copied()).collect()
    }

    fn add(&mut self, value: f64) {
        self.window.push_back(value);
        self.sorted.insert(self.sorted.partition_point(|&other| other < value), value);
    }

    fn drop_first(&mut self) {
        if let Some(value) = self.window.pop_front() {
            self.sorted.remove(self.sorted.partition_point(|&other| other < value));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_running_median_is_that_of_the_values_around() {
        let values: Vec<f64> = (0..40).map(|n| f64::from((n * 7919) % 101)).collect();
        for stride in [1, 2, 3] {
            let thinned: Vec<f64> = values.iter().copied().step_by(stride).collect();
            let floor = Floor::of_values(stride, 3).of(&values);
            assert_eq!(floor.len(), values.len());
            for (bin, found) in floor.iter().enumerate() {
                let middle = ((bin + stride / 2) / stride).min(thinned.len() - 1);
                let mut near = thinned[middle.saturating_sub(3)..(middle + 4).min(thinned.len())].to_vec();
                near.sort_by(f64::total_cmp);
                assert_eq!(*found, near[near.len() / 2], "stride {stride}, bin {bin}");
            }
        }
    }

    #[test]
    fn a_median_has_as_many_values_in_frames_of_any_length() {
        for bin_hz in [2.5, 0.625] {
            let floor = Floor::of_bins(bin_hz);
            assert!((46..=50).contains(&(2 * floor.half)), "{bin_hz}: {}", floor.half);
        }
        assert!(Floor::of_bins(1.0).of(&[]).is_empty());
    }
}
