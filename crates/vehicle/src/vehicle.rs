//! A multirotor as far as its sound and its thrust constant need it.

use crate::{Gear, Order};
use serde::Serialize;

/// A number with the place it was read in.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sourced<T> {
    /// The number, in the unit that the field's name says.
    pub value: T,
    /// The document it stands in, and what is doubtful about it. Never empty.
    pub source: &'static str,
}

/// Shaft speeds that a rotor can have in flight: what an octave check may rule out, not a limit of anything.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShaftSpeedRange {
    /// Slowest, turns of the rotor's shaft per second.
    pub rev_s_low: f64,
    /// Fastest, turns of the rotor's shaft per second.
    pub rev_s_high: f64,
}

/// A multirotor. What no source was found for is absent: nothing here is a guess.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vehicle {
    /// Name in files and flags: lower case letters and digits.
    pub id: &'static str,
    /// Name for people.
    pub name: &'static str,
    /// Rotors that carry it.
    pub rotor_count: Sourced<u32>,
    /// Blades of each propeller.
    pub blade_count: Option<Sourced<u32>>,
    /// Gear between each motor and its rotor; absent for direct drive, and where nothing was found.
    pub gear: Option<Sourced<Gear>>,
    /// Tip-to-tip diameter of the propellers.
    pub propeller_diameter_m: Option<Sourced<f64>>,
    /// Mass as flown, with battery. A scale beats it.
    pub mass_kg: Option<Sourced<f64>>,
    /// Shaft speeds that are plausible in flight.
    pub shaft_speed: Option<Sourced<ShaftSpeedRange>>,
}

impl Vehicle {
    /// Order of the tone to listen to: the gear mesh of a geared rotor, else the blade pass. The mesh moves the most
    /// hertz for each change of speed (34.5 times the blade pass on the AR.Drone). `None` when neither is known.
    pub fn tone_order(&self) -> Option<Order> {
        self.gear_mesh_order().or_else(|| self.blade_pass_order())
    }

    /// Order of the gear-mesh tone of a geared rotor: the teeth of its wheel.
    pub fn gear_mesh_order(&self) -> Option<Order> {
        self.gear.and_then(|gear| gear.value.mesh_order().ok())
    }

    /// Order of the blade-pass tone: the blades of the propeller.
    pub fn blade_pass_order(&self) -> Option<Order> {
        self.blade_count.and_then(|blades| Order::from_blades(blades.value).ok())
    }
}
