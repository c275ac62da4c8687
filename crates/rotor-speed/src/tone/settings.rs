//! Which tone of the rotor is followed, and where it is looked for.

use crate::thresholds::FLIGHT_WIDTH_SHARE;
use hovertone_vehicle::{
    BLADES_MAX, ConfigError, Contradiction, KNOWN_RANGE_MARGIN, Order, RotorSpeed, SearchedTone, ShaftSpeedRange,
    check_range,
};
use serde::Serialize;

/// Half width of a found band, as a share.
const BAND_HALF_WIDTH_SHARE: f64 = FLIGHT_WIDTH_SHARE;
/// Slowest shaft that is looked for: below the 30 rev/s of the largest multirotors' propellers. *Decision.*
const SLOWEST_REV_S: f64 = 15.0;
/// Fastest shaft that is looked for: above the 670 rev/s of the smallest racers' propellers. *Decision.*
const FASTEST_REV_S: f64 = 800.0;

/// Ratio of two frequencies an octave apart. *Physics.*
const OCTAVE: f64 = 2.0;

/// Which tone of the rotor is followed, and where it is looked for.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ToneConfig {
    /// Order of the tone: lines per turn of the shaft.
    pub order: Order,
    /// How many harmonics have a ridge, the tone itself counted as the first. The paper follows three.
    pub harmonics: u32,
    /// How many lines of the blade pass the harmonic likelihood hears: those of small multirotors stand out of the noise up
    /// to the twelfth, and weak ones do no harm.
    pub blade_pass_lines: u32,
    /// How many lines of the gear mesh it hears: the AR.Drone's fourth is above what most recorders keep.
    pub gear_mesh_lines: u32,
    /// Blades of the rotor, where they are known beside a gear: their lines help to find the shaft speed.
    pub blades: Option<u32>,
    /// Band of the first harmonic, in Hz; found from the recording where absent.
    pub band_hz: Option<(f64, f64)>,
    /// Half width of a found band as a share of its middle. Holds ±4 standard deviations of the paper's 1.2 % wander and
    /// rotors a few per cent apart, and keeps the bands of three harmonics from overlapping.
    pub band_half_width_share: f64,
    /// Slowest shaft that is looked for, rad/s.
    #[serde(rename = "speed_rad_s_min")]
    pub speed_min: RotorSpeed,
    /// Fastest shaft that is looked for, rad/s.
    #[serde(rename = "speed_rad_s_max")]
    pub speed_max: RotorSpeed,
}

impl ToneConfig {
    /// The recommended settings for a tone of that order.
    pub fn of_order(order: Order) -> Self {
        Self {
            order,
            harmonics: 3,
            blade_pass_lines: 20,
            gear_mesh_lines: 3,
            blades: None,
            band_hz: None,
            band_half_width_share: BAND_HALF_WIDTH_SHARE,
            speed_min: RotorSpeed::from_rev_s(SLOWEST_REV_S),
            speed_max: RotorSpeed::from_rev_s(FASTEST_REV_S),
        }
    }

    /// The same tone, looked for only where the vehicle's rotors are known to turn (and half as far again beyond).
    #[must_use]
    pub fn within(self, known: &ShaftSpeedRange) -> Self {
        Self {
            speed_min: RotorSpeed::from_rev_s(known.rev_s_low / KNOWN_RANGE_MARGIN),
            speed_max: RotorSpeed::from_rev_s(known.rev_s_high * KNOWN_RANGE_MARGIN),
            ..self
        }
    }

    /// The slowest and fastest shaft, where what is known of the rotor sets them.
    pub(crate) fn known_rev_s(&self) -> Option<(f64, f64)> {
        let usual = (RotorSpeed::from_rev_s(SLOWEST_REV_S), RotorSpeed::from_rev_s(FASTEST_REV_S));
        let is_known = (self.speed_min, self.speed_max) != usual;
        is_known.then(|| (self.speed_min.rev_s(), self.speed_max.rev_s()))
    }

    /// The same, or the shaft speeds of a given band.
    pub(crate) fn narrowed_rev_s(&self) -> Option<(f64, f64)> {
        let order = self.order.lines_per_turn();
        self.band_hz.map(|(low_hz, high_hz)| (low_hz / order, high_hz / order)).or_else(|| self.known_rev_s())
    }

    /// Whether a band is given that names the tone: it is narrower than an octave, so that it tells speeds apart.
    pub(crate) fn is_named_by_band(&self) -> bool {
        self.band_hz.is_some_and(|(low_hz, high_hz)| high_hz < OCTAVE * low_hz)
    }

    /// Refuses a band in which the tone cannot lie, and an order that the blades do not make. Beyond the orders of blades it is that of a gear.
    ///
    /// # Errors
    /// [`Contradiction::Band`], [`Contradiction::OrderOfBlades`].
    pub fn check_band(&self) -> Result<(), Contradiction> {
        let &Self { band_hz, order, speed_min, speed_max, blades, .. } = self;
        let lines = order.lines_per_turn();
        let is_of_blades = lines > 1.0 && lines <= BLADES_MAX && lines.fract() == 0.0;
        if let Some(blades) = blades.filter(|blades| is_of_blades && lines % f64::from(*blades) != 0.0) {
            return Err(Contradiction::OrderOfBlades { order, blades });
        }
        SearchedTone { band_hz, order, speed_min, speed_max }.check()
    }

    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        check_range("order", self.order.lines_per_turn(), 0.1, 1e4)?;
        check_range("harmonics", f64::from(self.harmonics), 1.0, 20.0)?;
        check_range("blade_pass_lines", f64::from(self.blade_pass_lines), 1.0, 40.0)?;
        check_range("gear_mesh_lines", f64::from(self.gear_mesh_lines), 1.0, 40.0)?;
        check_range("blades", f64::from(self.blades.unwrap_or(1)), 1.0, BLADES_MAX)?;
        check_range("band_half_width_share", self.band_half_width_share, 0.005, 0.3)?;
        check_range("speed_rad_s_min", self.speed_min.rad_s(), 1.0, 1e5)?;
        check_range("speed_rad_s_max", self.speed_max.rad_s(), self.speed_min.rad_s(), 1e5)?;
        if let Some((low_hz, high_hz)) = self.band_hz {
            check_range("band_hz_low", low_hz, 1.0, 1e6)?;
            if high_hz.is_nan() || high_hz <= low_hz {
                return Err(ConfigError::EmptyBand { low_hz, high_hz });
            }
        }
        Ok(())
    }
}

/// Blades of a rotor whose blade pass is the tone. `None` where the tone is something else, such as a gear mesh.
pub(crate) fn blades_of_tone(tone: &ToneConfig) -> Option<u32> {
    let order = tone.order.lines_per_turn();
    let is_blade_pass = (1.0..=BLADES_MAX).contains(&order) && order.fract() == 0.0;
    is_blade_pass.then_some(order as u32)
}

/// Blades of the rotor: those that are said, or those whose blade pass is followed.
pub fn blades_known(tone: &ToneConfig) -> Option<u32> {
    tone.blades.or(blades_of_tone(tone))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_blades_than_a_propeller_has_are_refused() {
        let checked = |blades: u32| {
            let tone = ToneConfig::of_order(Order::from_blades(2).unwrap());
            ToneConfig { blades: Some(blades), ..tone }.check()
        };
        assert_eq!(checked(12), Ok(()));
        assert_eq!(checked(13).unwrap_err().to_string(), "blades = 13, but it must be from 1 to 12");
    }
}
