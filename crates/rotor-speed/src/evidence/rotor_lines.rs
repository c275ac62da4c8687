//! Which lines a rotor makes: those of its shaft, and those of another series that turns with it.

use crate::tone::{ToneConfig, blades_of_tone};

/// Highest frequency that is heard, Hz: lines of small rotors are audible to their twelfth blade pass. *Decision.*
const HZ_MAX: f64 = 9000.0;
/// The same where a gear mesh is followed: three harmonics of the fastest. *Decision.*
const MESH_HZ_MAX: f64 = 20_000.0;

/// The lines of a rotor. At least one of the two series is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RotorLines {
    /// Blades of the propeller: its blade pass is at their multiples, with weaker lines at all whole orders. `None` where they are not known.
    pub(crate) blades: Option<u32>,
    /// Order of the gear mesh, or of another series that is followed; with lines at its multiples. `None` where the blades alone make lines.
    pub(crate) mesh_order: Option<f64>,
}

impl RotorLines {
    /// Those of a propeller without a gear.
    pub(crate) fn of_blades(blades: u32) -> Self {
        Self { blades: Some(blades), mesh_order: None }
    }

    /// Highest frequency at which its lines are heard.
    pub(crate) fn hz_max(&self) -> f64 {
        if self.mesh_order.is_some() { MESH_HZ_MAX } else { HZ_MAX }
    }

    /// Those of the tone that is followed, with the blades where they are known beside a gear.
    pub(crate) fn of_tone(tone: &ToneConfig) -> Self {
        match blades_of_tone(tone) {
            Some(blades) => Self::of_blades(blades),
            None => Self { blades: tone.blades, mesh_order: Some(tone.order.lines_per_turn()) },
        }
    }
}
