//! Settings of the uncertainty budget.

use crate::config::check_range;
use crate::error::ConfigError;
use serde::{Deserialize, Serialize};

/// What makes a speed uncertain that its sound does not show.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BudgetConfig {
    /// The recorder's clock may be off by this much to either side, in millionths. Phones and cameras keep within 50.
    pub clock_ppm: f64,
    /// The vehicle may move towards or away from the microphone this fast; 0 in a hover, whose drift averages out.
    pub radial_speed_m_s_max: f64,
}

impl Default for BudgetConfig {
    fn default() -> Self {
        Self { clock_ppm: 50.0, radial_speed_m_s_max: 0.0 }
    }
}

impl BudgetConfig {
    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        check_range("clock_ppm", self.clock_ppm, 0.0, 1e5)?;
        check_range("radial_speed_m_s_max", self.radial_speed_m_s_max, 0.0, 100.0)
    }
}
