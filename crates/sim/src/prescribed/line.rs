//! One line of a rotor.

use super::phasors::{Amplitude, BLOCK, Phasors};
use rand::{Rng, RngExt};
use std::f64::consts::TAU;

/// A line `level · cos(2π · order · turns + phase)`, where `turns` counts the turns of the shaft.
///
/// Level and phase may change over time ([`changing_level`](Self::changing_level),
/// [`changing_phase`](Self::changing_phase)); they are then known at the nodes of a
/// [`Sampling`](super::Sampling::node_count) and the line's complex amplitude is straight between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Periods of the line per turn of the shaft; need not be whole.
    pub order: f64,
    /// Amplitude.
    pub level: f64,
    /// Phase where `turns` is 0.
    pub phase_rad: f64,
    level_shares: Vec<f64>,
    phases_rad: Vec<f64>,
}

impl Line {
    /// A line with phase 0.
    pub fn new(order: f64, level: f64) -> Self {
        Self { order, level, phase_rad: 0.0, level_shares: Vec::new(), phases_rad: Vec::new() }
    }

    /// The same line with a phase.
    pub fn with_phase_rad(self, phase_rad: f64) -> Self {
        Self { phase_rad, ..self }
    }

    /// The same line with a phase drawn from the whole circle.
    pub fn with_random_phase(self, random: &mut impl Rng) -> Self {
        self.with_phase_rad(random.random_range(0.0..TAU))
    }

    /// The same line with its level times a factor.
    pub fn times(self, factor: f64) -> Self {
        Self { level: factor * self.level, ..self }
    }

    /// The same line with its level times a share that changes, given at the nodes. The last share holds on.
    pub fn changing_level(self, shares: Vec<f64>) -> Self {
        Self { level_shares: shares, ..self }
    }

    /// The same line with a phase that changes, given at the nodes, rad. The last phase holds on.
    pub fn changing_phase(self, phases_rad: Vec<f64>) -> Self {
        Self { phases_rad, ..self }
    }

    /// Mean square of the line at its level: `level² / 2`.
    pub fn power(&self) -> f64 {
        self.level * self.level / 2.0
    }

    fn is_constant(&self) -> bool {
        self.level_shares.is_empty() && self.phases_rad.is_empty()
    }

    pub(super) fn amplitude_at(&self, node: usize) -> Amplitude {
        let at = |values: &[f64]| values.get(node).or(values.last()).copied();
        let level = at(&self.level_shares).map_or(self.level, |share| self.level * share);
        Amplitude::polar(level, at(&self.phases_rad).unwrap_or(self.phase_rad))
    }
}

/// Harmonics 1, 2, 3, … of one order, summed by one multiplication of phasors from harmonic to harmonic.
pub(super) struct Series<'a> {
    order: f64,
    lines: &'a [Line],
    /// Of lines that do not change.
    constant: Vec<Option<Amplitude>>,
}

impl<'a> Series<'a> {
    /// Cuts a list of lines where a line is not the next harmonic of the first line since the last cut.
    pub(super) fn of(lines: &'a [Line]) -> Vec<Self> {
        let mut series: Vec<Self> = Vec::new();
        let mut first = 0;
        for end in 1..=lines.len() {
            let order = lines[first].order;
            if lines.get(end).is_some_and(|line| line.order == order * (end - first + 1) as f64) {
                continue;
            }
            let lines = &lines[first..end];
            let constant = lines.iter().map(|line| line.is_constant().then(|| line.amplitude_at(0))).collect();
            series.push(Self { order, lines, constant });
            first = end;
        }
        series
    }

    /// Adds block number `block` of the sound, for a shaft that has made these turns at each sample. Lines of an order
    /// above `order_max` are silent.
    pub(super) fn add(&self, block: usize, turns: &[f64; BLOCK], order_max: f64, sum: &mut [f64; BLOCK]) {
        if self.order > order_max {
            return;
        }
        let first = Phasors::of_order(self.order, turns);
        let mut harmonic = first.clone();
        for (index, (line, constant)) in self.lines.iter().zip(&self.constant).enumerate() {
            if index > 0 {
                harmonic.turn_on(&first, 1.0);
            }
            if line.order > order_max {
                return;
            }
            match constant {
                Some(amplitude) => harmonic.add_line(*amplitude, sum),
                None => harmonic.add_changing_line(line.amplitude_at(block), line.amplitude_at(block + 1), sum),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_is_cut_into_series_of_harmonics() {
        let lines: Vec<Line> =
            [69.0, 138.0, 207.0, 2.0, 4.0, 3.0, 0.5, 1.0].map(|order| Line::new(order, 1.0)).to_vec();
        let series: Vec<(f64, usize)> =
            Series::of(&lines).iter().map(|series| (series.order, series.lines.len())).collect();
        assert_eq!(series, [(69.0, 3), (2.0, 2), (3.0, 1), (0.5, 2)]);
        assert!(Series::of(&[]).is_empty());
    }

    /// The sum by phasors against its definition, one cosine for each line and sample.
    #[test]
    fn the_sum_is_that_of_the_definition() {
        let changing = Line::new(4.0, 0.7).changing_level(vec![1.0, 1.2, 0.9]).changing_phase(vec![0.1, 0.3]);
        let lines = [Line::new(2.0, 1.0).with_phase_rad(0.4), changing, Line::new(6.5, 0.2), Line::new(90.0, 5.0)];
        for block in 0..3 {
            let turns: [f64; BLOCK] = std::array::from_fn(|sample| 321.4 + 0.0013 * sample as f64);
            let mut sum = [0.0; BLOCK];
            Series::of(&lines).iter().for_each(|series| series.add(block, &turns, 80.0, &mut sum));
            for (sample, (sum, turns)) in sum.iter().zip(turns).enumerate() {
                let share = sample as f64 / BLOCK as f64;
                let expected = lines[..3].iter().map(|line| {
                    let (from, to) = (line.amplitude_at(block), line.amplitude_at(block + 1));
                    let cosine = from.cosine + share * (to.cosine - from.cosine);
                    let sine = from.sine + share * (to.sine - from.sine);
                    cosine.hypot(sine) * (TAU * line.order * turns + sine.atan2(cosine)).cos()
                });
                assert!((sum - expected.sum::<f64>()).abs() < 1e-10);
            }
        }
    }
}
