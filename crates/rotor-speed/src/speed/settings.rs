//! Settings of the uncertainty budget of a speed.

use hovertone_vehicle::{CLOCK_PPM, ConfigError, DRIFT_M_MAX, ROTOR_SPREAD_SHARE, check_range, loudest_rotor_share};
use serde::{Deserialize, Serialize};

/// What makes a speed uncertain that its sound does not show.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BudgetConfig {
    /// The recorder's clock may be off by this much to either side, in millionths. Phones and cameras keep within 50.
    pub clock_ppm: f64,
    /// The vehicle may move towards or away from the microphone this fast all the time. A hover does not: 0.
    pub radial_speed_m_s_max: f64,
    /// A hover may be this much nearer to the microphone, or farther from it, at the end of a stretch than at its beginning: over its
    /// length that is a speed too. Half a metre is what simulated pilots let it drift; say 0 of a bench.
    pub drift_m_max: f64,
    /// Standard deviation of the speeds of several rotors about their mean, as a share; counts where one line stands for all.
    pub rotor_spread_share: f64,
}

impl Default for BudgetConfig {
    fn default() -> Self {
        Self {
            clock_ppm: CLOCK_PPM,
            radial_speed_m_s_max: 0.0,
            drift_m_max: DRIFT_M_MAX,
            rotor_spread_share: ROTOR_SPREAD_SHARE,
        }
    }
}

impl BudgetConfig {
    /// How far the loudest of so many rotors is from their mean, as a share: any of them can be it.
    pub(crate) fn loudest_rotor_share(&self, rotor_count: u32) -> f64 {
        loudest_rotor_share(self.rotor_spread_share, rotor_count)
    }

    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        check_range("clock_ppm", self.clock_ppm, 0.0, 1e5)?;
        check_range("radial_speed_m_s_max", self.radial_speed_m_s_max, 0.0, 100.0)?;
        check_range("drift_m_max", self.drift_m_max, 0.0, 100.0)?;
        check_range("rotor_spread_share", self.rotor_spread_share, 0.0, 0.3)
    }
}
