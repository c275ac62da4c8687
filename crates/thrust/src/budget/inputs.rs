//! What can make a thrust constant wrong that no recording shows: how large each effect may be, with its reason.

use hovertone_vehicle::ConfigError;
use hovertone_vehicle::check_range;
use hovertone_vehicle::{DRIFT_M_MAX, ROTOR_SPREAD_SHARE, loudest_rotor_share};
use serde::{Deserialize, Serialize};

/// Limits of the effects that a budget counts beside the scatter of the trials.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct UncertaintyInputs {
    /// Half width of what the scale's own calibration may be off, as a share of the mass. Kitchen scales are adjusted to
    /// about 1 g in a kilogram.
    pub scale_share_max: f64,
    /// Standard deviation of the rotors' speeds about their mean, as a share. Only a single ridge needs it: it follows the
    /// loudest rotor. Rotors within ±1 % of their mean, evenly spread, have 0.58 %.
    pub rotor_spread_share: f64,
    /// How fast a hover may climb or sink at its start or end: a steady acceleration over its length goes unseen. Indoors a
    /// height hold by ultrasound keeps within 5 cm/s.
    pub climb_rate_m_s_max: f64,
    /// How much nearer to the microphone, or farther from it, a hover may end than it began: the Doppler effect of that is part of its
    /// speed's uncertainty. On a bench nothing drifts.
    pub drift_m_max: f64,
    /// How far the vehicle may lean in a steady hover: 2° is what a trimmed one needs against a draught.
    pub tilt_deg_max: f64,
    /// Height of the rotors over the floor.
    pub hover_height_m: f64,
    /// Radius of a rotor for the ground effect, where the propellers' diameter is not known.
    pub rotor_radius_m: f64,
    /// Half width of what the rotors' wake on the airframe and its load may change of the lift, as a share. The hulls of the
    /// paper, which stand in the wake, move the constant by less than 0.2 %.
    pub downwash_share_max: f64,
}

impl Default for UncertaintyInputs {
    fn default() -> Self {
        Self {
            scale_share_max: 0.001,
            rotor_spread_share: ROTOR_SPREAD_SHARE,
            climb_rate_m_s_max: 0.05,
            drift_m_max: DRIFT_M_MAX,
            tilt_deg_max: 2.0,
            hover_height_m: 1.0,
            rotor_radius_m: 0.1,
            downwash_share_max: 0.002,
        }
    }
}

impl UncertaintyInputs {
    /// How far the loudest of so many rotors is from their mean: any of them can be it.
    pub fn loudest_std_share(&self, rotor_count: u32) -> f64 {
        loudest_rotor_share(self.rotor_spread_share, rotor_count)
    }

    /// What is wrong with it, by name, value and limit.
    pub fn check(&self) -> Result<(), ConfigError> {
        check_range("scale_share_max", self.scale_share_max, 0.0, 0.1)?;
        check_range("rotor_spread_share", self.rotor_spread_share, 0.0, 0.2)?;
        check_range("climb_rate_m_s_max", self.climb_rate_m_s_max, 0.0, 5.0)?;
        check_range("drift_m_max", self.drift_m_max, 0.0, 100.0)?;
        check_range("tilt_deg_max", self.tilt_deg_max, 0.0, 30.0)?;
        check_range("hover_height_m", self.hover_height_m, 0.05, 1000.0)?;
        check_range("rotor_radius_m", self.rotor_radius_m, 0.005, 5.0)?;
        check_range("downwash_share_max", self.downwash_share_max, 0.0, 0.2)
    }
}
