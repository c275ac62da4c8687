//! Shaft speeds that were weighed against each other.

use hovertone_vehicle::RotorSpeed;
use serde::Serialize;

/// A shaft speed that explains lines of a recording, and how well.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WeighedSpeed {
    /// The shaft speed.
    #[serde(rename = "speed_rad_s")]
    pub speed: RotorSpeed,
    /// Its plausibility among all weighed speeds, by the levels of its lines.
    pub plausibility: f64,
}
