//! Settings of a thrust constant: all facts beside its loads.

mod uncertainty_inputs;

pub use uncertainty_inputs::UncertaintyInputs;

use hovertone_vehicle::CLOCK_PPM;
use serde::Serialize;

/// Settings of a thrust constant: all facts beside its loads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ThrustSettings {
    /// Number of rotors of the vehicle.
    pub rotor_count: u32,
    /// Diameter of its propellers, where known.
    pub propeller_diameter_m: Option<f64>,
    /// Density of the air, where known.
    pub air_density_kg_m3: Option<f64>,
    /// Half width of the error of the recorder's clock, in millionths.
    pub clock_ppm: f64,
    /// Whether the speeds come from a single ridge, which follows the loudest rotor.
    pub follows_loudest: bool,
    /// Standard deviation of the difference between the speed and the mean of all rotors, as a share, by what is heard. It is above 0 where
    /// not all rotors were separated.
    pub unresolved_std_share: f64,
    /// Whether this vehicle was weighed. The mass of a preset or of a model belongs to another specimen.
    pub is_weighed: bool,
    /// Mass of the preset or of the model, to which the loads are compared.
    pub known_mass_kg: Option<f64>,
    /// Limits of the effects that were not measured.
    pub uncertainty: UncertaintyInputs,
}

impl ThrustSettings {
    /// Settings for a vehicle with `rotor_count` rotors; everything else is the default.
    pub fn for_rotors(rotor_count: u32) -> Self {
        Self {
            rotor_count,
            propeller_diameter_m: None,
            air_density_kg_m3: None,
            clock_ppm: CLOCK_PPM,
            follows_loudest: true,
            unresolved_std_share: 0.0,
            is_weighed: true,
            known_mass_kg: None,
            uncertainty: UncertaintyInputs::default(),
        }
    }
}
