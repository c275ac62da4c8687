//! A vehicle that a user describes in a file, beside the presets.

use crate::{
    BLADE_COUNT_MAX, Contradiction, Gear, KnownRotor, QuantityError, RotorSpeed, SHAFT_REV_S, ShaftSpeedRange, Sourced,
    Vehicle, check_diameter, check_tips,
};
use serde::Deserialize;

/// The numbers of blades up to [`BLADE_COUNT_MAX`] in words.
const BLADES_WORDS: &str = "from 1 to 12";
/// [`SHAFT_REV_S`] in words.
const SHAFT_WORDS: &str = "from 1 to 1500: it is in turns per second, and 3600 rpm are 60";
/// Source of the numbers where the file names none.
const SOURCE: &str = "your own vehicles.toml";

/// A vehicle as written in a file. Unknown keys are refused.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OwnVehicle {
    /// Name for people; where absent, the name in files and flags.
    pub name: Option<String>,
    /// Number of rotors.
    pub rotors: u32,
    /// Blades of each propeller.
    pub blades: Option<u32>,
    /// Gear between each motor and its rotor.
    pub gear: Option<Gear>,
    /// Tip-to-tip diameter of the propellers.
    pub propeller_diameter_m: Option<f64>,
    /// Take-off mass with battery.
    pub mass_kg: Option<f64>,
    /// Plausible shaft speeds in flight: slowest and fastest.
    pub shaft_speed_rev_s: Option<(f64, f64)>,
    /// Source of the numbers.
    pub source: Option<String>,
}

/// Error in a vehicle of a user.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OwnVehicleError {
    /// A name that no flag could hold.
    #[error("the name \"{id}\" may have only small letters, digits, - and _")]
    Name {
        /// The name.
        id: String,
    },
    /// A number out of range.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
    /// An entry that no vehicle has.
    #[error(transparent)]
    Vehicle(#[from] Contradiction),
}

impl OwnVehicle {
    /// The vehicle with the given name in files and flags. Its texts are kept to the end of the program, as those of the presets are: call
    /// this once for each file.
    ///
    /// # Errors
    /// A name with signs that no flag holds, a number out of range, a gear whose pinion is larger than its wheel.
    pub fn vehicle(&self, id: &str) -> Result<Vehicle, OwnVehicleError> {
        let fits = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || "-_".contains(letter);
        if id.is_empty() || id.starts_with('-') || !id.chars().all(fits) {
            return Err(OwnVehicleError::Name { id: id.to_owned() });
        }
        self.check()?;
        self.check_flight()?;
        let source: &'static str = self.source.clone().map_or(SOURCE, |source| source.leak());
        let shaft_speed =
            self.shaft_speed_rev_s.map(|(low, high)| ShaftSpeedRange { rev_s_low: low, rev_s_high: high });
        Ok(Vehicle {
            id: id.to_owned().leak(),
            name: self.name.clone().unwrap_or_else(|| id.to_owned()).leak(),
            rotor_count: Sourced { value: self.rotors, source },
            blade_count: self.blades.map(|value| Sourced { value, source }),
            gear: self.gear.map(|value| Sourced { value, source }),
            propeller_diameter_m: self.propeller_diameter_m.map(|value| Sourced { value, source }),
            mass_kg: self.mass_kg.map(|value| Sourced { value, source }),
            shaft_speed: shaft_speed.map(|value| Sourced { value, source }),
        })
    }

    /// Checks that the numbers together are those of a vehicle that flies.
    fn check_flight(&self) -> Result<(), Contradiction> {
        if let (Some(diameter_m), Some((_, high_rev_s))) = (self.propeller_diameter_m, self.shaft_speed_rev_s) {
            check_tips(diameter_m, RotorSpeed::from_rev_s(high_rev_s))?;
        }
        let known = KnownRotor {
            diameter_m: self.propeller_diameter_m,
            mass_kg: self.mass_kg,
            rotor_count: Some(self.rotors),
            ..KnownRotor::default()
        };
        known.check_hover()
    }

