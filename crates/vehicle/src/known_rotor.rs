//! The prior on the shaft speed: facts about a vehicle before its sound is analysed.

use crate::contradiction::HOVER_REV_S_MIN;
use crate::{
    AIR_KG_M3, ConfigError, Contradiction, GRAVITY_STANDARD_M_S2, MASS_ALONE_KG_MAX, PROPELLER_DIAMETER_M, ROTORS_MAX,
    RotorSpeed, SOUND_M_S, ShaftSpeedRange, THRUST_COEFFICIENT, TIP_MACH_MAX, Vehicle, check_range, check_tips,
};
use serde::Serialize;
use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// Masses of multirotors that are accepted as a prior, kg. *Decision.*
const MASS_KG_ALLOWED: RangeInclusive<f64> = 1e-3..=1e4;
/// Numbers of rotors that a multirotor may have. *Decision.*
const ROTORS_ALLOWED: RangeInclusive<f64> = 1.0..=ROTORS_MAX as f64;

/// Facts about a vehicle that exclude some shaft speeds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct KnownRotor {
    /// Name of the known vehicle that these facts come from, in files and flags.
    pub vehicle: Option<&'static str>,
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
            vehicle: Some(vehicle.id),
            diameter_m: vehicle.propeller_diameter_m.map(|diameter| diameter.value),
            mass_kg: vehicle.mass_kg.map(|mass| mass.value),
            rotor_count: Some(vehicle.rotor_count.value),
            blade_count: vehicle.blade_count.map(|blades| blades.value),
            shaft_speed: vehicle.shaft_speed.map(|range| range.value),
        }
    }

    /// Thrust coefficient C_T = F/(ρ n² D⁴) of a hover at the shaft speed n, with F = m g / rotors. `None` unless mass, number of rotors
    /// and diameter are known.
    pub fn hover_thrust_coefficient(&self, shaft_rev_s: f64, air_density_kg_m3: f64) -> Option<f64> {
        let (diameter_m, mass_kg, rotor_count) = (self.diameter_m?, self.mass_kg?, self.rotor_count?);
        let thrust_n = mass_kg * GRAVITY_STANDARD_M_S2 / f64::from(rotor_count);
        Some(thrust_n / (air_density_kg_m3 * shaft_rev_s.powi(2) * diameter_m.powi(4)))
    }

    /// Shaft speed of a hover at a thrust coefficient, rev/s.
    fn hover_rev_s(mass_kg: f64, diameter_m: f64, rotors: f64, coefficient: f64) -> f64 {
        let thrust_n = mass_kg * GRAVITY_STANDARD_M_S2 / rotors;
        (thrust_n / (AIR_KG_M3 * coefficient * diameter_m.powi(4))).sqrt()
    }

    /// Checks that propellers of this diameter carry this mass with a possible thrust coefficient, neither with tips above
    /// [`TIP_MACH_MAX`] nor too slowly. Where the number of rotors is not known, it may be any.
    ///
    /// # Errors
    /// [`Contradiction::TooSmallToCarry`], [`Contradiction::TooLargeToCarry`], and [`Contradiction::HeavyWithoutDiameter`] for a mass that
    /// only a diameter makes plausible.
    pub fn check_hover(&self) -> Result<(), Contradiction> {
        let Some(mass_kg) = self.mass_kg else { return Ok(()) };
        let Some(diameter_m) = self.diameter_m else {
            let is_heavy = mass_kg > MASS_ALONE_KG_MAX;
            return if is_heavy { Err(Contradiction::HeavyWithoutDiameter(mass_kg)) } else { Ok(()) };
        };
        let rotors = self.rotor_count.map(f64::from);
        let (most, fewest) = (rotors.unwrap_or(*ROTORS_ALLOWED.end()), rotors.unwrap_or(*ROTORS_ALLOWED.start()));
        let slowest_rev_s = Self::hover_rev_s(mass_kg, diameter_m, most, *THRUST_COEFFICIENT.end());
        let mach = PI * diameter_m * slowest_rev_s / SOUND_M_S;
        if mach > TIP_MACH_MAX {
            return Err(Contradiction::TooSmallToCarry { diameter_m, mass_kg, mach });
        }
        let rev_s = Self::hover_rev_s(mass_kg, diameter_m, fewest, *THRUST_COEFFICIENT.start());
        if rev_s < HOVER_REV_S_MIN {
            return Err(Contradiction::TooLargeToCarry { diameter_m, mass_kg, rev_s });
        }
        Ok(())
    }

    /// Checks that the propellers may turn as fast as the slowest hover of a multirotor.
    ///
    /// # Errors
    /// [`Contradiction::TipsTooFast`].
    pub fn check_diameter(&self) -> Result<(), Contradiction> {
        self.diameter_m.map_or(Ok(()), |diameter_m| check_tips(diameter_m, RotorSpeed::from_rev_s(HOVER_REV_S_MIN)))
    }

    /// Checks every number against its limits.
    ///
    /// # Errors
    /// The first number outside its limits.
    pub fn check(&self) -> Result<(), ConfigError> {
        let within = |name, value: Option<f64>, allowed: RangeInclusive<f64>| {
            value.map_or(Ok(()), |value| check_range(name, value, *allowed.start(), *allowed.end()))
        };
        within("diameter_m", self.diameter_m, PROPELLER_DIAMETER_M)?;
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
    #[test]
    fn propellers_carry_the_mass() {
        let known =
            KnownRotor { diameter_m: Some(0.2), mass_kg: Some(0.413), rotor_count: Some(4), ..KnownRotor::default() };
        known.check_hover().unwrap();
        let with = |diameter_m: f64, mass_kg: f64| KnownRotor {
            diameter_m: Some(diameter_m),
            mass_kg: Some(mass_kg),
            ..known
        };
        // 1.0125 N over 1.2 kg/m³ · 0.25 · (20 mm)⁴: 4594 rev/s
        let small = with(0.02, 0.413).check_hover().unwrap_err();
        assert!(small.to_string().contains("Mach 0.84"), "{small}");
        assert!(matches!(with(0.2, 413.0).check_hover(), Err(Contradiction::TooSmallToCarry { .. })));
        assert!(matches!(with(8.0, 0.413).check_hover(), Err(Contradiction::TooLargeToCarry { .. })));
        // with any number of rotors one of them would do
        KnownRotor { rotor_count: None, ..with(0.02, 0.413) }.check_hover().unwrap();
        assert!(KnownRotor { rotor_count: None, ..with(0.005, 0.413) }.check_hover().is_err());
        let heavy = KnownRotor { diameter_m: None, ..with(0.2, 413.0) }.check_hover().unwrap_err();
        assert!(heavy.hint().contains("for 413 g write 0.413"), "{}", heavy.hint());
        // 360 kg on eight propellers of 1.6 m: there are such vehicles
        KnownRotor { rotor_count: Some(8), ..with(1.6, 360.0) }.check_hover().unwrap();
    }

    #[test]
    fn ten_inches_are_not_ten_metres() {
        let of = |diameter_m| KnownRotor { diameter_m: Some(diameter_m), ..KnownRotor::default() };
        of(2.0).check_diameter().unwrap();
        assert!(of(10.0).check_diameter().unwrap_err().hint().contains("for 10 inches write 0.254"));
    }

    #[test]
    fn every_preset_can_fly() {
        assert!(!crate::presets().is_empty());
        for vehicle in crate::presets() {
            KnownRotor::of_vehicle(vehicle).check_hover().unwrap();
        }
    }
}
