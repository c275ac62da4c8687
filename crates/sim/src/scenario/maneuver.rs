//! What is flown, one maneuver after the other.

use serde::{Deserialize, Serialize};

/// A piece of the flight. While one axis is driven by a maneuver, the pilot keeps flying the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Maneuver {
    /// Stay where it is. The truth's means are over these.
    Hover {
        /// How long.
        duration_s: f64,
    },
    /// One command goes to a value, stays there, and goes back.
    Step {
        /// Which command.
        axis: Axis,
        /// How much, of ±1.
        amount: f64,
        /// How long.
        duration_s: f64,
    },
    /// One command goes one way and then as much the other way.
    Doublet {
        /// Which command.
        axis: Axis,
        /// How much, of ±1.
        amount: f64,
        /// How long each half lasts.
        half_s: f64,
        /// How often.
        #[serde(default = "once")]
        repeat: u32,
        /// Rest after each.
        #[serde(default)]
        pause_s: f64,
    },
    /// Up, or down, at a steady rate.
    Climb {
        /// By how much; below 0 down.
        height_m: f64,
        /// How long.
        duration_s: f64,
    },
    /// Around a square, back to where it was: ahead, left, back, right, the nose where it was.
    Square {
        /// Length of a side.
        side_m: f64,
        /// Time for each.
        side_s: f64,
    },
    /// Straight to a place.
    FlyTo {
        /// Where.
        position_m: [f64; 3],
        /// Where the nose points then; as before where absent.
        #[serde(default)]
        yaw_deg: Option<f64>,
        /// How long.
        duration_s: f64,
    },
    /// Motors on, and up.
    TakeOff {
        /// How high, of the centre of mass.
        height_m: f64,
        /// How long.
        duration_s: f64,
    },
    /// Down to the ground, and motors off at the end.
    Land {
        /// How long.
        duration_s: f64,
    },
    /// Commands from a table: CSV with a column `time_s`, counted from the maneuver's start, and one or more of `roll`,
    /// `pitch`, `yaw_rate`, `climb`, of ±1. A row holds until the next. The pilot flies the axes that have no column.
    Csv {
        /// Where the table is.
        file: String,
        /// How long; to the last row where absent.
        #[serde(default)]
        duration_s: Option<f64>,
    },
}

/// One of the four commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// Leans right.
    Roll,
    /// Leans forward.
    Pitch,
    /// Turns left.
    YawRate,
    /// Up.
    Climb,
}

impl Axis {
    /// All, in the order of [`Command::to_array`](crate::control::Command::to_array).
    pub const ALL: [Self; 4] = [Self::Roll, Self::Pitch, Self::YawRate, Self::Climb];

    /// Name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Roll => "roll",
            Self::Pitch => "pitch",
            Self::YawRate => "yaw_rate",
            Self::Climb => "climb",
        }
    }
}

fn once() -> u32 {
    1
}
