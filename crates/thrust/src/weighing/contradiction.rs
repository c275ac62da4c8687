//! Masses that contradict a weighed hover, and what to do about them.

use super::{AcousticScale, LIGHTER_SHARE_MAX};
use hovertone_vehicle::{GRAMS_FACTOR, MASS_ALONE_KG_MAX, MASS_FACTOR_MAX, RotorSpeed};
use std::ops::RangeInclusive;

/// A mass that contradicts the hover.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WeighError {
    /// The vehicle alone is heavier than what hovers.
    #[error("by the sound, the vehicle with its payload weighs {:.0} g, but the vehicle alone weighs {:.0} g", 1e3 * .hover_kg, 1e3 * .vehicle_kg)]
    LighterThanVehicle {
        /// Mass by the sound.
        hover_kg: f64,
        /// Mass of the vehicle, as given.
        vehicle_kg: f64,
    },
    /// The vehicle alone would turn its rotors faster than they are searched for.
    #[error(
        "mass_kg = {vehicle_kg}: with this constant the vehicle alone would hover at {rev_s:.0} rev/s, but hovertone searches \
        for its rotors only up to {fastest_rev_s:.0} rev/s"
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
        "by the sound, the vehicle with its payload weighs {:.0} g, more than ten times the {:.0} g of the vehicle alone",
        1e3 * .hover_kg, 1e3 * .vehicle_kg
    )]
    FarHeavier {
        /// Mass by the sound.
        hover_kg: f64,
        /// Mass of the vehicle, as given.
        vehicle_kg: f64,
    },
}

impl AcousticScale {
    /// Checks, before anything is heard, that the vehicle alone can hover at all with this constant: its payload adds to its mass.
    ///
    /// # Errors
    /// [`WeighError::TooHeavyToHover`] where its rotors would turn faster than the fastest speed that is searched for.
    pub fn check_vehicle(&self, fastest: RotorSpeed) -> Result<(), WeighError> {
        let Some((vehicle, speeds)) = self.vehicle_mass_kg.zip(self.hover_speeds()) else { return Ok(()) };
        let (rev_s, fastest_rev_s) = (speeds.start().rev_s(), fastest.rev_s());
        if rev_s > fastest_rev_s {
            // the lower limit is that of a lighter vehicle
            let rev_s = rev_s / (1.0 - LIGHTER_SHARE_MAX).sqrt();
            return Err(WeighError::TooHeavyToHover { vehicle_kg: vehicle.value, rev_s, fastest_rev_s });
        }
        Ok(())
    }

    /// The shaft speeds at which the vehicle can hover: from the lightest to the heaviest mass that does not contradict its own, ω = √(m g / C_f).
    /// `None` without the mass of the vehicle.
    pub fn hover_speeds(&self) -> Option<RangeInclusive<RotorSpeed>> {
        let vehicle_kg = self.vehicle_mass_kg?.value;
        let hover = |mass_kg: f64| {
            RotorSpeed::from_rad_s((mass_kg * self.gravity_m_s2 / self.thrust_constant_total_n_s2.value).sqrt())
        };
        Some(hover((1.0 - LIGHTER_SHARE_MAX) * vehicle_kg)..=hover(MASS_FACTOR_MAX * vehicle_kg))
    }
}

impl WeighError {
    /// Advice to the user.
    pub fn hint(&self) -> String {
        match self {
            Self::LighterThanVehicle { hover_kg, vehicle_kg } if GRAMS_FACTOR.contains(&(vehicle_kg / hover_kg)) => {
                grams_hint(*vehicle_kg)
            }
            // the thrust goes with the square of the speed
            Self::TooHeavyToHover { vehicle_kg, rev_s, fastest_rev_s }
                if (rev_s / fastest_rev_s).powi(2) > MASS_FACTOR_MAX || *vehicle_kg > MASS_ALONE_KG_MAX =>
            {
                format!("{}; if the mass is right, {CHECK_OTHERS}", grams_hint(*vehicle_kg))
            }
            _ => CHECK.to_owned(),
        }
    }
}

const CHECK: &str = "check the mass of the vehicle (in kilograms), the thrust constant (of the whole vehicle, in N/(rad/s)²), and the \
blades or the gear";
/// The same without the mass.
const CHECK_OTHERS: &str = "check the thrust constant (of the whole vehicle, in N/(rad/s)²)";

fn grams_hint(mass_kg: f64) -> String {
    format!("masses are in kilograms: for {mass_kg} g write --mass-kg {}", mass_kg / 1e3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_mass_that_is_far_too_large_may_be_in_grams() {
        let hint = |vehicle_kg, rev_s| WeighError::TooHeavyToHover { vehicle_kg, rev_s, fastest_rev_s: 120.0 }.hint();
        assert!(hint(413.0, 1900.0).starts_with("masses are in kilograms: for 413 g write --mass-kg 0.413"));
        assert!(!hint(2.0, 131.0).contains(" g "), "{}", hint(2.0, 131.0));
    }
}
