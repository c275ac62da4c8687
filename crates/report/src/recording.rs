//! What one recording said, and what it was.

use crate::notice::Notice;
use hovertone_analysis::{
    Method, Outcome, Reading, RotorEstimate, RotorLabel, RotorLabels, RotorTone, Span, SpeedAnalysis, SpeedEstimate,
    ToneFamily,
};
use hovertone_vehicle::Order;
use serde::Serialize;
use serde_json::Value;

/// What is known of a file that could be opened.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RecordingFacts {
    /// SHA-256 of the file's bytes, in hexadecimal; absent where nobody asked for it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
    /// Its container.
    pub container: String,
    /// Its codec.
    pub codec: String,
    /// Who decoded it.
    pub decoder: String,
    /// Samples per second.
    pub sample_rate_hz: f64,
    /// Channels of the track.
    pub channel_count: usize,
    /// The channel that was heard, counted from 1; absent where it is the mean of all.
    pub channel: Option<usize>,
    /// The track that was heard, counted from 1.
    pub audio_track: usize,
    /// Audio tracks in the file.
    pub audio_track_count: usize,
    /// Whether the file ended before its sound did.
    pub is_prefix: bool,
}

/// What came of a recording.
#[derive(Clone, Debug)]
pub enum Answer {
    /// It was heard to its end, whether or not there was a rotor in it.
    Heard(Box<SpeedAnalysis>),
    /// It could not be heard, and why.
    Failed {
        /// What happened, why, and what to do about it.
        reason: String,
    },
}

/// What was found where nobody had said which tone is the rotor's.
#[derive(Clone, Debug)]
pub struct Found {
    /// The settings of the search, as they are written out.
    pub settings: Value,
    /// All tone families, strongest first.
    pub families: Vec<ToneFamily>,
    /// Which of them was taken for the rotor's.
    pub rotor: Option<usize>,
    /// The readings that stay plausible, most plausible first; empty where one is settled, or there is no rotor.
    pub alternatives: Vec<Reading>,
}

/// One recording, its settings and its answer.
#[derive(Clone, Debug)]
pub struct SpeedRecord {
    /// Name of the file as it was given.
    pub file: String,
    /// The method that was asked for.
    pub method: Method,
    /// Order of the tone that was followed.
    pub order: Order,
    /// Whether the condition of the rotors was asked for.
    pub wants_condition: bool,
    /// The settings of the analysis, as they are written out.
    pub settings: Value,
    /// What the file is, where it could be opened.
    pub recording: Option<RecordingFacts>,
    /// What came of it.
    pub answer: Answer,
    /// The tone families, where the tone had to be found.
    pub found: Option<Found>,
    /// Which rotor is which, where a log was to tell it.
    pub labels: Option<RotorLabels>,
    /// What weakens it, of the file as of the analysis.
    pub notices: Vec<Notice>,
}

impl SpeedRecord {
    /// The analysis, where the file could be heard.
    pub fn analysis(&self) -> Option<&SpeedAnalysis> {
        match &self.answer {
            Answer::Heard(analysis) => Some(analysis),
            Answer::Failed { .. } => None,
        }
    }

    /// The rotor's tone, where one was heard.
    pub fn tone(&self) -> Option<&RotorTone> {
        match &self.analysis()?.outcome {
            Outcome::Ok(tone) => Some(tone),
            Outcome::NoRotorTone { .. } => None,
        }
    }

    /// The speed by the configured method; none where several readings of the tone stay plausible.
    pub fn speed(&self) -> Option<&SpeedEstimate> {
        self.tone()?.speed(self.method).filter(|_| !self.is_ambiguous())
    }

    /// The rotors one by one, fastest first, where they were told apart.
    pub fn rotors(&self) -> &[RotorEstimate] {
        self.tone().filter(|_| !self.is_ambiguous()).map_or(&[], |tone| &tone.rotors)
    }

    /// Which rotor one of [`rotors`](Self::rotors) is, where it is told.
    pub fn label(&self, index: usize) -> Option<&RotorLabel> {
        self.labels.as_ref()?.rotors.get(index)?.as_ref()
    }

    /// Mean frequency of the tone that was followed, whether or not its order is settled.
    pub fn tone_hz(&self) -> Option<f64> {
        let estimate = self.tone()?.speed(self.method)?;
        Some(estimate.speed.tone_hz(estimate.order))
    }

    /// What the tone can mean, most plausible first; nothing where that is settled.
    pub fn alternatives(&self) -> &[Reading] {
        self.found.as_ref().map_or(&[], |found| &found.alternatives)
    }

    /// The reading that was taken, where the tone had to be found.
    pub fn found_reading(&self) -> Option<&Reading> {
        let found = self.found.as_ref()?;
        found.families.get(found.rotor?)?.readings.first()
    }

    /// Whether a rotor was heard whose order is not settled.
    pub fn is_ambiguous(&self) -> bool {
        !self.alternatives().is_empty()
    }

    /// How it ended, in the words of the machine output.
    pub fn status(&self) -> &'static str {
        match self.speed() {
            Some(_) => "ok",
            None if self.has_failed() => "error",
            None if self.is_ambiguous() => "ambiguous",
            None => "no_rotor_tone",
        }
    }

    /// Why there is no speed.
    pub fn reason(&self) -> Option<String> {
        match &self.answer {
            Answer::Failed { reason } => Some(reason.clone()),
            Answer::Heard(analysis) => match &analysis.outcome {
                Outcome::NoRotorTone { reason } => Some(reason.to_string()),
                Outcome::Ok(_) => self.is_ambiguous().then(|| {
                    "several readings of the tone stay plausible; count the blades and say --blades N, or give --diameter-m, \
                     --mass-kg and --rotors"
                        .to_owned()
                }),
            },
        }
    }

    /// Whether the file could not be heard.
    pub fn has_failed(&self) -> bool {
        matches!(self.answer, Answer::Failed { .. })
    }

    /// Whether there is less than was asked for: no rotor tone, one that is not settled, labels that are not told, or only the
    /// beginning of the sound.
    pub fn is_incomplete(&self) -> bool {
        let has_labels = self.labels.as_ref().is_none_or(|labels| labels.not_told.is_none());
        self.speed().is_none() || !has_labels || self.recording.as_ref().is_some_and(|recording| recording.is_prefix)
    }

    /// From the start of the first stretch that was used to the end of the last.
    pub fn used(&self) -> Option<Span> {
        let segments = &self.analysis()?.hover.segments;
        Some(Span { from_s: segments.first()?.from_s, to_s: segments.last()?.to_s })
    }
}
