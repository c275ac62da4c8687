//! What a person says of a vehicle, against what is known of it and what can fly.

use crate::presets::INCH_M;
use crate::{Gear, KNOWN_MASS_SHARES, Order, RotorSpeed, SOUND_M_S};
use std::f64::consts::PI;

/// Largest Mach number of the blade tips of a multirotor in hover. Tips are kept slower for the sake of noise and efficiency. *Physics.*
pub const TIP_MACH_MAX: f64 = 0.6;

/// Slowest shaft speed of a multirotor in hover, rev/s. The largest multirotors' propellers make 30. *Physics.*
pub(crate) const HOVER_REV_S_MIN: f64 = 10.0;

/// Diameters of so many metres and more were read in inches: the largest propellers of multirotors have 1.6 m. *Physics.*
const INCHES_MIN: f64 = 3.0;
/// Fewest teeth of the wheel on a rotor: pinions have six or more, and the gear halves the speed at least. *Physics.*
const WHEEL_TEETH_MIN: u32 = 12;

/// Two statements of which one must be wrong.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Contradiction {
    /// Blades that the vehicle does not have.
    #[error("blades = {said}, but the propellers of the vehicle \"{vehicle}\" have {known} blades")]
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
        "gear = {}:{}, but the gear of the vehicle \"{vehicle}\" is {}:{}",
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
    /// A tone that the vehicle does not have.
    #[error(
        "order = {said} means a tone at {said} times the rotor speed, but the tone of the vehicle \"{vehicle}\" is at \
        {known} times the rotor speed"
    )]
    Order {
        /// Name of the vehicle in files and flags.
        vehicle: &'static str,
        /// The order of its tone.
        known: Order,
        /// The given order.
        said: Order,
    },
    /// A band in which the tone cannot lie.
    #[error(
        "band = {low_hz}:{high_hz} Hz: a tone at {order} times the rotor speed in this band means {:.1} to {:.1} \
        rev/s, but hovertone searches for the rotor from {rev_s_min:.1} to {rev_s_max:.1} rev/s",
        .low_hz / .order.lines_per_turn(), .high_hz / .order.lines_per_turn()
    )]
    Band {
        /// Lower edge.
        low_hz: f64,
        /// Upper edge.
        high_hz: f64,
        /// Order of the tone.
        order: Order,
        /// Slowest shaft speed.
        rev_s_min: f64,
        /// Fastest shaft speed.
        rev_s_max: f64,
    },
    /// A small order that is neither that of the shaft nor a multiple of the blades.
    #[error(
        "order = {order} and blades = {blades} exclude each other: propellers with {blades} blades make a tone at \
        {blades} times the rotor speed, and its multiples"
    )]
    OrderOfBlades {
        /// The given order.
        order: Order,
        /// The given blades.
        blades: u32,
    },
    /// Another number of rotors than the vehicle has.
    #[error("rotors = {said}, but the vehicle \"{vehicle}\" has {known} rotors")]
    Rotors {
        /// Name of the vehicle in files and flags.
        vehicle: &'static str,
        /// Its number of rotors.
        known: u32,
        /// The given number.
        said: u32,
    },
    /// A mass of hundreds of kilograms, and nothing else that would bear it out.
    #[error("mass_kg = {0} is more than most multirotors weigh, and the diameter of the propellers is not given")]
    HeavyWithoutDiameter(f64),
    /// Propellers that are too small for the mass.
    #[error(
        "diameter_m = {diameter_m} and mass_kg = {mass_kg}: to carry this mass, the blade tips would need Mach {mach:.2}, and no \
        multirotor exceeds Mach {TIP_MACH_MAX}"
    )]
    TooSmallToCarry {
        /// Diameter of the propellers.
        diameter_m: f64,
        /// Mass as flown.
        mass_kg: f64,
        /// Mach number of the tips.
        mach: f64,
    },
    /// Propellers that are too large for the mass.
    #[error(
        "diameter_m = {diameter_m} and mass_kg = {mass_kg}: such propellers would carry this mass at {rev_s:.1} rev/s, and no multirotor \
         hovers below {HOVER_REV_S_MIN} rev/s"
    )]
    TooLargeToCarry {
        /// Diameter of the propellers.
        diameter_m: f64,
        /// Mass as flown.
        mass_kg: f64,
        /// Fastest shaft speed in hover.
        rev_s: f64,
    },
    /// A mass that is far from the vehicle's.
    #[error("mass_kg = {said_kg}, but the vehicle \"{vehicle}\" weighs {known_kg} kg")]
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
    /// A wheel with fewer teeth than any.
    #[error("the gear has a wheel of {} teeth, and the wheel of a rotor has {WHEEL_TEETH_MIN} or more", .0.wheel)]
    GearWheelTooSmall(Gear),
    /// A propeller whose tips would be too fast.
    #[error(
        "diameter_m = {diameter_m}: {} the blade tips would move at Mach {mach:.2}, and no multirotor exceeds Mach \
        {TIP_MACH_MAX}",
        at_speed(.rev_s)
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

/// "at 250.0 rev/s".
fn at_speed(rev_s: &f64) -> String {
    let at = if *rev_s <= HOVER_REV_S_MIN { "even at only" } else { "at" };
    format!("{at} {rev_s:.1} rev/s")
}

