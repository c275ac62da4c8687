//! The sound of a multirotor's rotors at prescribed speeds, with the truth about those speeds at every instant.
//!
//! Settings go in, samples and truth come out, block by block: memory does not grow with the length. The flow, per
//! rotor, in the order of the modules:
//!
//! ```text
//! seed ─▶ wander ─▶ shaft (speed, phase, exact integrals) ─▶ tones ─┐
//!            profile ──┘                              └─▶ truth     ├─▶ hover (fixed gain) ─▶ samples
//!                                                          noise ───┘
//! ```
//!
//! This crate does not know the estimator (`hovertone`), so that recovering a simulated speed proves something. The
//! model is an optimistic one: no room, no distance, no microphone, and tones that stay in phase with their shaft.

mod hover;
mod noise;
pub mod paper;
mod profile;
mod seed;
mod shaft;
mod tones;
mod truth;
mod wander;

pub use hover::{HoverSettings, HoverSound, RotorSound};
pub use noise::NoiseSettings;
pub use profile::{ProfileParts, Span, SpeedProfile};
pub use tones::{BladePassTones, GearMeshTones, ToneSettings};
pub use truth::{RotorTruth, Truth, TruthRow};
