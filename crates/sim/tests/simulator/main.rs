//! The simulated flight and its sound against formulas, closed forms and another simulator.

// The lints know tests by their attribute, and what tests share has none.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod flight;
mod flight_sound_paths;
mod flight_sound_rig;
mod flight_sound_sources;
mod flight_sound_speed;
mod flight_speed;
mod flight_switches;
mod hover_sound;
mod prescribed_recording;
mod rotorpy_reference;
