//! Spectra of a step along its curve → time constant and start, in a room.
//!
//! A microphone hears a rotor as it is now, by the direct way, and as it was a little earlier, by the walls. Echoes have random phases, so that
//! powers add: `P(x, t) = Σ A ∫ q(v) K(x − order · ω(t − v)/ω_path(t)) dv + noise`, with the echogram q(v), power over the delay v. A tail that is
//! as loud as the direct sound shifts no line, then: it is a second one.

mod beliefs;
mod evaluation;
mod expected;
mod fit;
mod kernel;
mod parameters;
mod spectra;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;

pub use beliefs::{PlaceBelief, PlaceValue, any_place, place_of};
pub use fit::{RoomRequest, RoomStep, step_in_room};
pub use parameters::RoomCurve;
pub use spectra::{PLACES, StepSpectra, TurnFrame};
