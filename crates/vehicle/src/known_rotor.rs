//! The prior on the shaft speed: facts about a vehicle before its sound is analysed.

use crate::{ConfigError, GRAVITY_STANDARD_M_S2, ShaftSpeedRange, Vehicle, check_range};
use serde::Serialize;
use std::ops::RangeInclusive;

/// Diameters of multirotor propellers that are accepted as a prior, m. *Decision.*
const DIAMETER_M_ALLOWED: RangeInclusive<f64> = 0.01..=5.0;
/// Masses of multirotors that are accepted as a prior, kg. *Decision.*
const MASS_KG_ALLOWED: RangeInclusive<f64> = 1e-3..=1e4;
/// Numbers of rotors that are accepted as a prior. *Decision.*
const ROTORS_ALLOWED: RangeInclusive<f64> = 1.0..=64.0;

/// Facts about a vehicle that exclude some shaft speeds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct KnownRotor {
    /// Tip-to-tip diameter of a propeller.
    pub diameter_m: Option<f64>,
    /// Take-off mass.
    pub mass_kg: Option<f64>,
    /// Number of rotors.
    pub rotor_count: Option<u32>,
    /// Blades of a propeller.
    pub blade_count: Option<u32>,
    /// Plausible shaft speeds.
    pub shaft_speed: Option<ShaftSpeedRange>,
}

impl KnownRotor {
    /// The facts of a preset.
    pub fn of_vehicle(vehicle: &Vehicle) -> Self {
        Self {
            diameter_m: vehicle.propeller_diameter_m.map(|diameter| diameter.value),
            mass_kg: vehicle.mass_kg.map(|mass| mass.value),
            rotor_count: Some(vehicle.rotor_count.value),
            blade_count: vehicle.blade_count.map(|blades| blades.value),
            shaft_speed: vehicle.shaft_speed.map(|range| range.value),
        }
    }

    /// Thrust coefficient C_T = T/(ρ n² D⁴) of a hover at the shaft speed n, with T = m g / rotors. `None` unless mass, number of rotors
    /// and diameter are known.
    pub fn hover_thrust_coefficient(&self, shaft_rev_s: f64, air_density_kg_m3: f64) -> Option<f64> {
        let (diameter_m, mass_kg, rotor_count) = (self.diameter_m?, self.mass_kg?, self.rotor_count?);
        let thrust_n = mass_kg * GRAVITY_STANDARD_M_S2 / f64::from(rotor_count);
        Some(thrust_n / (air_density_kg_m3 * shaft_rev_s.powi(2) * diameter_m.powi(4)))
    }

    /// Checks every number against its limits.
    ///
    /// # Errors
    /// The first number outside its limits.
    pub fn check(&self) -> Result<(), ConfigError> {
        let within = |name, value: Option<f64>, allowed: RangeInclusive<f64>| {
            value.map_or(Ok(()), |value| check_range(name, value, *allowed.start(), *allowed.end()))
        };
        within("diameter_m", self.diameter_m, DIAMETER_M_ALLOWED)?;
        within("mass_kg", self.mass_kg, MASS_KG_ALLOWED)?;
        within("rotors", self.rotor_count.map(f64::from), ROTORS_ALLOWED)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hover_means_a_thrust_coefficient_where_mass_rotors_and_diameter_are_known() {
        let known =
            KnownRotor { diameter_m: Some(0.2), mass_kg: Some(0.4), rotor_count: Some(4), ..KnownRotor::default() };
        // 0.1 kg each at 60 rev/s in air of 1.2 kg/m³: 0.980665 / (1.2 · 3600 · 0.0016)
        let coefficient = known.hover_thrust_coefficient(60.0, 1.2).unwrap();
        assert!((coefficient - 0.980_665 / 6.912).abs() < 1e-12, "{coefficient}");
        assert_eq!(KnownRotor { mass_kg: None, ..known }.hover_thrust_coefficient(60.0, 1.2), None);
    }
}
