//! The instants of a recording.

use super::phasors::BLOCK;

/// The instants of the samples, of the nodes at which a [`Line`](super::Line) may change, and of the rows of the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    rate_hz: f64,
    count: usize,
    samples_per_row: usize,
}

impl Sampling {
    /// Samples at a rate over a length, rounded to a whole sample. The truth has a row at each node.
    pub fn new(rate_hz: f64, length_s: f64) -> Self {
        Self::of_count(rate_hz, (length_s * rate_hz).round() as usize)
    }

    /// A number of samples at a rate.
    pub fn of_count(rate_hz: f64, count: usize) -> Self {
        Self { rate_hz, count, samples_per_row: BLOCK }
    }

    /// The same sampling with a row of the truth at every sample: exact means over any span, at 24 bytes and more for each
    /// rotor and sample.
    pub fn with_truth_at_every_sample(self) -> Self {
        Self { samples_per_row: 1, ..self }
    }

    /// Samples per second.
    pub fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// Number of samples.
    pub fn sample_count(&self) -> usize {
        self.count
    }

    /// Instant of a sample.
    pub fn time_s(&self, sample: usize) -> f64 {
        sample as f64 / self.rate_hz
    }

    /// Time between two nodes: 48 samples.
    pub fn node_step_s(&self) -> f64 {
        BLOCK as f64 / self.rate_hz
    }

    /// Number of nodes: from the first sample to the end, or the first node after it.
    pub fn node_count(&self) -> usize {
        self.count.div_ceil(BLOCK) + 1
    }

    pub(super) fn is_row(&self, sample: usize) -> bool {
        sample.is_multiple_of(self.samples_per_row)
    }

    /// Rows at their samples, and one at the end.
    pub(super) fn row_count(&self) -> usize {
        self.count.div_ceil(self.samples_per_row) + 1
    }

    pub(super) fn row_time_s(&self, row: usize) -> f64 {
        self.time_s((row * self.samples_per_row).min(self.count))
    }
}
