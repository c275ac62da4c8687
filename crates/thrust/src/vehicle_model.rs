//! A simulator's model as the vehicle of an experiment: it fills what the file leaves out, and is compared with what was heard.

use crate::statistics::mean;
use crate::table::ThrustTable;
use serde::Serialize;

/// What a simulator's file says of a vehicle: T = a + b ω + c ω² for each rotor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VehicleModel {
    /// Name of its file.
    pub file: String,
    /// Whose file it is.
    pub format: String,
    /// Rotors, where the file tells.
    pub rotor_count: Option<u32>,
    /// Mass of everything, where the file tells.
    pub mass_kg: Option<f64>,
    /// Diameter of the propellers, where the file tells.
    pub propeller_diameter_m: Option<f64>,
    /// c, N/(rad/s)².
    pub thrust_constant_n_s2: f64,
    /// b, N/(rad/s).
    pub thrust_linear_n_s: f64,
    /// a, N.
    pub thrust_offset_n: f64,
}

/// A model beside what was heard.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ModelAgainstHeard {
    /// Mean speed of the loads, at which they are compared.
    pub speed_rad_s: f64,
    /// The model's thrust of one rotor over the squared speed, there.
    pub thrust_constant_per_rotor_n_s2: f64,
    /// The same over the constant that was heard.
    pub over_heard: f64,
    /// Expanded uncertainty (k = 2) of what was heard, as a share; absent where nothing tells.
    pub expanded_share: Option<f64>,
    /// Whether the model lies within it; absent where nothing tells.
    pub agrees: Option<bool>,
}

impl VehicleModel {
    /// The model beside the constant of a table. `None` where nothing was heard.
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
