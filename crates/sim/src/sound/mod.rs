//! The sound of a flight at microphones: speeds, places and axes of the rotors are given at the control rate.
//!
//! ```text
//! SoundState, every ms or so ─▶ source (one per rotor): lines + broadband ─▶ interpolator ─┐
//!        │                                    └─ share for the diffuse field ─▶ reverberation ─┐
//!        └─▶ path (rotor × wall image × microphone): delay, 1/distance, directivity ──────────┤
//!                                                       babble, ambient noise (noise colour) ─┴▶ microphone ─▶ samples
//! ```
//!
//! Pressures are in pascal until the microphone; levels are dB re 20 µPa at 1 m. The radiated sound of
//! each rotor is made once, at the sample rate; every path reads it with a delay and a gain of its own. A path works from
//! the time of emission: the sound of one control step arrives at a microphone in an interval that the motion makes longer
//! or shorter. So delay and Doppler shift are exact for the retarded time, without solving for it.
//!
//! Not modelled: absorption in air (by ISO 9613-1, at 20 °C and 50 % humidity, 0.03 dB per metre at 4 kHz, 0.11 at
//! 8 kHz, 0.36 at 16 kHz), walls that absorb high and low notes differently, reflections of second and higher order one
//! by one (the exponential tail stands for them, without Doppler shift), shielding by the vehicle, gusts in the
//! noise of the wind over the microphone, and interaction between rotors.

mod automatic_gain;
mod babble;
mod biquad;
mod directivity;
mod drawn_lines;
mod flight_sound;
mod interpolator;
mod level;
mod line_scatter;
mod lines;
mod microphone;
mod noise_colour;
mod noise_slope;
mod path;
mod phasors;
mod reverberation;
mod room;
mod settings;
mod source;
mod state;
mod tone_settings;

pub use automatic_gain::AutomaticGain;
pub use babble::BabbleSettings;
pub use directivity::Directivity;
pub use flight_sound::FlightSound;
pub use line_scatter::{ClassScatter, LineScatter};
pub use microphone::MicrophoneSettings;
pub use room::{Room, Surroundings, WallAbsorption};
pub use settings::{AmbientSettings, BroadbandSettings, MotorTones, SoundSettings, SourceSettings};
pub use state::{RotorState, SoundState};
pub use tone_settings::{BladePassTones, GearMeshTones, ToneSettings};

pub(crate) use line_scatter::LineClass;
pub(crate) use noise_slope::SlopeFilterRoots;
