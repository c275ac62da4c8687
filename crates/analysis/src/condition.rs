//! The lines of a rotor's shaft against its blade pass.

use serde::Serialize;

/// One line of a rotor's shaft.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShaftLine {
    /// Lines per turn: 1 for imbalance, the blades for the blade pass.
    pub order: u32,
    /// Level over that of the rotor's blade pass; absent where it is not heard, or not apart from another rotor's.
    pub level_db: Option<f64>,
    /// Standard uncertainty of that, from noise and scatter over the blocks.
    pub std_uncertainty_db: Option<f64>,
    /// Level that noise has there: what is not heard is not much above it. Absent where the line is not apart from another rotor's.
    pub noise_db: Option<f64>,
}

/// What is heard of a rotor's state. Blades that differ in weight, pitch or shape sound at all multiples of the shaft and not only at
/// those of the blades; so do bent shafts. Microphone, room and the rotor's place change levels by some decibels, and small recorders
/// hear little below 100 Hz: compare rotors with each other, and with themselves at another time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotorCondition {
    /// Blades of the propeller, as known.
    pub blades: u32,
    /// All lines up to the fourth multiple of the blade pass.
    pub lines: Vec<ShaftLine>,
    /// Multiples of the blade pass that most rotors sound and this one does not, counted from 1.
    pub missing_harmonics: Vec<u32>,
}

impl RotorCondition {
    /// Level of the line once per turn over that of the blade pass: imbalance.
    pub fn shaft_over_blade_pass_db(&self) -> Option<f64> {
        self.line(1)?.level_db
    }

    /// The loudest line between the multiples of the blade pass, but for that of the shaft itself: blades unlike each other.
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
