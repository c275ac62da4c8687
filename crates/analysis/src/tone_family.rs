//! Tone families of a recording, and the shaft speeds that each can belong to.

use crate::Span;
use hovertone_vehicle::{Gear, Order, RotorSpeed};
use serde::Serialize;
use std::fmt;

/// Largest relative difference between the speeds of rotors of one vehicle. Measured flights have up to 22 %. *Physics.*
const SAME_VEHICLE_SHARE: f64 = 0.25;
/// Meshes of the rotors of one vehicle lie this near a multiple of the mean of all. *Decision.*
const SAME_MESH_SHARE: f64 = 0.04;

/// A line of a family.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SeenHarmonic {
    /// Number of the harmonic: 1 for the fundamental.
    pub number: u32,
    /// Frequency.
    pub hz: f64,
    /// Mean level over the noise floor while the family is present.
    pub level_db: f64,
}

/// A series of lines at multiples of one frequency that sound at the same time.
#[derive(Clone, Debug, Serialize)]
pub struct ToneFamily {
    /// Fundamental frequency, the median over time.
    pub fundamental_hz: f64,
    /// Standard deviation of the fundamental over time.
    pub spread_hz: Option<f64>,
    /// The lines above the noise floor.
    pub harmonics: Vec<SeenHarmonic>,
    /// Level of its strongest line over the noise floor.
    pub level_db: f64,
    /// Share of the recording in which the family is present.
    pub time_share: f64,
    /// From its first to its last presence, including gaps.
    #[serde(flatten)]
    pub span: Span,
    /// Its possible readings, most plausible first; excluded readings have the plausibility 0.
    pub readings: Vec<Reading>,
    /// Whether one shaft speed has nearly all of the plausibility.
    pub is_settled: bool,
    /// A doubt that it belongs to a rotor.
    pub remark: Option<Remark>,
}

/// A doubt that a family belongs to a rotor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Remark {
    /// Its fundamental is the mains frequency.
    NearMains,
    /// It sounds for a small part of the time only, like a beep or a call.
    Brief,
    /// It has a single line.
    SingleLine,
    /// It is the gear mesh of the rotors that are heard.
    GearMesh,
}

impl Remark {
    /// Description for people.
    pub fn text(self) -> &'static str {
        match self {
            Self::NearMains => "mains hum (?)",
            Self::Brief => "short tone (perhaps a beep or a voice)",
            Self::SingleLine => "single line",
            Self::GearMesh => "tone of the rotors' gear",
        }
    }
}

impl ToneFamily {
    /// Whether two families are so close in frequency that they can be two rotors of one vehicle, or one rotor that drifted.
    pub fn is_near(&self, other: &Self) -> bool {
        let tone_hz = |family: &Self| family.readings.first().map_or(family.fundamental_hz, |reading| reading.tone_hz);
        let pairs = [(self.fundamental_hz, other.fundamental_hz), (tone_hz(self), tone_hz(other))];
        pairs.into_iter().any(|(a, b)| (a / b - 1.0).abs() < SAME_VEHICLE_SHARE)
    }

    /// The frequency of the gear mesh of the rotors of another family, or of its harmonic, if this family is that. The speed of these rotors tells
    /// it better than the lines of the mesh, which lie apart. Only where the gear is known.
    pub fn gear_mesh_hz_of(&self, rotor: &Self) -> Option<f64> {
        let reading = rotor.readings.first()?;
        let mesh_hz = f64::from(reading.meaning.gear()?.wheel) * reading.speed.rev_s();
        let ratio = self.fundamental_hz / mesh_hz;
        let is_mesh = ratio > 0.5 && (ratio / ratio.round() - 1.0).abs() < SAME_MESH_SHARE;
        is_mesh.then(|| ratio.round() * mesh_hz)
    }
}

/// Source of the tone of a reading.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Meaning {
    /// The tone is a blade pass.
    BladePass {
        /// Blades of the propeller.
        blades: u32,
    },
    /// The tone is the mesh of a known gear; a propeller turns behind it.
    BladePassAndMesh {
        /// Blades of the propeller.
        blades: u32,
        /// The gear.
        gear: Gear,
    },
    /// The tone has the order that is given.
    GivenOrder,
}

impl Meaning {
    /// Blades of the propeller, where the reading contains them.
    pub fn blades(&self) -> Option<u32> {
        match *self {
            Self::BladePass { blades } | Self::BladePassAndMesh { blades, .. } => Some(blades),
            Self::GivenOrder => None,
        }
    }

    /// The gear between motor and rotor, if there is one.
    pub fn gear(&self) -> Option<Gear> {
        match *self {
            Self::BladePassAndMesh { gear, .. } => Some(gear),
            Self::BladePass { .. } | Self::GivenOrder => None,
        }
    }
}

impl fmt::Display for Meaning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BladePass { blades } => write!(f, "{blades} blades"),
            Self::BladePassAndMesh { blades, gear } => {
                write!(f, "{blades} blades, gear {}:{}", gear.pinion, gear.wheel)
            }
            Self::GivenOrder => f.write_str("as given"),
        }
    }
}

/// One possible reading of a family.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reading {
    /// Order of the tone.
    pub order: Order,
    /// Frequency of the tone; the shaft speed is `tone_hz / order`.
    pub tone_hz: f64,
    /// Source of the tone.
    pub meaning: Meaning,
    /// Shaft speed.
    #[serde(rename = "speed_rad_s")]
    pub speed: RotorSpeed,
    /// Speed of the motor: the speed of the rotor times the gear ratio.
    #[serde(rename = "motor_speed_rad_s")]
    pub motor_speed: RotorSpeed,
    /// Speed of the blade tips over the speed of sound, where the diameter is known.
    pub tip_mach: Option<f64>,
    /// C_T = F/(ρ n² D⁴) of a hover (propeller convention), where diameter, mass and rotors are known.
    pub thrust_coefficient: Option<f64>,
    /// Plausibility from 0 to 1. The readings of a family sum to 1, or to less where only rare ones are left. 0 for excluded readings.
    pub plausibility: f64,
    /// Reasons for or against the reading.
    pub why: String,
}
