//! The four loops of eq 1 of the paper.

use serde::{Deserialize, Serialize};

/// A loop of the embedded controller, and the command that it follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// Roll angle, rad; positive leans right.
    Roll,
    /// Pitch angle, rad; positive puts the nose down.
    Pitch,
    /// Yaw rate, rad/s; positive turns left.
    YawRate,
    /// Vertical rate, m/s; positive climbs.
    Climb,
}

impl Axis {
    /// All, in the order of the columns of the mixer.
    pub const ALL: [Self; 4] = [Self::Roll, Self::Pitch, Self::YawRate, Self::Climb];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Roll => "roll",
            Self::Pitch => "pitch",
            Self::YawRate => "yaw_rate",
            Self::Climb => "climb",
        }
    }

    /// Its name in sentences.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Roll => "roll",
            Self::Pitch => "pitch",
            Self::YawRate => "yaw",
            Self::Climb => "climb",
        }
    }

    /// Unit of its error.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Roll | Self::Pitch => "rad",
            Self::YawRate => "rad/s",
            Self::Climb => "m/s",
        }
    }
}
