//! The scenario file as it is written. Data only: what it means is [`ScenarioFile::resolve`]'s.
//!
//! Every key may be left out; the defaults are the paper's flight in a free field. A section that is there switches on
//! what it describes. Unknown keys are refused.

use super::maneuver::Maneuver;
use super::sections::{
    AirSection, AmbientSection, GroundSection, GustSection, JitterSection, MicrophoneSection, MotorWanderSection,
    PayloadSection, PeopleSection, RoomSection, SoundSection, SpreadSection, VehicleSection, WindSection,
};
use serde::{Deserialize, Serialize};

/// A flight, and what hears it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ScenarioFile {
    /// Length of the flight. Absent: that of the maneuvers, or 10 s of hover. Longer than the maneuvers: it hovers on.
    /// Shorter: it is cut.
    pub duration_s: Option<f64>,
    /// Everything random comes from here: gusts, jitter, drawn spread, levels and phases of lines, noise.
    pub seed: u64,
    /// Rows of `truth.csv` per second; a whole number of steps must lie between two.
    pub truth_rate_hz: f64,
    /// What flies.
    pub vehicle: VehicleSection,
    /// Masses on it.
    #[serde(rename = "payload")]
    pub payloads: Vec<PayloadSection>,
    /// How the flight is computed, how it begins, and which effects are on.
    pub flight: FlightSection,
    /// Who flies it.
    pub pilot: PilotSection,
    /// What it flies, one after the other.
    #[serde(rename = "maneuver")]
    pub maneuvers: Vec<Maneuver>,
    /// How rotors and motors differ; alike where absent.
    pub spread: Option<SpreadSection>,
    /// Unsteadiness of each motor for itself; none where absent.
    pub motor_wander: Option<MotorWanderSection>,
    /// The air; where absent, the one in which the vehicle's constants were found, and 20 °C for the speed of sound.
    pub air: Option<AirSection>,
    /// Steady wind; none where absent.
    pub wind: Option<WindSection>,
    /// Dryden gusts; none where absent.
    pub gusts: Option<GustSection>,
    /// Format of the recording and strength of the sources.
    pub sound: SoundSection,
    /// A room, for the reflections; where absent, `ground` or a free field.
    pub room: Option<RoomSection>,
    /// A level ground that reflects; not beside a room.
    pub ground: Option<GroundSection>,
    /// Noise of the place; none where absent.
    pub ambient: Option<AmbientSection>,
    /// People talking outside; none where absent.
    pub people: Option<PeopleSection>,
    /// The microphones, one channel each; where there is none, one 2 m up by the wall, as in the paper's figure 1.
    #[serde(rename = "microphone")]
    pub microphones: Vec<MicrophoneSection>,
}

impl Default for ScenarioFile {
    fn default() -> Self {
        Self {
            duration_s: None,
            seed: 1,
            truth_rate_hz: 100.0,
            vehicle: VehicleSection::default(),
            payloads: Vec::new(),
            flight: FlightSection::default(),
            pilot: PilotSection::default(),
            maneuvers: Vec::new(),
            spread: None,
            motor_wander: None,
            air: None,
            wind: None,
            gusts: None,
            sound: SoundSection::default(),
            room: None,
            ground: None,
            ambient: None,
            people: None,
            microphones: Vec::new(),
        }
    }
}

impl ScenarioFile {
    /// The names of the command tables that [`resolve`](Self::resolve) needs the text of, as they are written.
    pub fn command_files(&self) -> impl Iterator<Item = &str> {
        self.maneuvers.iter().filter_map(|maneuver| match maneuver {
            Maneuver::Csv { file, .. } => Some(file.as_str()),
            _ => None,
        })
    }
}

/// How the flight is computed and how it begins.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FlightSection {
    /// Gravity.
    pub gravity_m_s2: f64,
    /// Step of the integration, and of the states that the sound is made of.
    pub step_s: f64,
    /// Where it hovers first, of the centre of mass; on the ground, x and y count.
    pub start_position_m: [f64; 3],
    /// Where the nose points first, from the world's x to the left.
    pub start_yaw_deg: f64,
    /// Whether it stands on the ground with its motors off first; else it hovers, trimmed.
    pub starts_on_ground: bool,
    /// Whether the battery's voltage falls with charge and current.
    pub battery_sag: bool,
    /// Whether thrust grows near the ground.
    pub ground_effect: bool,
}

impl Default for FlightSection {
    fn default() -> Self {
        Self {
            gravity_m_s2: 9.806_65,
            step_s: 0.001,
            start_position_m: [0.0, 0.0, 1.0],
            start_yaw_deg: 0.0,
            starts_on_ground: false,
            battery_sag: false,
            ground_effect: false,
        }
    }
}

/// Who flies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PilotSection {
    /// Whether the pilot holds place, height and heading; else the commands are those of the maneuvers alone, over a
    /// hover with hands off.
    pub holds_place: bool,
    /// Unsteadiness on top of all commands.
    pub jitter: Option<JitterSection>,
}

impl Default for PilotSection {
    fn default() -> Self {
        Self { holds_place: true, jitter: None }
    }
}
