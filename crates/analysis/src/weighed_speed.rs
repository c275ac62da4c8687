//! Shaft speeds that were weighed against each other.

use hovertone_vehicle::RotorSpeed;
use serde::Serialize;

/// A shaft speed that explains lines of a recording, and how well.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WeighedSpeed {
    /// The shaft speed.
    #[serde(rename = "speed_rad_s")]
    pub speed: RotorSpeed,
    /// Its plausibility among all weighed speeds, by the levels of its lines. Absent where the levels have no model, as those of a gear mesh.
    pub plausibility: Option<f64>,
    /// Mean level of its lines over the floor, less that of the places where it can have none, dB. Absent where the plausibility decides.
    pub lines_db: Option<f64>,
}
