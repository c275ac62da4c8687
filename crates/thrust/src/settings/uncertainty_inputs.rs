//! Effects that make a thrust constant wrong and that no recording shows: how large each may be, and why.

use hovertone_vehicle::ConfigError;
use hovertone_vehicle::check_range;
use hovertone_vehicle::{DRIFT_M_MAX, ROTOR_SPREAD_SHARE, loudest_rotor_share};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Default half width of the scale's calibration error, as a share of the mass. Kitchen scales are adjusted to about 1 g in a
/// kilogram. *Decision.*
const SCALE_SHARE: f64 = 0.001;
/// Default climb or sink rate at the start and end of a hover, m/s. Indoors an ultrasonic height hold keeps within 5 cm/s. *Decision.*
const CLIMB_RATE_M_S: f64 = 0.05;
/// Default tilt in a steady hover, degrees: the lean of a trimmed vehicle against a draught. *Decision.*
const TILT_DEG: f64 = 2.0;
/// Default height of the rotors above the floor, m. *Decision.*
const HOVER_HEIGHT_M: f64 = 1.0;
/// Default radius of a rotor, m, where the diameter is unknown: about that of the AR.Drone. *Decision.*
const ROTOR_RADIUS_M: f64 = 0.1;
/// Default half width of the change of lift by the wake on airframe and load, as a share. The hulls of the paper stand in the wake
/// and change the constant by less than 0.2 %. *Decision.*
const DOWNWASH_SHARE: f64 = 0.002;

/// Allowed calibration errors of a scale, as a share. *Decision.*
const SCALE_SHARE_ALLOWED: RangeInclusive<f64> = 0.0..=0.1;
/// Allowed spreads of the rotor speeds, as a share. *Decision.*
const ROTOR_SPREAD_SHARE_ALLOWED: RangeInclusive<f64> = 0.0..=0.2;
/// Allowed climb rates, m/s. *Decision.*
const CLIMB_RATE_M_S_ALLOWED: RangeInclusive<f64> = 0.0..=5.0;
/// Allowed drifts, m. *Decision.*
const DRIFT_M_ALLOWED: RangeInclusive<f64> = 0.0..=100.0;
/// Allowed tilts, degrees. *Decision.*
const TILT_DEG_ALLOWED: RangeInclusive<f64> = 0.0..=30.0;
/// Allowed heights, m. *Decision.*
const HOVER_HEIGHT_M_ALLOWED: RangeInclusive<f64> = 0.05..=1000.0;
/// Allowed radii, m. *Decision.*
const ROTOR_RADIUS_M_ALLOWED: RangeInclusive<f64> = 0.005..=5.0;
/// Allowed changes of lift by the wake, as a share. *Decision.*
const DOWNWASH_SHARE_ALLOWED: RangeInclusive<f64> = 0.0..=0.2;

/// Limits of the effects that a budget counts beside the scatter of the trials.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct UncertaintyInputs {
    /// Half width of the scale's calibration error, as a share of the mass.
    pub scale_share_max: f64,
    /// Standard deviation of the rotors' speeds about their mean, as a share. Only a single ridge needs it, since it follows the
    /// loudest rotor. Rotors spread evenly over ±1 % of their mean have 0.58 %.
    pub rotor_spread_share: f64,
    /// Largest climb or sink rate at the start or end of a hover. The steady acceleration that it implies over the hover stays unseen.
    pub climb_rate_m_s_max: f64,
    /// Largest change of the distance to the microphone during a hover. The Doppler effect of it is part of the uncertainty of the
    /// speed. On a bench nothing drifts.
    pub drift_m_max: f64,
    /// Largest tilt in a steady hover.
    pub tilt_deg_max: f64,
    /// Height of the rotors above the floor.
    pub hover_height_m: f64,
    /// Radius of a rotor for the ground effect, where the diameter of the propellers is unknown.
    pub rotor_radius_m: f64,
    /// Half width of the change of lift by the rotors' wake on the airframe and its load, as a share.
    pub downwash_share_max: f64,
}

impl Default for UncertaintyInputs {
    fn default() -> Self {
        Self {
            scale_share_max: SCALE_SHARE,
            rotor_spread_share: ROTOR_SPREAD_SHARE,
            climb_rate_m_s_max: CLIMB_RATE_M_S,
            drift_m_max: DRIFT_M_MAX,
            tilt_deg_max: TILT_DEG,
            hover_height_m: HOVER_HEIGHT_M,
            rotor_radius_m: ROTOR_RADIUS_M,
            downwash_share_max: DOWNWASH_SHARE,
        }
    }
}

impl UncertaintyInputs {
    /// Standard deviation of the difference between the speed of the loudest of `rotor_count` rotors and the mean of all, as a share.
    /// Each rotor can be the loudest one.
    pub fn loudest_std_share(&self, rotor_count: u32) -> f64 {
        loudest_rotor_share(self.rotor_spread_share, rotor_count)
    }

    /// Checks every number against its limits.
    ///
    /// # Errors
    /// The first number outside of its limits, with its name, its value and the limits.
    pub fn check(&self) -> Result<(), ConfigError> {
        let within =
            |name, value, allowed: RangeInclusive<f64>| check_range(name, value, *allowed.start(), *allowed.end());
        within("scale_share_max", self.scale_share_max, SCALE_SHARE_ALLOWED)?;
        within("rotor_spread_share", self.rotor_spread_share, ROTOR_SPREAD_SHARE_ALLOWED)?;
        within("climb_rate_m_s_max", self.climb_rate_m_s_max, CLIMB_RATE_M_S_ALLOWED)?;
        within("drift_m_max", self.drift_m_max, DRIFT_M_ALLOWED)?;
        within("tilt_deg_max", self.tilt_deg_max, TILT_DEG_ALLOWED)?;
        within("hover_height_m", self.hover_height_m, HOVER_HEIGHT_M_ALLOWED)?;
        within("rotor_radius_m", self.rotor_radius_m, ROTOR_RADIUS_M_ALLOWED)?;
        within("downwash_share_max", self.downwash_share_max, DOWNWASH_SHARE_ALLOWED)
    }
}
