//! Stretches of time on the recording's clock.

use serde::{Deserialize, Serialize};

/// A stretch of time, half open: `[from_s, to_s)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Span {
    /// Its start.
    pub from_s: f64,
    /// Its end.
    pub to_s: f64,
}

impl Span {
    /// Length.
    pub fn length_s(&self) -> f64 {
        self.to_s - self.from_s
    }

    /// Its middle.
    pub fn middle_s(&self) -> f64 {
        (self.from_s + self.to_s) / 2.0
    }

    /// The common part of two spans; its length is 0 or negative where they do not meet.
    #[must_use]
    pub fn overlap(&self, other: Self) -> Self {
        Self { from_s: self.from_s.max(other.from_s), to_s: self.to_s.min(other.to_s) }
    }

    /// Whether the span contains a time.
    pub fn contains(&self, time_s: f64) -> bool {
        (self.from_s..self.to_s).contains(&time_s)
    }
}
