//! Tone families: which shaft speed explains the lines, and the band of each harmonic.

mod band;
mod band_choice;
mod comb;
mod discovery_config;
mod family;
mod levels;
mod reading;
mod series;
mod settings;
mod skirts;

pub use band::lines_between_speeds;
pub(crate) use band::{bands_around, lines_around, search_range_rev_s};
pub(crate) use band_choice::{bands_worth_following, lines_worth_hearing};
pub(crate) use comb::CombMap;
pub use discovery_config::DiscoveryConfig;
pub(crate) use family::families_from_surveys;
pub(crate) use reading::{BLADES, normalise, reading_at, rule_out};
pub(crate) use settings::blades_of_tone;
pub use settings::{ToneConfig, blades_known};
