//! From the sound of a hovering multirotor to the speed of its rotors.
//!
//! `pipeline` is the whole chain on one screen; `stages` holds its stages, each one function from one typed value to the next; the
//! algorithms stand in the folders below them.
//!
//! Pure: no files, clock, threads, environment or printing. Sound comes in through [`hovertone_signal::SignalSource`].

mod config;
mod detection;
mod discovery;
mod error;
mod evidence;
mod exam;
mod harmonic;
mod hover;
mod pipeline;
mod quick_track;
mod ridge;
mod rotors;
mod speed;
mod stages;
mod survey;
mod thresholds;
mod tone;

pub use config::Config;
pub use discovery::{Discovery, FoundSpeed, tones_from_passes, tones_from_source};
pub use error::Error;
pub use evidence::{EvidenceConfig, LinesNear, NoiseLevel, OrderLevel};
pub use exam::{ComparedSpeed, EvidenceNear, evidence_near};
pub use hover::{HoverConfig, HoverPart};
pub use pipeline::{
    HoverRotors, better_rotor_from_passes, passes_of_speed, rotors_from_survey, speed_from_passes, speed_from_source,
    speed_from_survey, survey_from_passes,
};
pub use quick_track::{
    PASSES_OF_QUICK_TRACK, PathWindow, QuickStretch, QuickTrack, SpeedPath, TurnFrame, TurnFrames,
    held_spans_from_passes, quick_track_along, quick_track_from_passes, turn_frames_from_passes,
};
pub use ridge::{RidgeConfig, SpectrogramConfig};
pub use rotors::RotorsConfig;
pub use speed::{BudgetConfig, SampleConfig};
pub use stages::Surveyed;
pub use survey::SpanConfig;
pub use tone::{DiscoveryConfig, ToneConfig, blades_known, lines_between_speeds};
