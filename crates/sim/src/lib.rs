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
//! And the flight that moves them: the paper's model (section 3, figure 2), commands in, one [`FlightState`] out per
//! step, in the order of the subsystems. What goes beyond the paper is in [`FlightSettings`], off by default.
//!
//! ```text
//! Pilot ─▶ Command ─▶ control (eq 1) ─▶ motor (eq 2) ─▶ rotor (eqs 3, 4) ─▶ forces ─▶ body ─▶ FlightState
//!   ▲                 ▲ v_o from trim     ▲ battery       ▲ air, ground       ▲ gyroscopic  ▲ wind, contact    │
//!   └─────────────────┴────────────────────────────────────────────────────────────────────────────────────────┘
//! ```
//!
//! And what microphones hear of a flight: [`SoundState`]s in, samples out ([`FlightSound`]), with distance, Doppler shift,
//! directivity, a room, people talking outside, and the microphone.
//!
//! ```text
//! SoundState ─▶ source per rotor (lines, broadband) ─▶ path per rotor, wall and microphone ─▶ microphone ─▶ samples
//! ```
//!
//! A [`scenario`] file describes all of it, and runs it.
//!
//! This crate does not know the estimator (`hovertone`), so that recovering a simulated speed proves something.
//! [`HoverSound`]'s model is an optimistic one: no room, no distance, no microphone, and tones that stay in phase with
//! their shaft.

mod airframe;
pub mod body;
pub mod control;
pub mod environment;
mod flight;
mod flight_settings;
pub mod forces;
mod hover;
pub mod motor;
mod noise;
pub mod paper;
mod profile;
mod rk4;
pub mod rotor;
pub mod scenario;
mod seed;
mod shaft;
mod sound;
mod tones;
mod trim;
mod truth;
mod wander;

pub use airframe::Airframe;
pub use flight::{Flight, FlightState, PilotedFlight};
pub use flight_settings::{FlightSettings, MotorWander, Payload, Spread, Start};
pub use hover::{HoverSettings, HoverSound, RotorSound};
pub use noise::NoiseSettings;
pub use profile::{ProfileParts, Span, SpeedProfile};
pub use rk4::rk4;
pub use sound::{
    AmbientSettings, BabbleSettings, BroadbandSettings, Directivity, FlightSound, MicrophoneSettings, MotorTones, Room,
    RotorState, SoundSettings, SoundState, SourceSettings, Surroundings, WallAbsorption,
};
pub use tones::{BladePassTones, GearMeshTones, ToneSettings};
pub use trim::{HoverTrim, hover_trim};
pub use truth::{RotorTruth, Truth, TruthRow};
