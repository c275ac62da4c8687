//! The facts about a multirotor that its sound and its thrust constant depend on.

use crate::{Gear, Order};
use serde::Serialize;

/// A value with its source.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sourced<T> {
    /// The value, in the unit of the name of the field.
    pub value: T,
    /// The document with the value, and doubts about it. Never empty.
    pub source: &'static str,
}

/// Plausible shaft speeds in flight. They rule out octaves of a tone; they are no limit of the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShaftSpeedRange {
    /// Slowest, turns of the rotor's shaft per second.
    pub rev_s_low: f64,
    /// Fastest, turns of the rotor's shaft per second.
    pub rev_s_high: f64,
}

/// A multirotor. Numbers without a source are absent; none is a guess.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vehicle {
    /// Name in files and flags: lower case letters and digits; in the name of a user's vehicle also `-` and `_`.
    pub id: &'static str,
    /// Name for people.
    pub name: &'static str,
    /// Number of rotors.
    pub rotor_count: Sourced<u32>,
    /// Blades of each propeller.
    pub blade_count: Option<Sourced<u32>>,
    /// Gear between each motor and its rotor; absent for direct drive, and where no source was found.
    pub gear: Option<Sourced<Gear>>,
    /// Tip-to-tip diameter of the propellers.
    pub propeller_diameter_m: Option<Sourced<f64>>,
    /// Take-off mass with battery. A weighed mass is better.
    pub mass_kg: Option<Sourced<f64>>,
    /// Plausible shaft speeds in flight.
    pub shaft_speed: Option<Sourced<ShaftSpeedRange>>,
}

impl Vehicle {
    /// Order of the tone to follow: the gear mesh of a geared rotor, else the blade pass. A change of speed moves the mesh by more hertz
    /// (34.5 times the blade pass on the AR.Drone). `None` where neither is known.
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
