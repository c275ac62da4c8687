//! Tone families: which shaft speed explains the lines, and the band of each harmonic.

mod agreement;
mod band;
mod band_choice;
mod comb;
mod family;
mod foreign_series;
mod levels;
mod mains_hum;
mod mesh;
mod pattern;
mod profile;
mod reading;
mod series;

pub(crate) use agreement::families_agree;
pub use band::Band;
pub(crate) use band::{bands_around, lines_and_between, lines_around, lines_between_speeds, search_range_rev_s};
pub(crate) use band_choice::{bands_worth_following, lines_worth_hearing};
pub(crate) use comb::CombMap;
pub(crate) use family::families_from_surveys;
pub use family::{Remark, SeenHarmonic, ToneFamily};
pub(crate) use foreign_series::foreign_series;
pub(crate) use mains_hum::{MainsHum, mains_hum};
pub use reading::{Meaning, Reading};

/// An order up to this is a number of blades; above, a number of teeth.
pub(crate) const BLADES_MAX: f64 = 12.0;
/// Lines beside a gear mesh and its multiples, in turns of the shaft: one and two to either side.
pub(crate) const MESH_SIDEBANDS: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];
