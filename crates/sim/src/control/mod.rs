//! First subsystem, eq 1: from commands to voltages. The embedded controller is the paper's. The [`Pilot`], which
//! holds a place, is outside of it; in the paper this is a person or another computer.

mod controller;
mod mixer;
mod pilot;

pub use controller::{Command, Controller};
pub use mixer::mixer;
pub use pilot::{Pilot, PilotGains, Setpoint};
