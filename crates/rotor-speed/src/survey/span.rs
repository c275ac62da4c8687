//! Which part of a recording is used.

use hovertone_vehicle::ConfigError;
use serde::Serialize;

/// Which part of the recording is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SpanConfig {
    /// Start of the part to use, on the recording's clock. Where a start or end is given, all between is used and
    /// nothing is cut away as not hovering.
    pub from_s: Option<f64>,
    /// End of the part to use.
    pub to_s: Option<f64>,
}

impl SpanConfig {
    /// Whether the user says what to use.
    pub fn is_given(&self) -> bool {
        self.from_s.is_some() || self.to_s.is_some()
    }

    /// Refuses a span that ends before it starts.
    ///
    /// # Errors
    /// [`ConfigError::EmptySpan`].
    pub fn check(&self) -> Result<(), ConfigError> {
        let (from_s, to_s) = (self.from_s.unwrap_or(0.0), self.to_s.unwrap_or(f64::INFINITY));
        if from_s < to_s { Ok(()) } else { Err(ConfigError::EmptySpan { from_s, to_s }) }
    }
}
