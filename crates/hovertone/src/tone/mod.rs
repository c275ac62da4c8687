//! Tone families: which shaft speed explains the lines, and the band of each harmonic.

mod band;
mod comb;
mod family;
mod levels;
mod mesh;
mod pattern;
mod profile;
mod reading;
mod series;

pub use band::Band;
pub(crate) use band::{bands_around, search_range_rev_s};
pub(crate) use comb::CombMap;
pub(crate) use family::families_from_surveys;
pub use family::{Remark, SeenHarmonic, ToneFamily};
pub use reading::{Meaning, Reading};
