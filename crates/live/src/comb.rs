//! Power spectrum → how well each shaft speed explains it: the heights of its lines over the floor.

use hovertone_signal::RECORDED_RATE_SHARE;
use hovertone_vehicle::BLADES_MAX;
use std::f64::consts::LN_2;

/// Width of the parts of a spectrum whose median is the floor: wide against lines. *Decision.*
const FLOOR_HZ: f64 = 400.0;
/// Highest frequency of a line of a blade pass: above, noise of air covers the lines. *Decision.*
const BLADE_PASS_HZ_MAX: f64 = 4000.0;
/// Lines at most. *Numeric.*
const LINES_MAX: u32 = 20;
/// Lines of a gear mesh. *Decision.*
const MESH_LINES: f64 = 3.0;

/// The lines of a rotor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lines {
    /// Lines per turn.
    order: f64,
    /// Their number.
    count: u32,
}

impl Lines {
    /// The lines of a tone of this order, at speeds up to this one.
    pub(crate) fn new(order: f64, fastest_rev_s: f64, sample_rate_hz: f64) -> Self {
        let tone_hz = order * fastest_rev_s;
        let hz_max = if order <= BLADES_MAX { BLADE_PASS_HZ_MAX } else { MESH_LINES * tone_hz };
        let count = (hz_max.min(RECORDED_RATE_SHARE * sample_rate_hz) / tone_hz) as u32;
        Self { order, count: count.clamp(1, LINES_MAX) }
    }

    fn hz_max(self, speed_rev_s: f64) -> f64 {
        f64::from(self.count) * self.order * speed_rev_s
    }
}

/// Scores of shaft speeds, in memory of a fixed size.
pub(crate) struct Comb {
    lines: Lines,
    bin_hz: f64,
    floor_bins: usize,
    /// `ln(1 + power over floor)` of each bin.
    heights: Vec<f64>,
    /// Room for a median.
    part: Vec<f64>,
}

impl Comb {
    /// For spectra of bins that are `bin_hz` apart, and speeds up to twice this one.
    pub(crate) fn new(lines: Lines, bin_hz: f64, speed_rev_s: f64) -> Self {
        let bins = (2.0 * lines.hz_max(speed_rev_s) / bin_hz) as usize + 2;
        let floor_bins = ((FLOOR_HZ / bin_hz) as usize).max(1);
        Self { lines, bin_hz, floor_bins, heights: vec![0.0; bins], part: Vec::with_capacity(floor_bins) }
    }

    /// Takes in the power spectrum of a frame.
    pub(crate) fn take(&mut self, power: &[f64]) {
        let Self { floor_bins, heights, part, .. } = self;
        heights.fill(0.0);
        for (heights, power) in heights.chunks_mut(*floor_bins).zip(power.chunks(*floor_bins)) {
            part.clear();
            part.extend_from_slice(power);
            let (_, median, _) = part.select_nth_unstable_by(power.len() / 2, f64::total_cmp);
            let floor = (*median / LN_2).max(f64::MIN_POSITIVE);
            heights.iter_mut().zip(power).for_each(|(height, power)| *height = (power / floor).ln_1p());
        }
    }

    /// The score of a shaft speed: the sum of the heights of its lines, in nats.
    pub(crate) fn score(&self, speed_rev_s: f64) -> f64 {
        let step = self.lines.order * speed_rev_s / self.bin_hz;
        (1..=self.lines.count).map(|line| self.height_at(f64::from(line) * step)).sum()
    }

    /// How far the odd lines stand over the middles between lines, in nats: at half of the rotor's speed there is no such line.
    pub(crate) fn odd_lines_over_gaps(&self, speed_rev_s: f64) -> f64 {
        let step = self.lines.order * speed_rev_s / self.bin_hz;
        let over_gap =
            |line: u32| self.height_at(f64::from(line) * step) - self.height_at((f64::from(line) + 0.5) * step);
        (1..=self.lines.count).step_by(2).map(over_gap).sum()
    }

    /// The height between two bins.
    fn height_at(&self, place: f64) -> f64 {
        let (bin, share) = (place as usize, place.fract());
        match self.heights.get(bin..bin + 2) {
            Some(&[before, after]) => before + share * (after - before),
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotor_scores_at_its_speed() {
        let lines = Lines::new(2.0, 120.0, 48_000.0);
        assert_eq!(lines.count, 16);
        let bin_hz = 2.5;
        let mut power = vec![1.0; 9600];
        (1..=16).for_each(|line| power[line * 80] = 1000.0);
        let mut comb = Comb::new(lines, bin_hz, 120.0);
        comb.take(&power);
        // 16 lines of 1000 over 1 / ln 2; elsewhere the height is that of the floor
        let expected = 16.0 * (1.0 + 1000.0 * LN_2).ln();
        assert!((comb.score(100.0) - expected).abs() < 1e-9, "{}", comb.score(100.0));
        assert!(comb.score(104.0) < 0.2 * expected);
        // half of the lines are odd; half of the speed has none
        assert!(
            (comb.odd_lines_over_gaps(100.0) - 0.5 * 16.0 * ((1.0 + 1000.0 * LN_2) / (1.0 + LN_2)).ln()).abs() < 1e-9
        );
        assert_eq!(comb.odd_lines_over_gaps(50.0), 0.0);
        // a gear has three lines, a high tone those that the recording holds
        assert_eq!(Lines::new(69.0, 60.0, 48_000.0).count, 3);
        assert_eq!(Lines::new(69.0, 60.0, 16_000.0).count, 1);
        // no propeller has more than 12 blades
        assert_eq!([12.0, 13.0].map(|order| Lines::new(order, 60.0, 48_000.0).count), [5, 3]);
    }
}
