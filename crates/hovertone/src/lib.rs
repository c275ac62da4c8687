//! From the sound of a hovering multirotor to the speed of its rotors and its thrust constant.
//!
//! Pure: no files, clock, threads, environment or printing. Sound comes in through [`SignalSource`].

mod signal;

pub use signal::{Signal, SignalSource, SourceError};
