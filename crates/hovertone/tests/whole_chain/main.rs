//! The whole chain on sound whose truth is known: what is heard, and what is not taken for a rotor.

// The lints know tests by their attribute, and what tests share has none.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod condition;
mod discovery;
mod exam;
mod geared_flights;
mod hover;
mod hover_of_flights;
mod known_vehicle;
mod labels;
mod microphones;
mod not_fooled;
mod passes;
mod rotors;
mod steady;
mod testkit;
mod wander;
