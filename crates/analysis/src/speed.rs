//! Shaft speeds: means, tracks and single rotors.

use crate::{Method, RotorCondition, Span, UncertaintySource, UncertaintyTerm};
use hovertone_vehicle::{Order, RotorSpeed};
use serde::Serialize;

/// Shaft speed over a stretch of time, by one method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpeedEstimate {
    /// Method of the estimate.
    pub method: Method,
    /// Order of the tone.
    pub order: Order,
    /// Mean shaft speed.
    #[serde(rename = "speed_rad_s")]
    pub speed: RotorSpeed,
    /// Standard uncertainty of the mean from the sound alone: from the curvature of the likelihood, or for the methods of the paper from
    /// the scatter of the frames and their correlation. It does not contain errors that all frames share: a ridge follows the loudest
    /// rotor, the clock of the recorder is off. These are terms of the budget.
    pub std_uncertainty_rev_s: Option<f64>,
    /// Standard deviation of the speed over the frames: wander of the flight and noise of the method.
    pub spread_rev_s: Option<f64>,
    /// Mean of the squared angular speed over time, and over the rotors where they are separated. The thrust is proportional to it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_square_rad2_s2: Option<f64>,
    /// Number of frames with a point.
    pub frame_count: usize,
    /// The harmonics behind the estimate.
    pub harmonics: Vec<HarmonicSpeed>,
    /// The terms of the uncertainty of the mean, including errors that the sound does not show.
    pub budget: Vec<UncertaintyTerm>,
}

impl SpeedEstimate {
    /// The speed for the thrust: the root of the mean square where that is known, else the mean.
    pub fn speed_of_thrust(&self) -> RotorSpeed {
        self.mean_square_rad2_s2.map_or(self.speed, |square| RotorSpeed::from_rad_s(square.sqrt()))
    }

    /// Standard deviation of the difference between the mean of all rotors and this speed, as a share.
    pub fn rotors_std_share(&self) -> f64 {
        let term = self.budget.iter().find(|term| term.source == UncertaintySource::Rotors);
        term.map_or(0.0, |term| term.std_uncertainty_rev_s / self.speed.rev_s())
    }

    /// Combined standard uncertainty of all terms. `None` without terms.
    pub fn combined_std_uncertainty_rev_s(&self) -> Option<f64> {
        let sum: f64 = self.budget.iter().map(|term| term.std_uncertainty_rev_s.powi(2)).sum();
        (!self.budget.is_empty()).then(|| sum.sqrt())
    }
}

/// The contribution of one harmonic.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HarmonicSpeed {
    /// Number of the harmonic: 1 for the tone itself.
    pub harmonic: u32,
    /// Its order.
    pub order: Order,
    /// Mean frequency (eq 7 of the paper).
    pub mean_hz: f64,
    /// Standard deviation over the frames (eq 8 of the paper, with the square that is missing in print).
    pub std_hz: Option<f64>,
    /// Number of frames with a point.
    pub frame_count: usize,
    /// Weight of this harmonic in the speed of a frame in which all harmonics have a point.
    pub weight: f64,
}

/// One frame of the track, from all harmonics together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TrackPoint {
    /// Middle of the frame.
    pub time_s: f64,
    /// Frequency of the tone itself.
    pub tone_hz: f64,
    /// Shaft speed.
    pub speed_rev_s: f64,
    /// Standard uncertainty of the speed from the noise around the lines.
    pub std_uncertainty_rev_s: f64,
    /// Level of the strongest harmonic, dB re a full-scale sine.
    pub level_db: f64,
}

/// One of several rotors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotorEstimate {
    /// Its mean speed over the hover.
    pub speed: SpeedEstimate,
    /// Times in which it is inaudible, or too close to another rotor to be separated.
    pub merged: Vec<Span>,
    /// Its speed over time.
    pub track: Vec<TrackPoint>,
    /// Its audible condition, where that was requested and the blade pass is audible.
    pub condition: Option<RotorCondition>,
}
