//! Settings of several rotors that are told apart.

use crate::config::check_range;
use crate::error::ConfigError;
use serde::Serialize;

/// How many rotors sound, and where they are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RotorsConfig {
    /// Rotors that turn at once. One is not told apart from anything.
    pub count: u32,
    /// Half width of the band of speeds in which they are looked for, as a share of the speed that was heard. Rotors of real
    /// quadrotors lie up to 22 % apart, and a rotor outside the band is silently taken for another one.
    pub band_half_width_share: f64,
    /// Whether the lines of each rotor's shaft are wanted too: what they say of its state costs another reading.
    pub wants_condition: bool,
    /// Whether it is wanted when each rotor began to turn, which costs another reading: who started them knows in which order.
    pub wants_spin_up: bool,
}

impl Default for RotorsConfig {
    fn default() -> Self {
        Self { count: 1, band_half_width_share: 0.25, wants_condition: false, wants_spin_up: false }
    }
}

impl RotorsConfig {
    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        check_range("rotors", f64::from(self.count), 1.0, 12.0)?;
        check_range("rotors.band_half_width_share", self.band_half_width_share, 0.005, 0.3)
    }

    /// Whether there is anything to tell apart.
    pub(crate) fn are_several(&self) -> bool {
        self.count > 1
    }
}
