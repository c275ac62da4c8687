//! Masses that contradict a weighed hover, and what to do about them.

use hovertone_vehicle::GRAMS_FACTOR;

/// A mass that contradicts the hover.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WeighError {
    /// The vehicle alone is heavier than what hovers.
    #[error("the hover carries {:.0} g, but the vehicle alone weighs {:.0} g", 1e3 * .hover_kg, 1e3 * .vehicle_kg)]
    LighterThanVehicle {
        /// Mass by the sound.
        hover_kg: f64,
        /// Mass of the vehicle, as given.
        vehicle_kg: f64,
    },
    /// The vehicle alone would turn its rotors faster than they are searched for.
    #[error(
        "mass_kg = {vehicle_kg}: with this constant the vehicle alone would hover at {rev_s:.0} rev/s, and its rotors turn at no more than \
         {fastest_rev_s:.0} rev/s"
    )]
    TooHeavyToHover {
        /// Mass of the vehicle, as given.
        vehicle_kg: f64,
        /// Shaft speed at which it would hover.
        rev_s: f64,
        /// Fastest shaft speed of the search.
        fastest_rev_s: f64,
    },
    /// No vehicle carries so much.
    #[error(
        "the hover carries {:.0} g, which is more than ten times the vehicle's {:.0} g",
        1e3 * .hover_kg, 1e3 * .vehicle_kg
    )]
    FarHeavier {
        /// Mass by the sound.
        hover_kg: f64,
        /// Mass of the vehicle, as given.
        vehicle_kg: f64,
    },
}

impl WeighError {
    /// Advice to the user.
    pub fn hint(&self) -> String {
        match self {
            Self::LighterThanVehicle { hover_kg, vehicle_kg } if GRAMS_FACTOR.contains(&(vehicle_kg / hover_kg)) => {
                grams_hint(*vehicle_kg)
            }
            Self::TooHeavyToHover { vehicle_kg, .. } => format!("{}; {CHECK}", grams_hint(*vehicle_kg)),
            _ => CHECK.to_owned(),
        }
    }
}

const CHECK: &str = "check the mass of the vehicle (in kilograms), the thrust constant (of the whole vehicle, in \
                     N/(rad/s)²), and which tone is the rotor's";

fn grams_hint(mass_kg: f64) -> String {
    format!("masses are in kilograms: {mass_kg} g are --mass-kg {}", mass_kg / 1e3)
}
