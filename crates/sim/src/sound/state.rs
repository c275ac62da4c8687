//! The state of the flight that the sound needs.

use super::settings::{Bound, checked};
use hovertone_vehicle::QuantityError;

/// One rotor at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotorState {
    /// Shaft speed of the rotor, rad/s, 0 or more for both senses of rotation.
    pub speed_rad_s: f64,
    /// The hub in the world, z up.
    pub position_m: [f64; 3],
    /// Direction of the thrust in the world; any length except 0.
    pub axis: [f64; 3],
}

/// All rotors at one instant. Between two states speeds, delays and gains are straight lines, so the turns of each rotor
/// are the trapezoidal sums of its speeds.
#[derive(Clone, Debug, PartialEq)]
pub struct SoundState {
    /// Seconds; the time of the first state is the time of the first sample.
    pub time_s: f64,
    /// The rotors, always in the same order.
    pub rotors: Vec<RotorState>,
}

impl SoundState {
    /// Checks the state by itself; returns it with axes of length 1.
    pub(crate) fn checked(&self) -> Result<Self, QuantityError> {
        checked("time_s", self.time_s, Bound::Finite)?;
        let mut state = self.clone();
        for rotor in &mut state.rotors {
            checked("speed_rad_s", rotor.speed_rad_s, Bound::ZeroOrMore)?;
            for value in rotor.position_m {
                checked("position_m", value, Bound::Finite)?;
            }
            let length = norm(rotor.axis);
            checked("length of the axis", length, Bound::Positive)?;
            rotor.axis = rotor.axis.map(|part| part / length);
        }
        Ok(state)
    }
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn norm(vector: [f64; 3]) -> f64 {
    dot(vector, vector).sqrt()
}

pub(crate) fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
