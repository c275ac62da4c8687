//! What a multirotor is, and the quantities of its rotors.
//!
//! Nothing here knows of sound. The estimator (`hovertone`) and the simulator (`hovertone-sim`) both build on this
//! crate and on nothing else of each other, so that recovering a simulated flight proves something.

mod estimate;
mod flight;
mod frame;
mod presets;
mod speed;
mod vehicle;

pub use estimate::{Ending, Estimate};
pub use flight::{
    BatteryParameters, ControllerParameters, FlightParameters, Layout, LoopGains, MotorParameters, RotorParameters,
    find_flight_parameters, flight_presets,
};
pub use frame::RotorPlace;
pub use presets::{find_preset, presets};
pub use speed::{Gear, Order, QuantityError, RotorSpeed};
pub use vehicle::{ShaftSpeedRange, Sourced, Vehicle};
