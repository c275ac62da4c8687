//! The scenario file as written. Data only; [`ScenarioFile::resolve`] interprets it.
//!
//! Every key is optional; the defaults are the paper's flight in a free field. The presence of a section switches its
//! effect on. Unknown keys are refused.

use super::controller_section::ControllerSection;
use super::maneuver::Maneuver;
use super::sections::{
    AirSection, AmbientSection, GroundSection, GustSection, JitterSection, MicrophoneSection, MotorWanderSection,
    PayloadSection, PeopleSection, RoomSection, SoundSection, SpreadSection, VehicleSection, WindSection,
};
use serde::{Deserialize, Serialize};

/// A flight and its microphones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ScenarioFile {
    /// Length of the flight. Absent: the length of the maneuvers, or 10 s of hover without maneuvers. Longer than the
    /// maneuvers: the vehicle hovers after them. Shorter: the maneuvers are cut.
    pub duration_s: Option<f64>,
    /// All random numbers come from this seed: gusts, jitter, spread, levels and phases of lines, noise.
    pub seed: u64,
    /// Rows of `truth.csv` per second; a whole number of steps must lie between two.
    pub truth_rate_hz: f64,
    /// The vehicle.
    pub vehicle: VehicleSection,
    /// The embedded controller, where it differs from the preset's.
    pub controller: Option<ControllerSection>,
    /// Masses on the vehicle.
    #[serde(rename = "payload")]
    pub payloads: Vec<PayloadSection>,
    /// Computation, beginning and effects of the flight.
    pub flight: FlightSection,
    /// The pilot.
    pub pilot: PilotSection,
    /// The maneuvers, one after the other.
    #[serde(rename = "maneuver")]
    pub maneuvers: Vec<Maneuver>,
    /// Differences among rotors and motors; all alike if absent.
    pub spread: Option<SpreadSection>,
    /// Unsteadiness of each motor, independent for each; none if absent.
    pub motor_wander: Option<MotorWanderSection>,
    /// The air; if absent, the air in which the vehicle's constants were measured, and 20 °C for the speed of sound.
    pub air: Option<AirSection>,
    /// Steady wind; none if absent.
    pub wind: Option<WindSection>,
    /// Dryden gusts; none if absent.
    pub gusts: Option<GustSection>,
    /// Format of the recording and strength of the sources.
    pub sound: SoundSection,
    /// A room, for the reflections; if absent, `ground` or a free field.
    pub room: Option<RoomSection>,
    /// A level ground that reflects; not together with a room.
    pub ground: Option<GroundSection>,
    /// Noise of the place; none if absent.
    pub ambient: Option<AmbientSection>,
    /// People talking outside; none if absent.
    pub people: Option<PeopleSection>,
    /// The microphones, one channel each; if absent, one microphone 2 m above the floor by the wall, as in the paper's figure 1.
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
            controller: None,
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
    /// Names, as written, of the command tables whose text [`resolve`](Self::resolve) needs.
    pub fn command_files(&self) -> impl Iterator<Item = &str> {
        self.maneuvers.iter().filter_map(|maneuver| match maneuver {
            Maneuver::Csv { file, .. } => Some(file.as_str()),
            _ => None,
        })
    }
}

/// Computation, beginning and effects of the flight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FlightSection {
    /// Gravity.
    pub gravity_m_s2: f64,
    /// Step of the integration and of the states for the sound.
    pub step_s: f64,
    /// First position of the centre of mass; on the ground only x and y count.
    pub start_position_m: [f64; 3],
    /// First heading of the nose, from the world's x to the left.
    pub start_yaw_deg: f64,
    /// Whether the flight begins on the ground with motors off; otherwise it begins in trimmed hover.
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

/// The pilot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PilotSection {
    /// Whether the pilot holds place, height and heading. Otherwise the commands come from the maneuvers alone, and no
    /// command means the embedded controller's hover.
    pub holds_place: bool,
    /// Unsteadiness that is added to all commands.
    pub jitter: Option<JitterSection>,
}

impl Default for PilotSection {
    fn default() -> Self {
        Self { holds_place: true, jitter: None }
    }
}
