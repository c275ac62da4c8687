//! Settings: how a hover is cut into excerpts, which the paper calls samples.

use hovertone_vehicle::{ConfigError, check_range};
use serde::{Deserialize, Serialize};

/// How a hover is cut into excerpts, which the paper calls samples (its database, figure 5).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SampleConfig {
    /// Length of an excerpt, s. The paper says "approximately 5 s".
    pub length_s: f64,
    /// Share of an excerpt that the next one repeats. 40 % gives two excerpts of 5 s in a trial of 10 s.
    pub overlap: f64,
}

impl Default for SampleConfig {
    fn default() -> Self {
        Self { length_s: 5.0, overlap: 0.4 }
    }
}

impl SampleConfig {
    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        check_range("length_s", self.length_s, 0.5, 1e4)?;
        check_range("overlap", self.overlap, 0.0, 0.95)
    }
}
