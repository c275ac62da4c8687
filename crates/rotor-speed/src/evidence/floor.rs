//! The local floor of the power of a frame, and the shape of the floor of a recording.

use std::collections::VecDeque;
use std::f64::consts::LN_10;

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
                let first = if middle > self.half { self.window.pop_front() } else { None };
                match (first, coming.next()) {
                    (Some(first), Some(&value)) => self.replace(first, value),
                    (None, Some(&value)) => self.add(value),
                    (Some(first), None) => {
                        self.sorted.remove(self.place_of(first));
                    }
                    (None, None) => {}
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
        self.sorted.insert(self.place_of(value), value);
    }

    /// The same as dropping the first value and adding another: only the values between the two move.
    fn replace(&mut self, first: f64, value: f64) {
        self.window.push_back(value);
        let (from, to) = (self.place_of(first), self.place_of(value));
        if from < to {
            self.sorted.copy_within(from + 1..to, from);
            self.sorted[to - 1] = value;
        } else {
            self.sorted.copy_within(to..from, to + 1);
            self.sorted[to] = value;
        }
    }

    /// Number of values below this one. Of so few, to compare all at once is faster than to divide them.
    fn place_of(&self, value: f64) -> usize {
        self.sorted.iter().map(|&other| usize::from(other < value)).sum()
    }
}

/// Step of the frequencies at which the shape of the floor is kept, Hz: the floor is a median over a wider band. *Numeric.*
pub(super) const SHAPE_HZ: f64 = 20.0;

/// The bin at a point of the shape of the floor.
pub(super) fn bin_at(point: usize, bin_hz: f64) -> usize {
    (point as f64 * SHAPE_HZ / bin_hz).round() as usize
}

/// Sums of the floors of frames, from which the shape of the floor comes.
#[derive(Default)]
pub(super) struct FloorSums {
    /// Sums of the logarithm of the floor, in nats, every [`SHAPE_HZ`].
    nats: Vec<f64>,
    frames: u32,
}

impl FloorSums {
    /// Takes in the floor of each bin of a frame.
    pub(super) fn add(&mut self, floors: &[f64], added: f64, bin_hz: f64) {
        let bins = (0..).map(|point| bin_at(point, bin_hz));
        let points: Vec<f64> = bins.map_while(|bin| floors.get(bin).copied()).collect();
        self.add_points(&points, added);
    }

    /// Takes in the floor of a frame every [`SHAPE_HZ`].
    pub(super) fn add_points(&mut self, floors: &[f64], added: f64) {
        self.nats.resize(floors.len(), 0.0);
        self.nats.iter_mut().zip(floors).for_each(|(sum, floor)| *sum += (floor + added).ln());
        self.frames += 1;
    }

    /// The shape of the mean floor. Octaves count alike in the level against which it is told: half of the lines of a rotor lie in the lowest.
    pub(super) fn shape(&self) -> FloorShape {
        let octaves = || self.nats.iter().zip(1u32..).map(|(nats, point)| (nats, 1.0 / f64::from(point)));
        let weights: f64 = octaves().map(|(_, weight)| weight).sum();
        let mean = octaves().map(|(nats, weight)| weight * nats).sum::<f64>() / weights;
        let db = |nats: &f64| 10.0 / LN_10 * (nats - mean) / f64::from(self.frames);
        FloorShape { levels_db: self.nats.iter().map(db).collect() }
    }
}

/// The floor of a recording at each frequency, against its mean over all octaves.
#[derive(Clone, Debug, Default)]
pub(super) struct FloorShape {
    /// Every [`SHAPE_HZ`], dB.
    levels_db: Vec<f64>,
}

impl FloorShape {
    /// The floor at a frequency, dB; beyond the band that of its end, and 0 of no recording.
    pub(super) fn db(&self, hz: f64) -> f64 {
        let point = (hz / SHAPE_HZ).round() as usize;
        self.levels_db.get(point).or(self.levels_db.last()).copied().unwrap_or_default()
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

    #[test]
    fn the_shape_of_the_floor_is_that_of_the_noise_at_any_loudness() {
        let bin_hz = 2.5;
        // 6 dB louder below 1000 Hz, in loud and in soft frames
        let floors = |loudness: f64| -> Vec<f64> {
            (0..800).map(|bin| if f64::from(bin) * bin_hz < 1000.0 { 4.0 * loudness } else { loudness }).collect()
        };
        let mut sums = FloorSums::default();
        [1.0, 100.0, 3.0].into_iter().for_each(|loudness| sums.add(&floors(loudness), 0.0, bin_hz));
        let shape = sums.shape();
        let step_db = 10.0 * 4f64.log10();
        assert!((shape.db(500.0) - shape.db(1500.0) - step_db).abs() < 1e-9);
        // 50 of 100 points, with 4.50 of 5.19 of the weights
        assert!((shape.db(500.0) - 0.133 * step_db).abs() < 0.01, "{}", shape.db(500.0));
        assert_eq!(shape.db(1e5), shape.db(1990.0));
        assert_eq!(FloorShape::default().db(100.0), 0.0);
    }
}
