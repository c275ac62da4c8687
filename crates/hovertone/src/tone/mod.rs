//! Tone families: which shaft speed explains the lines, and the band of each harmonic.

mod band;
mod comb;

pub use band::Band;
pub(crate) use band::{bands_around, check_band};
pub(crate) use comb::CombMap;
