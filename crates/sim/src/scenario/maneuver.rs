//! The maneuvers of a flight.

use hovertone_vehicle::Axis;
use serde::{Deserialize, Serialize};

/// A part of the flight. While a maneuver drives one axis, the pilot flies the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Maneuver {
    /// Stays at its place. The truth's means are over these parts.
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
    /// Around a square and back to the start: ahead, left, back, right, with constant heading.
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
        /// Heading there; as before if absent.
        #[serde(default)]
        yaw_deg: Option<f64>,
        /// How long.
        duration_s: f64,
    },
    /// Motors on, then up.
    TakeOff {
        /// Height of the centre of mass at the end.
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
    /// `pitch`, `yaw_rate`, `climb`, of ±1. Each row holds until the next row. The pilot flies the axes without a column.
    Csv {
        /// Path of the table.
        file: String,
        /// How long; to the last row if absent.
        #[serde(default)]
        duration_s: Option<f64>,
    },
}

fn once() -> u32 {
    1
}
