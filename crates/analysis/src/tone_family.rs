//! Tone families of a recording, and the shaft speeds that each can mean.

use crate::Span;
use hovertone_vehicle::{Gear, Order, RotorSpeed};
use serde::Serialize;
use std::fmt;

/// Rotors of one vehicle turn at speeds this near: 22 % apart at most in measured flights. *Physics.*
const SAME_VEHICLE_SHARE: f64 = 0.25;

/// A line of a family.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SeenHarmonic {
    /// Number: 1 for the fundamental.
    pub number: u32,
    /// Where it is.
    pub hz: f64,
    /// Mean level over the floor, over the time in which the family is present.
    pub level_db: f64,
}

/// A series of lines at multiples of one frequency, present together.
#[derive(Clone, Debug, Serialize)]
pub struct ToneFamily {
    /// Frequency that all its lines are multiples of, the median over time.
    pub fundamental_hz: f64,
    /// Standard deviation of that over time.
    pub spread_hz: Option<f64>,
    /// The lines that stand out of the floor.
    pub harmonics: Vec<SeenHarmonic>,
    /// Level of its strongest line over the floor.
    pub level_db: f64,
    /// Share of the recording in which it is present.
    pub time_share: f64,
    /// From when to when it is present, gaps included.
    #[serde(flatten)]
    pub span: Span,
    /// What it can mean, most plausible first; those ruled out have plausibility 0.
    pub readings: Vec<Reading>,
    /// Whether one shaft speed has nearly all belief.
    pub is_settled: bool,
    /// What may be said against a rotor.
    pub remark: Option<Remark>,
}

/// What may be said against a family being a rotor's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Remark {
    /// Its fundamental is that of the mains.
    NearMains,
    /// It sounds for a small part of the time only, as a beep or a call does.
    Brief,
    /// It has one line only.
    SingleLine,
}

impl Remark {
    /// In words.
    pub fn text(self) -> &'static str {
        match self {
            Self::NearMains => "mains hum?",
            Self::Brief => "brief: a beep or a call?",
            Self::SingleLine => "a single line",
        }
    }
}

impl ToneFamily {
    /// Whether another family is so near in frequency that both can be rotors of one vehicle, or one rotor that drifted.
    pub fn is_near(&self, other: &Self) -> bool {
        let tone_hz = |family: &Self| family.readings.first().map_or(family.fundamental_hz, |reading| reading.tone_hz);
        let pairs = [(self.fundamental_hz, other.fundamental_hz), (tone_hz(self), tone_hz(other))];
        pairs.into_iter().any(|(a, b)| (a / b - 1.0).abs() < SAME_VEHICLE_SHARE)
    }

    /// The readings that are worth a look, most plausible first.
    pub fn plausible_readings(&self, plausible_min: f64) -> Vec<&Reading> {
        self.readings.iter().filter(|reading| reading.plausibility >= plausible_min).collect()
    }
}

/// What makes the tone of a reading.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Meaning {
    /// The family is a blade pass; the number of blades is not heard.
    BladePass {
        /// Blades of the propeller.
        blades: u32,
    },
    /// The family has the lines of the shaft; every b-th, the blade pass, stands out.
    ShaftLines {
        /// Blades of the propeller.
        blades: u32,
        /// How far the blade pass stands over the lines between.
        contrast_db: f64,
    },
    /// The family is a blade pass, and the mesh of a known gear is heard at its order of the same shaft.
    BladePassAndMesh {
        /// Blades of the propeller.
        blades: u32,
        /// The gear.
        gear: Gear,
        /// Mean level of the mesh over the places beside it.
        mesh_db: f64,
    },
    /// The family itself is the mesh of a known gear.
    Mesh {
        /// The gear.
        gear: Gear,
    },
}

impl Meaning {
    /// Blades of the propeller, where the reading says something about them.
    pub fn blades(&self) -> Option<u32> {
        match *self {
            Self::BladePass { blades } | Self::ShaftLines { blades, .. } | Self::BladePassAndMesh { blades, .. } => {
                Some(blades)
            }
            Self::Mesh { .. } => None,
        }
    }

    /// The gear between motor and rotor, where there is one.
    pub fn gear(&self) -> Option<Gear> {
        match *self {
            Self::BladePassAndMesh { gear, .. } | Self::Mesh { gear } => Some(gear),
            Self::BladePass { .. } | Self::ShaftLines { .. } => None,
        }
    }
}

impl fmt::Display for Meaning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BladePass { blades } => write!(f, "{blades} blades"),
            Self::ShaftLines { blades, .. } => write!(f, "{blades} blades, shaft heard"),
            Self::BladePassAndMesh { blades, gear, .. } => {
                write!(f, "{blades} blades, gear {}:{}", gear.pinion, gear.wheel)
            }
            Self::Mesh { gear } => write!(f, "gear {}:{}", gear.pinion, gear.wheel),
        }
    }
}

/// One thing that a family can mean.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reading {
    /// Lines of the tone per turn of the shaft.
    pub order: Order,
    /// The tone: shaft speed = `tone_hz / order`.
    pub tone_hz: f64,
    /// What makes it.
    pub meaning: Meaning,
    /// Shaft speed.
    #[serde(rename = "speed_rad_s")]
    pub speed: RotorSpeed,
    /// Speed of the motor: the rotor's, or faster by the gear.
    #[serde(rename = "motor_speed_rad_s")]
    pub motor_speed: RotorSpeed,
    /// Speed of the blades' tips over that of sound, where the diameter is known.
    pub tip_mach: Option<f64>,
    /// C_T = T/(ρ n² D⁴) of a hover (propeller convention), where diameter, mass and rotors are known.
    pub thrust_coefficient: Option<f64>,
    /// Share of belief, 0 to 1; all readings of a family sum to 1 (to less where only rare ones are
    /// left). 0 for what is ruled out.
    pub plausibility: f64,
    /// What speaks for or against it.
    pub why: String,
}
