//! Results, figures and sound → one HTML page that holds everything it needs. Pure: where the page goes is the caller's business.

mod sound;

pub use sound::{SoundClip, clip_from_source};
