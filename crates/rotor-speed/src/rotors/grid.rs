//! The speeds that are looked for.

use super::spectra::{LineSpectra, Spectra};
use std::ops::{Range, RangeInclusive};

/// Points of the grid in a resolution cell of the line that resolves most finely. *Numeric.*
const GRID_PER_CELL: f64 = 2.0;

/// Speeds that are looked for, as offsets from the common speed.
#[derive(Default)]
pub(super) struct OffsetGrid {
    first_rev_s: f64,
    pub(super) step_rev_s: f64,
    points: usize,
}

impl OffsetGrid {
    pub(super) fn new(offsets_rev_s: RangeInclusive<f64>, spectra: &Spectra) -> Self {
        let (low_rev_s, high_rev_s) = offsets_rev_s.into_inner();
        let finest = spectra.lines.iter().map(|line| line.order * line.frame_s).fold(1.0, f64::max);
        let points = ((high_rev_s - low_rev_s) * finest * GRID_PER_CELL).ceil().max(2.0) as usize + 1;
        Self { first_rev_s: low_rev_s, step_rev_s: (high_rev_s - low_rev_s) / (points - 1) as f64, points }
    }

    #[cfg(test)]
    pub(super) fn of_points(first_rev_s: f64, step_rev_s: f64, points: usize) -> Self {
        Self { first_rev_s, step_rev_s, points }
    }

    pub(super) fn points(&self) -> usize {
        self.points
    }

    /// The score at an offset, between those of the points around it; nothing speaks for what lies outside.
    pub(super) fn score_at(&self, scores: &[f64], offset_rev_s: f64) -> f64 {
        let place = (offset_rev_s - self.first_rev_s) / self.step_rev_s;
        let (below, share) = (place as usize, place.fract());
        if place < 0.0 || below >= self.points {
            return 0.0;
        }
        let (own, next) = (scores[below], scores[(below + 1).min(self.points - 1)]);
        own + share * (next - own)
    }

    pub(super) fn offset_rev_s(&self, place: usize) -> f64 {
        self.first_rev_s + place as f64 * self.step_rev_s
    }

    /// The bins of a line's frames into which it can fall.
    pub(super) fn bins_of(&self, line: &LineSpectra) -> Range<usize> {
        let bin_of = |place: usize| line.bin_of(line.order * self.offset_rev_s(place) * line.frame_s);
        let from = (bin_of(0).max(0.0) as usize).min(line.frame_bins() - 2);
        from..(bin_of(self.points - 1) as usize + 2).clamp(from + 2, line.frame_bins())
    }

    /// The points around an offset, so many to either side.
    pub(super) fn points_around(&self, offset_rev_s: f64, reach: usize) -> Range<usize> {
        let place = ((offset_rev_s - self.first_rev_s) / self.step_rev_s).round();
        let place = place.clamp(0.0, self.points as f64 - 1.0) as usize;
        place.saturating_sub(reach)..(place + reach + 1).min(self.points)
    }
}
