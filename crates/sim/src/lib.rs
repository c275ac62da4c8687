//! The flight of a multirotor and the sound of its rotors, with the truth about their speeds at every instant.
//!
//! The flight is the paper's model (section 3, figure 2): commands in, one [`FlightState`] out per step, in the order of
//! the subsystems. Everything beyond the paper is in [`FlightSettings`], off by default.
//!
//! ```text
//! Pilot ─▶ Command ─▶ control (eq 1) ─▶ motor (eq 2) ─▶ rotor (eqs 3, 4) ─▶ forces ─▶ body ─▶ FlightState
//!   ▲                 ▲ v_o from trim     ▲ battery       ▲ air, ground       ▲ gyroscopic  ▲ wind, contact    │
//!   └─────────────────┴────────────────────────────────────────────────────────────────────────────────────────┘
//! ```
//!
//! The sound of a flight at microphones: [`SoundState`]s in, samples out ([`FlightSound`]), with distance, Doppler shift,
//! directivity, a room, people talking outside, and the microphone.
//!
//! ```text
//! SoundState ─▶ source per rotor (lines, broadband) ─▶ path per rotor, wall and microphone ─▶ microphone ─▶ samples
//! ```
//!
//! A [`scenario`] file describes a flight and its sound, and runs them.
//!
//! The module [`prescribed`] makes the sound of rotors whose speeds are given instead of flown, for tests and benches.
//!
//! This crate does not use the estimator (`hovertone`), so recovering a simulated speed is evidence.

mod airframe;
pub mod body;
pub mod control;
pub mod environment;
mod flight;
mod flight_settings;
pub mod forces;
pub mod motor;
mod ornstein_uhlenbeck;
pub mod paper;
pub mod prescribed;
mod rk4;
pub mod rotor;
pub mod scenario;
mod seed;
mod sound;
mod trim;

pub use airframe::Airframe;
pub use flight::{Flight, FlightState, PilotedFlight};
pub use flight_settings::{FlightSettings, MotorWander, Payload, Spread, Start};
pub use prescribed::{
    HoverSettings, HoverSound, NoiseSettings, ProfileParts, RotorSound, RotorTruth, Span, SpeedProfile, Truth, TruthRow,
};
pub use rk4::rk4;
pub use sound::{
    AmbientSettings, AutomaticGain, BabbleSettings, BladePassTones, BroadbandSettings, ClassScatter, Directivity,
    FlightSound, GearMeshTones, LineScatter, MicrophoneSettings, MotorTones, Room, RotorState, SoundSettings,
    SoundState, SourceSettings, Surroundings, ToneSettings, WallAbsorption,
};
pub use trim::{HOVER_VOLTAGE, HoverTrim, hover_trim};
