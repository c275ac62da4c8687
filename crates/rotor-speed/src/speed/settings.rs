//! Settings of the uncertainty budget of a speed.

use hovertone_vehicle::{CLOCK_PPM, ConfigError, DRIFT_M_MAX, ROTOR_SPREAD_SHARE, check_range, loudest_rotor_share};
use serde::{Deserialize, Serialize};

/// Sources of uncertainty that the sound does not show.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BudgetConfig {
    /// Largest error of the recorder's clock, in millionths. Phones and cameras stay within 50.
    pub clock_ppm: f64,
    /// Largest constant speed of the vehicle towards or away from the microphone, m/s (Doppler effect). For a hover: 0.
    pub radial_speed_m_s_max: f64,
    /// Largest change of the distance to the microphone over a span of time, m; over the length of the span it gives a Doppler effect too.
    /// Simulated pilots let a hover drift by half a metre; on a bench: 0.
    pub drift_m_max: f64,
    /// Standard deviation of the speeds of several rotors about their mean, as a share. It counts where one line stands for all rotors.
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
    /// Standard deviation of the loudest rotor from the mean of all rotors, as a share: each rotor may be the loudest.
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
