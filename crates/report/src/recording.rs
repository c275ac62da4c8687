//! What one recording said, and what it was.

use crate::notice::Notice;
use hovertone::{Config, Outcome, RotorTone, Span, SpeedAnalysis, SpeedEstimate};
use serde::Serialize;

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

/// One recording, its settings and its answer.
#[derive(Clone, Debug)]
pub struct SpeedRecord {
    /// Name of the file as it was given.
    pub file: String,
    /// Settings of the analysis.
    pub config: Config,
    /// What the file is, where it could be opened.
    pub recording: Option<RecordingFacts>,
    /// What came of it.
    pub answer: Answer,
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

    /// The speed by the configured method.
    pub fn speed(&self) -> Option<&SpeedEstimate> {
        self.tone()?.speed(self.config.method)
    }

    /// How it ended, in the words of the machine output.
    pub fn status(&self) -> &'static str {
        match self.speed() {
            Some(_) => "ok",
            None if self.has_failed() => "error",
            None => "no_rotor_tone",
        }
    }

    /// Why there is no speed.
    pub fn reason(&self) -> Option<String> {
        match &self.answer {
            Answer::Failed { reason } => Some(reason.clone()),
            Answer::Heard(analysis) => match &analysis.outcome {
                Outcome::NoRotorTone { reason } => Some(reason.to_string()),
                Outcome::Ok(_) => None,
            },
        }
    }

    /// Whether the file could not be heard.
    pub fn has_failed(&self) -> bool {
        matches!(self.answer, Answer::Failed { .. })
    }

    /// Whether there is less than was asked for: no rotor tone, or only the beginning of the sound.
    pub fn is_incomplete(&self) -> bool {
        self.speed().is_none() || self.recording.as_ref().is_some_and(|recording| recording.is_prefix)
    }

    /// From the start of the first stretch that was used to the end of the last.
    pub fn used(&self) -> Option<Span> {
        let segments = &self.analysis()?.hover.segments;
        Some(Span { from_s: segments.first()?.from_s, to_s: segments.last()?.to_s })
    }
}
