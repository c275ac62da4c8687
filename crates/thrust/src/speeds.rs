//! Speeds of loads, trials and samples: the input of the fit.

use crate::force::Force;
use hovertone_analysis::{Method, Outcome, Span, SpeedAnalysis, SpeedEstimate};
use hovertone_vehicle::RotorSpeed;
use serde::Serialize;

/// One load: a known force and the trials flown with it.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadSpeeds {
    /// Its name.
    pub name: String,
    /// What the rotors balance.
    pub force: Force,
    /// How many rotors balance it.
    pub rotors_running: u32,
    /// Power that they take together, where known.
    pub power_w: Option<f64>,
    /// Its trials.
    pub trials: Vec<TrialSpeeds>,
}

/// One trial: a recording, the speed of its hover and those of its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct TrialSpeeds {
    /// Name of the recording.
    pub recording: String,
    /// How long it hovers, without what was cut.
    pub hover_s: f64,
    /// Over all of its hover, where that is what counts; else the mean of the samples does, as in the paper.
    ///
    /// A force balance holds over a stretch of time but for the climb that begins or ends in it, which is the less the longer the
    /// stretch; samples leave out the end of a hover and hear its middle twice.
    pub hover: Option<SampleSpeed>,
    /// Its samples.
    pub samples: Vec<SampleSpeed>,
}

impl TrialSpeeds {
    /// What is heard in a recording by one method: over all of its hover by ours, in samples by the paper's. `None` without a rotor tone.
    pub fn from_analysis(recording: impl Into<String>, analysis: &SpeedAnalysis, method: Method) -> Option<Self> {
        let Outcome::Ok(tone) = &analysis.outcome else { return None };
        let speed_in = |span: Span, estimate: &SpeedEstimate| SampleSpeed {
            span,
            speed: estimate.speed_of_thrust(),
            std_uncertainty_rev_s: estimate.std_uncertainty_rev_s,
            spread_rev_s: estimate.spread_rev_s,
            frame_count: estimate.frame_count,
        };
        let segments = &analysis.hover.segments;
        let (from_s, to_s) = (segments.first()?.from_s, segments.last()?.to_s);
        let hover = tone.speed(method).filter(|_| !method.reads_ridges());
        Some(Self {
            recording: recording.into(),
            hover_s: analysis.hover.length_s(),
            hover: hover.map(|estimate| speed_in(Span { from_s, to_s }, estimate)),
            samples: tone
                .samples
                .iter()
                .filter_map(|sample| Some(speed_in(sample.span, sample.speed(method)?)))
                .collect(),
        })
    }

    /// What counts of it.
    pub(crate) fn counted(&self) -> &[SampleSpeed] {
        if self.hover.is_some() { self.hover.as_slice() } else { &self.samples }
    }
}

/// Speed in one sample, or in all of a hover.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SampleSpeed {
    /// When.
    #[serde(flatten)]
    pub span: Span,
    /// Shaft speed: the mean, or where rotors are told apart the root of the mean square over them.
    #[serde(rename = "speed_rad_s")]
    pub speed: RotorSpeed,
    /// Standard uncertainty of the mean, from the sound alone.
    pub std_uncertainty_rev_s: Option<f64>,
    /// Standard deviation over the frames.
    pub spread_rev_s: Option<f64>,
    /// Frames in it.
    pub frame_count: usize,
}
