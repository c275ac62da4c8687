//! Tone families: which shaft speed explains the lines, and the band of each harmonic.

mod band;
mod band_choice;
mod comb;
mod foreign_series;
mod mains_hum;

pub use band::Band;
pub(crate) use band::{bands_around, lines_around, search_range_rev_s};
pub(crate) use band_choice::{bands_worth_following, lines_worth_hearing};
pub(crate) use comb::CombMap;
pub(crate) use foreign_series::foreign_series;
pub(crate) use mains_hum::{MainsHum, mains_hum};

/// An order up to this is a number of blades; above, a number of teeth.
const BLADES_MAX: f64 = 12.0;
