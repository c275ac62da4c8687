//! Axes: ranges, ticks and their labels.

use crate::geometry::Extent;
use plotters::coord::ranged1d::{BoldPoints, Ranged};
use plotters::coord::types::RangedCoordf64;
use std::ops::Range;

/// One axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Axis {
    /// Quantity with its unit.
    pub(crate) title: String,
    /// Value at its start.
    pub(crate) from: f64,
    /// Value at its end.
    pub(crate) to: f64,
    /// Largest number of ticks.
    pub(crate) ticks_max: usize,
}

impl Axis {
    pub(crate) fn new(title: impl Into<String>, shown: Extent) -> Self {
        // an axis needs a width
        let Extent { low: from, high: to } = shown;
        let width = shown.width();
        let is_range = width.is_finite() && width > 1e-12 * from.abs().max(to.abs());
        let (from, to) = if is_range { (from, to) } else { (from - 0.5, from + 0.5) };
        Self { title: title.into(), from, to, ticks_max: 6 }
    }

    /// The axis with another largest number of ticks.
    pub(crate) fn with_ticks(self, ticks_max: usize) -> Self {
        Self { ticks_max, ..self }
    }

    pub(crate) fn range(&self) -> Range<f64> {
        self.from..self.to
    }

    /// Round values with their labels.
    pub(crate) fn ticks(&self) -> Vec<(f64, String)> {
        if self.ticks_max == 0 {
            return Vec::new();
        }
        let values = RangedCoordf64::from(self.range()).key_points(BoldPoints(self.ticks_max));
        let step = values.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let decimals = if step.is_finite() { (-(step * 1.0001).log10().floor()).clamp(0.0, 9.0) as usize } else { 2 };
        values
            .into_iter()
            .map(|value| {
                let label = format!("{value:.decimals$}");
                // zero has no minus sign
                let is_zero = label.trim_start_matches('-').chars().all(|letter| matches!(letter, '0' | '.'));
                (value, if is_zero { label.trim_start_matches('-').to_owned() } else { label.replace('-', "−") })
            })
            .collect()
    }
}

/// The extent of the finite values with a margin on both sides, as a share of it; `None` without a finite value.
pub(crate) fn range_with_margin(values: impl IntoIterator<Item = f64>, share: f64) -> Option<Extent> {
    let (low, high) = values
        .into_iter()
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    (low <= high).then_some(Extent::new(low - share * (high - low), high + share * (high - low)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_inside_and_not_too_many() {
        for (from, to) in [(0.0, 10.0), (4101.3, 4208.9), (-0.004, 0.011), (0.0, 1800.0), (2.8e-5, 2.9e-5)] {
            let ticks = Axis::new("x", Extent::new(from, to)).ticks();
            assert!((2..=6).contains(&ticks.len()), "{from} {to}: {ticks:?}");
            assert!(ticks.iter().all(|(value, _)| (from - 1e-12..=to + 1e-12).contains(value)), "{ticks:?}");
        }
        let labels: Vec<String> =
            Axis::new("x", Extent::new(-1.0, 1.0)).ticks().into_iter().map(|(_, label)| label).collect();
        assert!(labels.contains(&"0.0".to_owned()) && labels.contains(&"−0.5".to_owned()), "{labels:?}");
    }

    #[test]
    fn a_range_always_has_a_width() {
        let axis = Axis::new("x", Extent::new(3.0, 3.0));
        assert!(axis.to > axis.from);
        assert_eq!(range_with_margin([1.0, f64::NAN, 3.0], 0.5), Some(Extent::new(0.0, 4.0)));
        assert_eq!(range_with_margin([f64::NAN], 0.5), None);
    }
}
