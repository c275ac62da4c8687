//! Air, wind and the battery's state. All of it goes beyond the paper and is off by default.

mod air;
mod battery;
mod wind;

pub use air::Air;
pub(crate) use battery::Battery;
pub use wind::{Gusts, Wind};
