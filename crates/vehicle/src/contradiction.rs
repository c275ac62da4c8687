//! What a person says of a vehicle, against what is known of it and what can fly.

use crate::{GRAMS_FACTOR, Gear, RotorSpeed, SOUND_M_S, Vehicle, are_masses_of_one_vehicle};
use std::f64::consts::PI;

/// Largest Mach number of the blade tips of a multirotor in hover. Tips are kept slower for the sake of noise and efficiency. *Physics.*
pub const TIP_MACH_MAX: f64 = 0.6;

/// Two statements of which one must be wrong.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Contradiction {
    /// Blades that the vehicle does not have.
    #[error("blades = {said}, and the propellers of the vehicle \"{vehicle}\" have {known} blades")]
    Blades {
        /// Name of the vehicle in files and flags.
        vehicle: &'static str,
        /// Its number of blades.
        known: u32,
        /// The given number of blades.
        said: u32,
    },
    /// A gear that the vehicle does not have.
    #[error(
        "gear = {}:{}, and the gear of the vehicle \"{vehicle}\" is {}:{}",
        .said.pinion, .said.wheel, .known.pinion, .known.wheel
    )]
    Gear {
        /// Name of the vehicle in files and flags.
        vehicle: &'static str,
        /// Its gear.
        known: Gear,
        /// The given gear.
        said: Gear,
    },
    /// More rotors than the vehicle has.
    #[error("rotors = {said}, and the vehicle \"{vehicle}\" has {known} rotors")]
    Rotors {
        /// Name of the vehicle in files and flags.
        vehicle: &'static str,
        /// Its number of rotors.
        known: u32,
        /// The given number.
        said: u32,
    },
    /// A mass that is far from the vehicle's.
    #[error("mass_kg = {said_kg}, and the vehicle \"{vehicle}\" weighs {known_kg} kg")]
    Mass {
        /// Name of the vehicle in files and flags.
        vehicle: &'static str,
        /// Its mass.
        known_kg: f64,
        /// The given mass.
        said_kg: f64,
    },
    /// A pinion with more teeth than the wheel.
    #[error("gear = {}:{} would turn the rotor faster than its motor: the two numbers are swapped", .0.pinion, .0.wheel)]
    GearSwapped(Gear),
    /// A propeller whose tips would be too fast.
    #[error(
        "diameter_m = {diameter_m}: at {rev_s:.1} rev/s the blade tips would move at Mach {mach:.2}, and no multirotor passes Mach {TIP_MACH_MAX}"
    )]
    TipsTooFast {
        /// The given diameter.
        diameter_m: f64,
        /// Shaft speed.
        rev_s: f64,
        /// Mach number of the tips at this speed.
        mach: f64,
    },
}

impl Contradiction {
    /// Advice to the user.
    pub fn hint(&self) -> String {
        match self {
            Self::Blades { .. } => "leave out one of the two; another propeller than the usual one needs --blades \
                                    without --vehicle"
                .to_owned(),
            Self::Gear { .. } => "leave out one of the two; another gear than the usual one needs --gear without \
                                  --vehicle"
                .to_owned(),
            Self::Rotors { .. } => "give the number of its rotors that turn".to_owned(),
            Self::Mass { known_kg, said_kg, .. } if GRAMS_FACTOR.contains(&(said_kg / known_kg)) => {
                format!("masses are in kilograms: {said_kg} g are {}", said_kg / 1e3)
            }
            Self::Mass { .. } => "check the mass (in kilograms) and the name of the vehicle".to_owned(),
            Self::GearSwapped(gear) => {
                format!("the pinion on the motor comes first: write {}:{}", gear.wheel, gear.pinion)
            }
            Self::TipsTooFast { .. } => "check the diameter (from tip to tip, in metres: 10 inches are 0.254) and the \
                                         number of blades"
                .to_owned(),
        }
    }
}

impl Gear {
    /// Checks that the gear slows the rotor down, as each gear of a multirotor does.
    ///
    /// # Errors
    /// [`Contradiction::GearSwapped`] where the pinion has more teeth than the wheel.
    pub fn check(self) -> Result<(), Contradiction> {
        if self.pinion > self.wheel { Err(Contradiction::GearSwapped(self)) } else { Ok(()) }
    }
}

impl Vehicle {
    /// Compares blades and gear with those of the vehicle, where both are known. A pinion of one tooth means that only the wheel was said.
    ///
    /// # Errors
    /// The first number that differs.
    pub fn check_said(&self, blades: Option<u32>, gear: Option<Gear>) -> Result<(), Contradiction> {
        let vehicle = self.id;
        if let (Some(said), Some(known)) = (blades, self.blade_count.map(|blades| blades.value))
            && said != known
        {
            return Err(Contradiction::Blades { vehicle, known, said });
        }
        if let (Some(said), Some(known)) = (gear, self.gear.map(|gear| gear.value)) {
            let is_same_pinion = said.pinion == 1 || said.pinion == known.pinion;
            if said.wheel != known.wheel || !is_same_pinion {
                return Err(Contradiction::Gear { vehicle, known, said });
            }
        }
        Ok(())
    }

