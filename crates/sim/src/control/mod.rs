//! First subsystem, eq 1: from commands to voltages. The embedded controller is the paper's; the [`Pilot`] that holds a
//! place stands outside it, where the paper has a person or another computer.

mod controller;
mod mixer;
mod pilot;

pub use controller::{Command, Controller};
pub use mixer::mixer;
pub use pilot::{Pilot, PilotGains, Setpoint};
