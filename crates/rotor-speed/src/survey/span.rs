//! Settings: the part of a recording that is analysed.

use hovertone_vehicle::ConfigError;
use serde::Serialize;

/// The part of the recording that is analysed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SpanConfig {
    /// Start on the recording's clock, s. Where a start or an end is given, the whole part is used, and nothing is cut away as not
    /// hovering.
    pub from_s: Option<f64>,
    /// End on the recording's clock, s.
    pub to_s: Option<f64>,
}

impl SpanConfig {
    /// Whether a start or an end is given.
    pub fn is_given(&self) -> bool {
        self.from_s.is_some() || self.to_s.is_some()
    }

    /// Where the part begins in a recording that starts at `start_s`.
    pub(crate) fn start_s(&self, start_s: f64) -> f64 {
        self.from_s.unwrap_or(f64::MIN).max(start_s)
    }

    /// Refuses an end at or before the start.
    ///
    /// # Errors
    /// [`ConfigError::EmptySpan`].
    pub fn check(&self) -> Result<(), ConfigError> {
        let (from_s, to_s) = (self.from_s.unwrap_or(0.0), self.to_s.unwrap_or(f64::INFINITY));
        if from_s < to_s { Ok(()) } else { Err(ConfigError::EmptySpan { from_s, to_s }) }
    }
}