    /// Compares a number of running rotors and a mass as flown with those of the vehicle. On a bench fewer rotors may run than it has.
    ///
    /// # Errors
    /// More rotors than it has; a mass more than [`crate::MASS_FACTOR_MAX`] times larger or smaller than its own.
    pub fn check_flown(&self, rotors: Option<u32>, mass_kg: Option<f64>) -> Result<(), Contradiction> {
        let (vehicle, known) = (self.id, self.rotor_count.value);
        if let Some(said) = rotors.filter(|&said| said > known) {
            return Err(Contradiction::Rotors { vehicle, known, said });
        }
        if let (Some(said_kg), Some(known_kg)) = (mass_kg, self.mass_kg.map(|mass| mass.value))
            && !are_masses_of_one_vehicle(said_kg, known_kg)
        {
            return Err(Contradiction::Mass { vehicle, known_kg, said_kg });
        }
        Ok(())
    }
}

/// Checks that the blade tips of a propeller, π D n, stay below [`TIP_MACH_MAX`] in air of 20 °C.
///
/// # Errors
/// [`Contradiction::TipsTooFast`].
pub fn check_tips(diameter_m: f64, speed: RotorSpeed) -> Result<(), Contradiction> {
    let rev_s = speed.rev_s();
    let mach = PI * diameter_m * rev_s / SOUND_M_S;
    if mach > TIP_MACH_MAX { Err(Contradiction::TipsTooFast { diameter_m, rev_s, mach }) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::find_preset;

    #[test]
    fn a_vehicle_has_its_own_blades_and_gear() {
        let vehicle = find_preset("ardrone").unwrap();
        let known = Gear { pinion: 8, wheel: 69 };
        vehicle.check_said(Some(2), Some(known)).unwrap();
        vehicle.check_said(None, Some(Gear { pinion: 1, wheel: 69 })).unwrap();
        assert_eq!(
            vehicle.check_said(Some(3), None),
            Err(Contradiction::Blades { vehicle: "ardrone", known: 2, said: 3 })
        );
        for said in [Gear { pinion: 1, wheel: 68 }, Gear { pinion: 9, wheel: 69 }] {
            assert_eq!(
                vehicle.check_said(Some(2), Some(said)),
                Err(Contradiction::Gear { vehicle: "ardrone", known, said })
            );
        }
        // nothing is known of the first Bebop's blades
        find_preset("bebop").unwrap().check_said(Some(3), Some(known)).unwrap();
    }

    #[test]
    fn a_vehicle_has_its_own_rotors_and_mass() {
        let vehicle = find_preset("ardrone").unwrap();
        for (rotors, mass_kg) in [(Some(1), None), (Some(4), Some(0.413)), (None, Some(0.6))] {
            vehicle.check_flown(rotors, mass_kg).unwrap();
        }
        assert_eq!(
            vehicle.check_flown(Some(6), None),
            Err(Contradiction::Rotors { vehicle: "ardrone", known: 4, said: 6 })
        );
        let grams = vehicle.check_flown(None, Some(413.0)).unwrap_err();
        assert!(grams.hint().ends_with("413 g are 0.413"), "{}", grams.hint());
        let another = vehicle.check_flown(None, Some(0.04)).unwrap_err();
        assert!(another.hint().contains("name of the vehicle"), "{}", another.hint());
    }

    #[test]
    fn a_gear_slows_the_rotor_down() {
        Gear { pinion: 8, wheel: 69 }.check().unwrap();
        let swapped = Gear { pinion: 69, wheel: 8 }.check().unwrap_err();
        assert!(swapped.hint().ends_with("write 8:69"), "{}", swapped.hint());
    }

    #[test]
    fn tips_stay_below_mach_0_6() {
        // 0.6 · 343.2 m/s over π · 0.254 m
        let limit = RotorSpeed::from_rev_s(0.6 * 343.2 / (PI * 0.254));
        assert!(check_tips(0.254, RotorSpeed::from_rad_s(0.999 * limit.rad_s())).is_ok());
        assert!(check_tips(0.254, RotorSpeed::from_rad_s(1.001 * limit.rad_s())).is_err());
        let error = check_tips(2.54, RotorSpeed::from_rev_s(60.0)).unwrap_err();
        assert!(error.to_string().contains("Mach 1.40") && error.hint().contains("0.254"), "{error}");
    }

    /// The fastest speed that a source has for a vehicle must not be refused.
    #[test]
    fn every_vehicle_passes_at_its_fastest() {
        let mut checked = 0;
        for vehicle in crate::presets() {
            if let Some((range, diameter)) = vehicle.shaft_speed.zip(vehicle.propeller_diameter_m) {
                check_tips(diameter.value, RotorSpeed::from_rev_s(range.value.rev_s_high)).unwrap();
                checked += 1;
            }
        }
        assert!(checked >= 2, "{checked}");
    }
}
