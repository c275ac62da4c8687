//! The result for one recording.

use crate::{
    Band, Hover, Method, NoTone, Reading, Ridge, RotorCondition, RotorEstimate, Span, SpeedEstimate, TrackPoint,
    Warning, WeighedSpeed,
};
use serde::Serialize;

/// The result for one recording.
#[derive(Clone, Debug, Serialize)]
pub struct SpeedAnalysis {
    /// The analysed span, on the clock of the recording.
    pub heard: Span,
    /// The used stretches, and the reasons for the cuts.
    pub hover: Hover,
    /// The speeds, or the reason why there are none.
    pub outcome: Outcome,
    /// Warnings about the result.
    pub warnings: Vec<Warning>,
}

/// Speeds, or no rotor tone.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "status", rename_all = "snake_case")]
#[allow(clippy::large_enum_variant)] // one per recording, never in a hot collection
pub enum Outcome {
    /// A rotor tone was found.
    Ok(RotorTone),
    /// No rotor tone was found.
    NoRotorTone {
        /// Reason.
        reason: NoTone,
    },
}

/// The tone of the rotors and their speeds.
#[derive(Clone, Debug, Serialize)]
pub struct RotorTone {
    /// Bands of the ridges.
    pub bands: Vec<Band>,
    /// Length of the frames.
    pub window_s: f64,
    /// One ridge for each band.
    pub ridges: Vec<Ridge>,
    /// Mean over the hover by each method, in the order of [`Method::ALL`].
    pub speeds: Vec<SpeedEstimate>,
    /// Speed of each frame by the configured method; of several separated rotors their mean.
    pub track: Vec<TrackPoint>,
    /// The separated rotors, fastest first; empty where they are not separated.
    pub rotors: Vec<RotorEstimate>,
    /// The audible condition of the only rotor, where that was requested, one rotor turns, and its blade pass is audible.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub condition: Option<RotorCondition>,
    /// The samples of the paper, each with a speed for each method.
    pub samples: Vec<SampleSpeeds>,
    /// The speeds that remain possible, most probable first; empty where one is decided.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub alternatives: Vec<Reading>,
    /// The speeds that were weighed against each other, most plausible first: the chosen one and its runner-up, where another speed
    /// explains lines at all.
    pub weighed: Vec<WeighedSpeed>,
}

impl RotorTone {
    /// The mean over the hover by a method. Where [`Method::Separated`] has no result, the result of [`Method::Harmonic`].
    pub fn speed(&self, method: Method) -> Option<&SpeedEstimate> {
        speed_by(&self.speeds, method)
    }
}

/// One sample of a hover.
#[derive(Clone, Debug, Serialize)]
pub struct SampleSpeeds {
    /// Stretch of time.
    pub span: Span,
    /// Its speed by each method, in the order of [`Method::ALL`].
    pub speeds: Vec<SpeedEstimate>,
}

impl SampleSpeeds {
    /// The speed by a method. Where [`Method::Separated`] has no result, the result of [`Method::Harmonic`].
    pub fn speed(&self, method: Method) -> Option<&SpeedEstimate> {
        speed_by(&self.speeds, method)
    }
}

fn speed_by(speeds: &[SpeedEstimate], method: Method) -> Option<&SpeedEstimate> {
    let instead = (method == Method::Separated).then_some(Method::Harmonic);
    [Some(method), instead].into_iter().flatten().find_map(|method| speeds.iter().find(|speed| speed.method == method))
}
