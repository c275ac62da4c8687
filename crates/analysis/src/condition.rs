//! Lines of a rotor's shaft relative to its blade pass.

use serde::Serialize;

/// One line of a rotor's shaft.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShaftLine {
    /// Lines per turn: 1 for imbalance, the blades for the blade pass.
    pub order: u32,
    /// Level over the level of the blade pass; absent where the line is inaudible, or not separated from a line of another rotor.
    pub level_db: Option<f64>,
    /// Standard uncertainty of the level, from noise and from the scatter over the blocks.
    pub std_uncertainty_db: Option<f64>,
    /// Level of the noise at this order, which bounds the level of an inaudible line. Absent where the line is not separated from a line
    /// of another rotor.
    pub noise_db: Option<f64>,
}

/// Audible condition of a rotor. Blades that differ in weight, pitch or shape cause lines at all multiples of the shaft speed, not only
/// at the multiples of the blade pass; a bent shaft does the same. Microphone, room and the position of the rotor change levels by some
/// decibels, and small recorders hear little below 100 Hz. So compare rotors with each other, or a rotor with itself at another time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotorCondition {
    /// Number of blades of the propeller, as known beforehand.
    pub blades: u32,
    /// All lines up to the fourth harmonic of the blade pass.
    pub lines: Vec<ShaftLine>,
    /// Numbers of the harmonics of the blade pass, counted from 1, that most rotors have and this one has not.
    pub missing_harmonics: Vec<u32>,
}

impl RotorCondition {
    /// Level of the shaft line (order 1) over the level of the blade pass. Imbalance raises it.
    pub fn shaft_over_blade_pass_db(&self) -> Option<f64> {
        self.line(1)?.level_db
    }

    /// The loudest line between the harmonics of the blade pass, without the shaft line itself. Differences between the blades raise it.
    pub fn loudest_between(&self) -> Option<&ShaftLine> {
        let is_between = |line: &&ShaftLine| line.order > 1 && !line.order.is_multiple_of(self.blades);
        let heard = self.lines.iter().filter(is_between).filter(|line| line.level_db.is_some());
        heard.max_by(|a, b| a.level_db.unwrap_or(f64::MIN).total_cmp(&b.level_db.unwrap_or(f64::MIN)))
    }

    /// The line of an order.
    pub fn line(&self, order: u32) -> Option<&ShaftLine> {
        self.lines.iter().find(|line| line.order == order)
    }
}