    fn check(&self) -> Result<(), OwnVehicleError> {
        self.gear.map_or(Ok(()), Gear::check)?;
        let refuse = |name, value, must_be| Err(QuantityError { name, value, must_be }.into());
        let of_mass = KnownRotor { mass_kg: self.mass_kg, ..KnownRotor::default() };
        let of_rotors = KnownRotor { rotor_count: Some(self.rotors), ..KnownRotor::default() };
        if of_rotors.check().is_err() {
            return refuse("rotors", f64::from(self.rotors), "from 1 to 12");
        }
        let diameter_m = self.propeller_diameter_m;
        diameter_m.map_or(Ok(()), |diameter_m| check_diameter("propeller_diameter_m", diameter_m))?;
        match (self.blades, self.mass_kg, self.shaft_speed_rev_s) {
            (Some(blades), ..) if !(1..=BLADE_COUNT_MAX).contains(&blades) => {
                refuse("blades", f64::from(blades), BLADES_WORDS)
            }
            (_, Some(mass_kg), _) if of_mass.check().is_err() => {
                refuse("mass_kg", mass_kg, "from 0.001 to 10000: it is in kilograms")
            }
            (.., Some((low, high))) => match [low, high].into_iter().find(|rev_s| !SHAFT_REV_S.contains(rev_s)) {
                Some(beyond) => refuse("shaft_speed_rev_s", beyond, SHAFT_WORDS),
                None if low >= high => refuse("shaft_speed_rev_s", low, "below the second number"),
                None => Ok(()),
            },
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn own() -> OwnVehicle {
        OwnVehicle {
            name: None,
            rotors: 6,
            blades: Some(3),
            gear: None,
            propeller_diameter_m: Some(0.2),
            mass_kg: Some(0.9),
            shaft_speed_rev_s: Some((40.0, 200.0)),
            source: None,
        }
    }

    #[test]
    fn an_own_vehicle_is_as_a_preset() {
        let vehicle = own().vehicle("hexa-1").unwrap();
        assert_eq!((vehicle.id, vehicle.name, vehicle.rotor_count.value), ("hexa-1", "hexa-1", 6));
        assert_eq!(vehicle.tone_order().unwrap().lines_per_turn(), 3.0);
        assert_eq!(vehicle.mass_kg.unwrap().source, SOURCE);
        let named = OwnVehicle { name: Some("Hexa".to_owned()), source: Some("my scale".to_owned()), ..own() };
        let vehicle = named.vehicle("hexa").unwrap();
        assert_eq!((vehicle.name, vehicle.blade_count.unwrap().source), ("Hexa", "my scale"));
    }

    #[test]
    fn the_words_have_the_bounds() {
        assert!(SHAFT_WORDS.contains(&format!("from {} to {}:", SHAFT_REV_S.start(), SHAFT_REV_S.end())));
        assert_eq!(BLADES_WORDS, format!("from 1 to {BLADE_COUNT_MAX}"));
    }

    #[test]
    fn what_no_vehicle_has_is_refused_by_name() {
        for id in ["", "Hexa", "my drone", "-x", "a.b"] {
            assert!(matches!(own().vehicle(id), Err(OwnVehicleError::Name { .. })), "{id}");
        }
        for (wrong, said) in [
            (OwnVehicle { rotors: 0, ..own() }, "rotors"),
            (OwnVehicle { blades: Some(0), ..own() }, "blades"),
            (OwnVehicle { blades: Some(13), ..own() }, "blades = 13, but it must be from 1 to 12"),
            (OwnVehicle { propeller_diameter_m: Some(254.0), ..own() }, "metres"),
            (OwnVehicle { mass_kg: Some(f64::NAN), ..own() }, "mass_kg"),
            (OwnVehicle { shaft_speed_rev_s: Some((200.0, 40.0)), ..own() }, "shaft_speed_rev_s"),
            (OwnVehicle { shaft_speed_rev_s: Some((3600.0, 9000.0)), ..own() }, "3600 rpm are 60"),
            (OwnVehicle { shaft_speed_rev_s: Some((0.5, 90.0)), ..own() }, "from 1 to 1500"),
            (OwnVehicle { rotors: 13, ..own() }, "rotors = 13, but it must be from 1 to 12"),
            (OwnVehicle { gear: Some(Gear { pinion: 69, wheel: 8 }), ..own() }, "swapped"),
            (OwnVehicle { mass_kg: Some(250.0), ..own() }, "Mach"),
            (
                OwnVehicle { mass_kg: Some(250.0), propeller_diameter_m: None, ..own() },
                "more than most multirotors weigh",
            ),
            (OwnVehicle { propeller_diameter_m: Some(2.0), mass_kg: None, ..own() }, "Mach 3.66"),
            (OwnVehicle { propeller_diameter_m: Some(0.02), shaft_speed_rev_s: None, ..own() }, "Mach"),
        ] {
            let message = wrong.vehicle("hexa").unwrap_err().to_string();
            assert!(message.contains(said), "{message}");
        }
    }
}
