//! Tone families: which shaft speed explains the lines, and the band of each harmonic.

mod band;
mod band_choice;
mod comb;
mod foreign_series;
mod mains_hum;

pub use band::Band;
pub(crate) use band::{bands_around, search_range_rev_s};
pub(crate) use band_choice::bands_worth_following;
pub(crate) use comb::CombMap;
pub(crate) use foreign_series::foreign_series;
pub(crate) use mains_hum::{MainsHum, mains_hum};
