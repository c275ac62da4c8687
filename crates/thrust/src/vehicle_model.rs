//! The model of a simulator as the vehicle of an experiment: it supplies missing numbers, and it is compared with the measured constant.

use crate::statistics::mean;
use crate::table::ThrustTable;
use serde::Serialize;

/// A vehicle in the file of a simulator, with the thrust T = a + b ω + c ω² of each rotor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VehicleModel {
    /// Name of the file.
    pub file: String,
    /// Name of the format.
    pub format: String,
    /// Number of rotors, where the file has it.
    pub rotor_count: Option<u32>,
    /// Total mass, where the file has it.
    pub mass_kg: Option<f64>,
    /// Diameter of the propellers, where the file has it.
    pub propeller_diameter_m: Option<f64>,
    /// c, N/(rad/s)².
    pub thrust_constant_n_s2: f64,
    /// b, N/(rad/s).
    pub thrust_linear_n_s: f64,
    /// a, N.
    pub thrust_offset_n: f64,
}

/// A model compared with the measured constant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ModelAgainstHeard {
    /// Speed of the comparison: mean over the loads.
    pub speed_rad_s: f64,
    /// Thrust of one rotor of the model over the squared speed, at that speed.
    pub thrust_constant_per_rotor_n_s2: f64,
    /// Constant of the model over the measured constant.
    pub over_heard: f64,
    /// Expanded uncertainty (k = 2) of the measured constant, as a share; absent without a budget.
    pub expanded_share: Option<f64>,
    /// Whether the model lies within that uncertainty; absent without a budget.
    pub agrees: Option<bool>,
}

impl VehicleModel {
    /// The model compared with the constant of a table. `None` where the table has no constant.
    pub fn against(&self, heard: &ThrustTable) -> Option<ModelAgainstHeard> {
        let speeds: Vec<f64> = heard.loads.iter().filter_map(|load| Some(load.speed?.rad_s())).collect();
        let speed_rad_s = mean(&speeds)?;
        let thrust_n =
            self.thrust_offset_n + speed_rad_s * (self.thrust_linear_n_s + speed_rad_s * self.thrust_constant_n_s2);
        let thrust_constant_per_rotor_n_s2 = thrust_n / speed_rad_s.powi(2);
        let over_heard = thrust_constant_per_rotor_n_s2 / heard.thrust_constant_per_rotor_n_s2?.value;
        let expanded_share = heard.budget.as_ref().map(|budget| budget.expanded_share);
        Some(ModelAgainstHeard {
            speed_rad_s,
            thrust_constant_per_rotor_n_s2,
            over_heard,
            expanded_share,
            agrees: expanded_share.map(|share| (over_heard - 1.0).abs() <= share),
        })
    }
}
