//! A rotor that something known leaves out.

use serde::Serialize;

/// A rotor with other blades or at another speed than what is known allows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OtherRotor {
    /// Blades of its propeller.
    pub blades: u32,
    /// Its shaft speed.
    pub speed_rev_s: f64,
}
