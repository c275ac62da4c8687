//! Tone families: which shaft speed explains the lines, and the band of each harmonic.

mod band;
mod comb;

pub use band::Band;
pub(crate) use band::{bands_around, lines_around, search_range_rev_s};
pub(crate) use comb::CombMap;

/// An order up to this is a number of blades; above, a number of teeth.
const BLADES_MAX: f64 = 12.0;