impl Contradiction {
    /// Advice to the user.
    pub fn hint(&self) -> String {
        match self {
            Self::Blades { .. } => "leave out one of the two; if your vehicle has other propellers than usual, leave its name out, and give blades, rotors and \
            the gear (if it has one)"
                .to_owned(),
            Self::Gear { .. } => "leave out one of the two; if your vehicle has another gear than usual, leave its name out, and give gear, blades and rotors"
                .to_owned(),
            Self::Order { .. } => "leave the order out: hovertone follows the multiples of the tone (its harmonics) by itself".to_owned(),
            Self::OrderOfBlades { blades, .. } => format!("leave out one of the two: blades = {blades} alone means order = {blades}"),
            Self::Band { order, rev_s_min, rev_s_max, .. } => {
                let edge_hz = |rev_s: f64| rev_s * order.lines_per_turn();
                format!(
                    "leave the band out, or give one within {:.0} to {:.0} Hz, where this tone can be; for another \
                    tone, give its order (the tone's frequency over the rotor speed) in place of blades and gear",
                    edge_hz(*rev_s_min),
                    edge_hz(*rev_s_max)
                )
            }
            Self::Rotors { said, known, .. } if said > known => format!(
                "leave out one of the two; if your vehicle has {said} rotors, give rotors and blades without the name of the vehicle"
            ),
            Self::Rotors { .. } => "leave out one of the two: in a hover, all rotors of the vehicle turn".to_owned(),
            Self::HeavyWithoutDiameter(mass_kg) => format!(
                "masses are in kilograms: for {mass_kg} g write {}; if the vehicle is this heavy, also give the diameter of its propellers",
                mass_kg / 1e3
            ),
            Self::TooSmallToCarry { .. } | Self::TooLargeToCarry { .. } => {
                "check the diameter (from tip to tip, in metres: 10 inches are 0.254), the mass (in kilograms) and the number \
                 of rotors"
                    .to_owned()
            }
            Self::Mass { known_kg, said_kg, .. } if KNOWN_MASS_SHARES.contains(&(said_kg / 1e3 / known_kg)) => {
                format!("masses are in kilograms: for {said_kg} g write {}", said_kg / 1e3)
            }
            Self::Mass { .. } => "check the mass (in kilograms) and the name of the vehicle".to_owned(),
            Self::GearSwapped(gear) => {
                format!("the pinion on the motor comes first: write {}:{}", gear.wheel, gear.pinion)
            }
            Self::GearWheelTooSmall(Gear { wheel, .. }) => format!(
                "a gear is given by the numbers of teeth, that of the motor's pinion first, such as 8:69; if {wheel} is the number of blades, \
                 give it as that, and no gear"
            ),
            Self::TipsTooFast { diameter_m, .. } if *diameter_m >= INCHES_MIN => format!(
                "the diameter is in metres, from tip to tip: for {diameter_m} inches write {:.3}",
                INCH_M * diameter_m
            ),
            Self::TipsTooFast { rev_s, .. } if *rev_s <= HOVER_REV_S_MIN => format!(
                "check the diameter (from tip to tip, in metres: 10 inches are 0.254): multirotors hover at \
                {HOVER_REV_S_MIN} rev/s or more"
            ),
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
    /// [`Contradiction::GearSwapped`] where the pinion has more teeth than the wheel, [`Contradiction::GearWheelTooSmall`] where the wheel has
    /// fewer than any: then a ratio or the number of blades was meant.
    pub fn check(self) -> Result<(), Contradiction> {
        match () {
            () if self.pinion > self.wheel => Err(Contradiction::GearSwapped(self)),
            () if self.wheel < WHEEL_TEETH_MIN => Err(Contradiction::GearWheelTooSmall(self)),
            () => Ok(()),
        }
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

    #[test]
    fn a_gear_slows_the_rotor_down() {
        Gear { pinion: 8, wheel: 69 }.check().unwrap();
        let swapped = Gear { pinion: 69, wheel: 8 }.check().unwrap_err();
        assert!(swapped.hint().ends_with("write 8:69"), "{}", swapped.hint());
        let ratio = Gear { pinion: 1, wheel: 4 }.check().unwrap_err();
        assert_eq!(ratio.to_string(), "the gear has a wheel of 4 teeth, and the wheel of a rotor has 12 or more");
        assert!(ratio.hint().contains("if 4 is the number of blades"), "{}", ratio.hint());
    }

    #[test]
    fn tips_stay_below_mach_0_6() {
        // 0.6 · 343.2 m/s over π · 0.254 m
        let limit = RotorSpeed::from_rev_s(0.6 * 343.2 / (PI * 0.254));
        assert!(check_tips(0.254, RotorSpeed::from_rad_s(0.999 * limit.rad_s())).is_ok());
        assert!(check_tips(0.254, RotorSpeed::from_rad_s(1.001 * limit.rad_s())).is_err());
        let inches = check_tips(8.0, RotorSpeed::from_rev_s(10.0)).unwrap_err().hint();
        assert!(inches.contains("for 8 inches write 0.203"), "{inches}");
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
