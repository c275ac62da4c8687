//! Scenarios: a flight and its microphones, described in a file, and the run of it.
//!
//! ```text
//! ScenarioFile (serde) ── resolve ──▶ Scenario ──▶ ScenarioRun ──▶ samples, one channel per microphone
//!        ▲ text of command tables        │            │ per step       and states, for the table of the truth
//!        └── handed in by the caller     └─ schedule  └──────────────▶ ScenarioTruth: exact means over the hovers
//! ```
//!
//! The caller reads and writes files. Memory does not grow with the length of the flight.

mod command_table;
mod controller_section;
mod doublets;
mod file;
mod jitter;
mod maneuver;
mod paper_trial;
mod random;
mod resolve;
mod run;
mod schedule;
mod sections;
#[cfg(test)]
mod tests;
mod truth;
mod truth_table;

pub use controller_section::{ControllerSection, GainsSection};
pub use doublets::DoubletAmounts;
pub use file::{FlightSection, PilotSection, ScenarioFile};
pub use hovertone_vehicle::Axis;
pub use maneuver::Maneuver;
pub use run::ScenarioRun;
pub use schedule::{Instruction, Schedule};
pub use sections::{
    AirSection, AmbientSection, AutomaticGainSection, GroundSection, GustSection, JitterSection, LayoutName,
    LineLevelsName, MicrophoneSection, MotorWanderSection, PayloadSection, PeopleSection, RoomSection, SampleFormat,
    SoundSection, SpreadSection, VehicleSection, WindSection,
};
pub use truth::{ScenarioTruth, SpanTruth};
pub use truth_table::{TRUTH_COLUMNS, truth_cells};

use crate::flight_settings::FlightSettings;
use crate::sound::SoundSettings;
use hovertone_vehicle::QuantityError;

/// A resolved scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// The flight model's settings.
    pub flight: FlightSettings,
    /// The sound's settings.
    pub sound: SoundSettings,
    /// The maneuvers in time.
    pub schedule: Schedule,
    /// Whether a pilot holds the place.
    pub holds_place: bool,
    /// Unsteadiness of the commands.
    pub jitter: Option<JitterSection>,
    /// Steps of the flight.
    pub step_count: u64,
    /// Steps between two rows of the truth.
    pub steps_per_row: u64,
    /// Format of the samples in a file.
    pub sample_format: SampleFormat,
}

impl Scenario {
    /// Length of the flight.
    pub fn duration_s(&self) -> f64 {
        self.step_count as f64 * self.flight.step_s
    }
}

/// A fault of a scenario.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScenarioError {
    /// A preset that does not exist or has no flight parameters.
    #[error("there is no vehicle preset {name:?} with flight parameters")]
    UnknownPreset {
        /// The name in the file.
        name: String,
    },
    /// A missing value without a default.
    #[error("{what} is missing: {hint}")]
    Missing {
        /// What.
        what: String,
        /// Where to write it.
        hint: &'static str,
    },
    /// Settings that exclude each other.
    #[error("{what}: {hint}")]
    Contradiction {
        /// What.
        what: String,
        /// What to do.
        hint: &'static str,
    },
    /// A fault in a table of commands.
    #[error("{file}, line {line}: {what}")]
    CommandTable {
        /// Name of the table as written.
        file: String,
        /// Line, counted from 1.
        line: usize,
        /// What is wrong with it.
        what: String,
    },
    /// A number of the flight or of the sound.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
}

impl ScenarioError {
    fn out_of_range(name: &'static str, value: f64, must_be: &'static str) -> Self {
        QuantityError { name, value, must_be }.into()
    }
}
