//! The embedded controller of a scenario: numbers that replace the preset's.

use super::resolve::set;
use hovertone_vehicle::{ControllerParameters, LoopGains};
use serde::{Deserialize, Serialize};

/// Numbers of eq 1 in place of the preset's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ControllerSection {
    /// Gains of roll.
    pub roll: Option<GainsSection>,
    /// Gains of pitch.
    pub pitch: Option<GainsSection>,
    /// Gains of the yaw rate.
    pub yaw_rate: Option<GainsSection>,
    /// Gains of the vertical rate.
    pub climb: Option<GainsSection>,
    /// Roll and pitch at a command of 1.
    pub tilt_deg_max: Option<f64>,
    /// Yaw rate at a command of 1.
    pub yaw_rate_deg_s_max: Option<f64>,
    /// Vertical rate at a command of 1.
    pub climb_m_s_max: Option<f64>,
    /// Time constant of the filter on the derivatives of the two rates.
    pub derivative_filter_s: Option<f64>,
}

/// One loop of eq 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GainsSection {
    /// k_p, volts per unit of the error.
    pub proportional: f64,
    /// k_d, volts per unit of the error's rate.
    pub derivative: f64,
    /// Largest output of the loop, volts.
    pub limit_v: f64,
}

impl From<LoopGains> for GainsSection {
    fn from(gains: LoopGains) -> Self {
        Self { proportional: gains.proportional, derivative: gains.derivative, limit_v: gains.limit_v }
    }
}

impl From<GainsSection> for LoopGains {
    fn from(section: GainsSection) -> Self {
        Self { proportional: section.proportional, derivative: section.derivative, limit_v: section.limit_v }
    }
}

impl ControllerSection {
    pub(super) fn apply(&self, controller: &mut ControllerParameters) {
        set(&mut controller.roll, self.roll.map(Into::into));
        set(&mut controller.pitch, self.pitch.map(Into::into));
        set(&mut controller.yaw_rate, self.yaw_rate.map(Into::into));
        set(&mut controller.climb, self.climb.map(Into::into));
        set(&mut controller.tilt_rad_max, self.tilt_deg_max.map(f64::to_radians));
        set(&mut controller.yaw_rate_rad_s_max, self.yaw_rate_deg_s_max.map(f64::to_radians));
        set(&mut controller.climb_m_s_max, self.climb_m_s_max);
        set(&mut controller.derivative_filter_s, self.derivative_filter_s);
    }
}
