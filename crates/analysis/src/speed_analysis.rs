//! The answer for one recording.

use crate::{Band, Hover, Method, NoTone, Ridge, RotorEstimate, Span, SpeedEstimate, TrackPoint, Warning};
use serde::Serialize;

/// What a recording says of its rotors.
#[derive(Clone, Debug, Serialize)]
pub struct SpeedAnalysis {
    /// What was listened to, on the recording's clock.
    pub heard: Span,
    /// What was used of it, and what was cut away and why.
    pub hover: Hover,
    /// The speeds, or why there are none.
    pub outcome: Outcome,
    /// What weakens the result.
    pub warnings: Vec<Warning>,
}

/// The answer: speeds, or that there is no rotor tone.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "status", rename_all = "snake_case")]
#[allow(clippy::large_enum_variant)] // one per recording, never in a hot collection
pub enum Outcome {
    /// A rotor was heard.
    Ok(RotorTone),
    /// No rotor was heard, and why.
    NoRotorTone {
        /// Why.
        reason: NoTone,
    },
}

/// A rotor's tone and the speeds it means.
#[derive(Clone, Debug, Serialize)]
pub struct RotorTone {
    /// Where the ridges were looked for.
    pub bands: Vec<Band>,
    /// Length of the frames.
    pub window_s: f64,
    /// One ridge for each band.
    pub ridges: Vec<Ridge>,
    /// Mean over all of the hover, one for each method in the order of [`Method::ALL`].
    pub speeds: Vec<SpeedEstimate>,
    /// Speed of each frame, by the configured method: of several rotors their mean, where all are told apart.
    pub track: Vec<TrackPoint>,
    /// The rotors one by one, fastest first; empty where they are not told apart.
    pub rotors: Vec<RotorEstimate>,
    /// The paper's samples, each with one speed for each method.
    pub samples: Vec<SampleSpeeds>,
}

impl RotorTone {
    /// The mean over the hover by one method; by that of a single rotor where several were to be told apart and not even their mean is known.
    pub fn speed(&self, method: Method) -> Option<&SpeedEstimate> {
        speed_by(&self.speeds, method)
    }
}

/// One sample of a hover.
#[derive(Clone, Debug, Serialize)]
pub struct SampleSpeeds {
    /// When.
    pub span: Span,
    /// Its speed by each method in the order of [`Method::ALL`].
    pub speeds: Vec<SpeedEstimate>,
}

impl SampleSpeeds {
    /// The sample's speed by one method; by that of a single rotor where several were to be told apart and not even their mean is known.
    pub fn speed(&self, method: Method) -> Option<&SpeedEstimate> {
        speed_by(&self.speeds, method)
    }
}

fn speed_by(speeds: &[SpeedEstimate], method: Method) -> Option<&SpeedEstimate> {
    let instead = (method == Method::Separated).then_some(Method::Harmonic);
    [Some(method), instead].into_iter().flatten().find_map(|method| speeds.iter().find(|speed| speed.method == method))
}
