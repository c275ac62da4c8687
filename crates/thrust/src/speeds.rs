//! Speeds of loads, trials and samples, the input of the fit.

use crate::force::Force;
use hovertone_analysis::{Method, Outcome, RotorsHeard, Span, SpeedAnalysis, SpeedEstimate};
use hovertone_vehicle::RotorSpeed;
use serde::Serialize;

/// One load: a known force and the trials flown with it.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadSpeeds {
    /// Name of the load.
    pub name: String,
    /// Force that the rotors balance.
    pub force: Force,
    /// Number of rotors that balance it.
    pub rotors_running: u32,
    /// Total power of these rotors, where known.
    pub power_w: Option<f64>,
    /// Its trials.
    pub trials: Vec<TrialSpeeds>,
}

/// One trial: a recording, the speed over its hover and the speeds of its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct TrialSpeeds {
    /// Name of the recording.
    pub recording: String,
    /// Length of the hover, without the parts that were cut.
    pub hover_s: f64,
    /// Speed over the whole hover. Where it is absent, the mean over the samples counts, as in the paper.
    ///
    /// The balance of weight and thrust is disturbed by climbs at the start and end of a stretch, so the longest stretch is best.
    /// Samples leave out the end of a hover, and their overlap counts its middle twice.
    pub hover: Option<SampleSpeed>,
    /// Its samples.
    pub samples: Vec<SampleSpeed>,
    /// How the rotors are heard, where it is known.
    pub rotors_heard: Option<RotorsHeard>,
}

impl TrialSpeeds {
    /// The speeds of a recording by one method: over the whole hover, or in samples by the methods of the paper. `None` without a rotor
    /// tone.
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
            rotors_heard: tone.rotors_heard(method),
        })
    }

    /// The speeds that the fit uses: the speed over the hover, or else the samples.
    pub(crate) fn counted(&self) -> &[SampleSpeed] {
        if self.hover.is_some() { self.hover.as_slice() } else { &self.samples }
    }
}

/// Speed in one sample, or in all of a hover.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SampleSpeed {
    /// Stretch of time.
    #[serde(flatten)]
    pub span: Span,
    /// Shaft speed: the mean, or the root mean square over the rotors where they are separated.
    #[serde(rename = "speed_rad_s")]
    pub speed: RotorSpeed,
    /// Standard uncertainty of the mean, from the sound alone.
    pub std_uncertainty_rev_s: Option<f64>,
    /// Standard deviation over the frames.
    pub spread_rev_s: Option<f64>,
    /// Number of frames.
    pub frame_count: usize,
}
