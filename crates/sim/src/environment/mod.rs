//! What the flight meets: air, wind and the battery's state. All of it is beyond the paper and off unless it is set.

mod air;
mod battery;
mod wind;

pub use air::Air;
pub(crate) use battery::Battery;
pub use wind::{Gusts, Wind};
