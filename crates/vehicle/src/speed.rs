//! Shaft speed and order. They are types, because shaft speed and tone frequency as plain numbers of hertz are easily mixed up.

use crate::number::number_in_words;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::fmt;

/// A quantity out of range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name} = {}, but it must be {must_be}", number_in_words(*value))]
pub struct QuantityError {
    /// Name of the quantity, as in files and flags.
    pub name: &'static str,
    /// The given value.
    pub value: f64,
    /// Allowed values.
    pub must_be: &'static str,
}

/// Order of a tone, in lines per turn of the rotor's shaft: 2 for the blade pass of a two-bladed propeller, 69 for the gear mesh of a
/// 69-tooth wheel on the shaft. A tone at `f` Hz belongs to a shaft with `f / order` turns per second.
///
/// n·r in eq 6 of the paper is this number: 8 pinion teeth times the ratio 8.625 give 69.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(try_from = "f64", into = "f64")]
pub struct Order(f64);

impl Order {
    /// An order from the lines per turn. It need not be whole: the shaft of a geared motor turns 8.625 times per turn of the rotor.
    ///
    /// # Errors
    /// A number that is not positive or not finite.
    pub fn new(lines_per_turn: f64) -> Result<Self, QuantityError> {
        if lines_per_turn.is_finite() && lines_per_turn > 0.0 {
            Ok(Self(lines_per_turn))
        } else {
            Err(QuantityError { name: "order", value: lines_per_turn, must_be: "a number above 0" })
        }
    }

    /// Order of the blade pass: the number of blades.
    ///
    /// # Errors
    /// No blades.
    pub fn from_blades(blade_count: u32) -> Result<Self, QuantityError> {
        Self::new(f64::from(blade_count)).map_err(|error| QuantityError { name: "blades", ..error })
    }

    /// Lines per turn of the shaft.
    pub fn lines_per_turn(self) -> f64 {
        self.0
    }

    /// Order of the `number`-th harmonic of this tone; the first harmonic is the tone itself.
    pub fn harmonic(self, number: u32) -> Self {
        Self(self.0 * f64::from(number))
    }
}

impl TryFrom<f64> for Order {
    type Error = QuantityError;
    fn try_from(lines_per_turn: f64) -> Result<Self, QuantityError> {
        Self::new(lines_per_turn)
    }
}

impl From<Order> for f64 {
    fn from(order: Order) -> f64 {
        order.0
    }
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// A gear between motor and rotor, with the pinion on the motor and the wheel on the rotor's shaft.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gear {
    /// Teeth of the motor's pinion.
    pub pinion: u32,
    /// Teeth of the wheel on the rotor's shaft.
    pub wheel: u32,
}

impl Gear {
    /// Motor turns per rotor turn.
    pub fn ratio(self) -> f64 {
        f64::from(self.wheel) / f64::from(self.pinion)
    }

    /// Order of the mesh tone: each tooth of the wheel meets the pinion once per turn of the rotor.
    ///
    /// # Errors
    /// A wheel without teeth.
    pub fn mesh_order(self) -> Result<Order, QuantityError> {
        Order::new(f64::from(self.wheel)).map_err(|error| QuantityError { name: "gear wheel", ..error })
    }
}

/// Speed of a rotor's shaft, in rad/s. It is not the frequency of a tone.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct RotorSpeed {
    rad_s: f64,
}

impl RotorSpeed {
    /// From radians per second.
    pub fn from_rad_s(rad_s: f64) -> Self {
        Self { rad_s }
    }

    /// From turns per second.
    pub fn from_rev_s(rev_s: f64) -> Self {
        Self { rad_s: TAU * rev_s }
    }

    /// From turns per minute.
    pub fn from_rpm(rpm: f64) -> Self {
        Self::from_rev_s(rpm / 60.0)
    }

    /// From the frequency of a tone of known order: eq 6 of the paper, N = 60 ζ / order in rpm.
    pub fn from_tone_hz(tone_hz: f64, order: Order) -> Self {
        Self::from_rev_s(tone_hz / order.lines_per_turn())
    }

    /// Radians per second.
    pub fn rad_s(self) -> f64 {
        self.rad_s
    }

    /// Turns per second.
    pub fn rev_s(self) -> f64 {
        self.rad_s / TAU
    }

    /// Turns per minute.
    pub fn rpm(self) -> f64 {
        60.0 * self.rev_s()
    }

    /// Frequency of the tone with the given order.
    pub fn tone_hz(self, order: Order) -> f64 {
        self.rev_s() * order.lines_per_turn()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_tone_is_the_gear_mesh_of_its_printed_speed() {
        let order = Gear { pinion: 8, wheel: 69 }.mesh_order().unwrap();
        let speed = RotorSpeed::from_rpm(3610.3438);
        assert!((speed.tone_hz(order) - 4151.895).abs() < 5e-4);
        assert!((speed.rad_s() - 378.0743).abs() < 5e-5);
        assert!((RotorSpeed::from_tone_hz(speed.tone_hz(order), order).rpm() - 3610.3438).abs() < 1e-9);
        assert_eq!(Gear { pinion: 8, wheel: 69 }.ratio(), 8.625);
    }

    #[test]
    fn an_order_must_be_a_positive_number() {
        for lines_per_turn in [0.0, -2.0, f64::NAN, f64::INFINITY] {
            assert!(Order::new(lines_per_turn).is_err(), "{lines_per_turn}");
        }
        assert_eq!(Order::from_blades(0).unwrap_err().name, "blades");
        assert_eq!(Order::new(2.0).unwrap().harmonic(3).to_string(), "6");
    }
}
