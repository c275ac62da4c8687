//! What must be known for a thrust constant beside its loads.

use crate::budget::UncertaintyInputs;
use hovertone_vehicle::CLOCK_PPM;
use serde::Serialize;

/// What a constant needs to be known beside its loads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ThrustSettings {
    /// Rotors of the vehicle.
    pub rotor_count: u32,
    /// Diameter of its propellers, where known.
    pub propeller_diameter_m: Option<f64>,
    /// Density of the air, where known.
    pub air_density_kg_m3: Option<f64>,
    /// How far the recorder's clock may be off, in millionths: a half width.
    pub clock_ppm: f64,
    /// Whether the speeds are those of a single ridge, which follows the loudest rotor.
    pub follows_loudest: bool,
    /// Where they are not: how far, as a share, their mean may be from that of all rotors, since not all were told apart.
    pub unresolved_std_share: f64,
    /// Whether somebody weighed the vehicle: a preset's or a model's mass is that of another specimen.
    pub is_weighed: bool,
    /// How large the effects may be that nobody measured.
    pub uncertainty: UncertaintyInputs,
}

impl ThrustSettings {
    /// Of a vehicle with so many rotors, all else by default.
    pub fn for_rotors(rotor_count: u32) -> Self {
        Self {
            rotor_count,
            propeller_diameter_m: None,
            air_density_kg_m3: None,
            clock_ppm: CLOCK_PPM,
            follows_loudest: true,
            unresolved_std_share: 0.0,
            is_weighed: true,
            uncertainty: UncertaintyInputs::default(),
        }
    }
}
