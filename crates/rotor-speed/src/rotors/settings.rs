//! Settings of several rotors that are told apart.

use hovertone_vehicle::{ConfigError, ROTORS_MAX, check_range};
use serde::Serialize;

/// How many rotors sound, and where they are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RotorsConfig {
    /// Rotors that turn at once. One is not told apart from anything.
    pub count: u32,
    /// Whether the number of rotors is known. Otherwise `count` rotors turn, or as many as a quadrotor has where others are heard beside the
    /// first, or more where others are heard beside these.
    pub is_count_known: bool,
    /// Half width of the band of speeds in which they are looked for, as a share of the speed that was heard. Rotors of real
    /// quadrotors lie up to 22 % apart, and a rotor outside the band is silently taken for another one.
    pub band_half_width_share: f64,
}

impl Default for RotorsConfig {
    fn default() -> Self {
        Self { count: 1, is_count_known: true, band_half_width_share: 0.25 }
    }
}

/// Most rotors that are looked for where their number is not known: no common multirotor has more. *Physics.*
const COUNT_MAX: u32 = 8;

impl RotorsConfig {
    /// Rotors of a vehicle of which several are heard, where nobody said how many: most multirotors are quadrotors. *Decision.*
    pub const SEVERAL: u32 = 4;

    /// The same settings where several rotors are heard.
    pub(crate) fn with_several(self) -> Self {
        Self { count: Self::SEVERAL, ..self }
    }

    /// The same settings for two more rotors. `None` where no common multirotor has so many.
    pub(crate) fn more(self) -> Option<Self> {
        let count = (self.count + 1).next_multiple_of(2);
        (count <= COUNT_MAX).then_some(Self { count, ..self })
    }

    /// Rotors for which one line may stand. A line that keeps its phase is that of one rotor; otherwise others may turn beside it, too near to be
    /// heard by themselves, where their number is not known.
    pub(crate) fn count_of_one_line(&self, keeps_phase: bool) -> u32 {
        if self.is_count_known || keeps_phase { self.count } else { self.count.max(Self::SEVERAL) }
    }

    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        check_range("rotors", f64::from(self.count), 1.0, f64::from(ROTORS_MAX))?;
        check_range("rotors.band_half_width_share", self.band_half_width_share, 0.005, 0.3)
    }

    /// Whether there is anything to tell apart.
    pub(crate) fn are_several(&self) -> bool {
        self.count > 1
    }
}
