//! Shaft speeds: means, tracks and rotors one by one.

use crate::{Method, RotorCondition, Span, UncertaintySource, UncertaintyTerm};
use hovertone_vehicle::{Order, RotorSpeed};
use serde::Serialize;

/// Shaft speed over a stretch of time, by one method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpeedEstimate {
    /// How the ridge was read.
    pub method: Method,
    /// Order of the tone.
    pub order: Order,
    /// Mean shaft speed.
    #[serde(rename = "speed_rad_s")]
    pub speed: RotorSpeed,
    /// Standard uncertainty of the mean as the sound shows it: from the curvature of the likelihood, or for the paper's methods
    /// from the scatter of the frames and their correlation. It does not know of what all frames share: a ridge follows the
    /// loudest rotor. What the sound cannot tell, such as the recorder's clock, is in the budget.
    pub std_uncertainty_rev_s: Option<f64>,
    /// Standard deviation of the speed over the frames: the wander of the flight and the noise of the method.
    pub spread_rev_s: Option<f64>,
    /// Mean of the squared angular speed over time, and over the rotors where they are told apart: what carries the weight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_square_rad2_s2: Option<f64>,
    /// Frames with a point.
    pub frame_count: usize,
    /// The harmonics that it comes from.
    pub harmonics: Vec<HarmonicSpeed>,
    /// The terms of its uncertainty: what the sound leaves open, and what it cannot tell.
    pub budget: Vec<UncertaintyTerm>,
}

impl SpeedEstimate {
    /// The speed whose square carries the weight: the root of the mean square where that is known, else the mean.
    pub fn speed_of_thrust(&self) -> RotorSpeed {
        self.mean_square_rad2_s2.map_or(self.speed, |square| RotorSpeed::from_rad_s(square.sqrt()))
    }

    /// How far the mean of all rotors may be from this speed, as a share.
    pub fn rotors_std_share(&self) -> f64 {
        let term = self.budget.iter().find(|term| term.source == UncertaintySource::Rotors);
        term.map_or(0.0, |term| term.std_uncertainty_rev_s / self.speed.rev_s())
    }

    /// All terms together, at k = 1. `None` where the sound leaves it unknown.
    pub fn combined_std_uncertainty_rev_s(&self) -> Option<f64> {
        let sum: f64 = self.budget.iter().map(|term| term.std_uncertainty_rev_s.powi(2)).sum();
        (!self.budget.is_empty()).then(|| sum.sqrt())
    }
}

/// What one harmonic says.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HarmonicSpeed {
    /// Number of the harmonic: 1 for the tone itself.
    pub harmonic: u32,
    /// Its order.
    pub order: Order,
    /// Mean frequency (eq 7).
    pub mean_hz: f64,
    /// Standard deviation over the frames (eq 8, with the square that its print lacks).
    pub std_hz: Option<f64>,
    /// Frames with a point.
    pub frame_count: usize,
    /// Share of the speed that comes from this harmonic in a frame where all have a point.
    pub weight: f64,
}

/// One frame of the track: all harmonics together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TrackPoint {
    /// Middle of the frame.
    pub time_s: f64,
    /// Frequency of the tone itself.
    pub tone_hz: f64,
    /// Shaft speed.
    pub speed_rev_s: f64,
    /// Standard uncertainty of that speed from the noise around the lines.
    pub std_uncertainty_rev_s: f64,
    /// Level of the strongest harmonic, dB re a full-scale sine.
    pub level_db: f64,
}

/// One rotor among several.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotorEstimate {
    /// Its mean speed over all of the hover.
    pub speed: SpeedEstimate,
    /// When it is closer to another rotor than can be told apart, or not heard.
    pub merged: Vec<Span>,
    /// Its speed over time.
    pub track: Vec<TrackPoint>,
    /// What its lines say of its state, where that is wanted and the blade pass is heard.
    pub condition: Option<RotorCondition>,
}
