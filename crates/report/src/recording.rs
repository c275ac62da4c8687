//! The record of one recording: its facts and its result.

use crate::notice::Notice;
use crate::wording::Wording;
use hovertone_analysis::{
    Method, NoTone, Outcome, Reading, RotorEstimate, RotorLabel, RotorLabels, RotorTone, RotorsHeard, Span,
    SpeedAnalysis, SpeedEstimate, ToneFamily, Warning,
};
use hovertone_vehicle::Order;
use serde::Serialize;
use serde_json::Value;

/// Facts about a file that could be opened.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RecordingFacts {
    /// SHA-256 of the file's bytes, in hexadecimal; absent where it was not requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
    /// Container.
    pub container: String,
    /// Codec.
    pub codec: String,
    /// Decoder.
    pub decoder: String,
    /// Samples per second, with the correction of the recorder's clock.
    pub sample_rate_hz: f64,
    /// That correction, in millionths; positive for a clock that runs fast.
    pub clock_correction_ppm: f64,
    /// Number of channels of the track.
    pub channel_count: usize,
    /// Number of the analysed channel, counted from 1; absent where it is the mean of all channels.
    pub channel: Option<usize>,
    /// Number of the analysed track, counted from 1.
    pub audio_track: usize,
    /// Number of audio tracks in the file.
    pub audio_track_count: usize,
    /// Whether the file ends before its sound does.
    pub is_prefix: bool,
}

/// Result of a recording.
#[derive(Clone, Debug)]
pub enum Answer {
    /// It was analysed to its end, with or without a rotor tone.
    Heard(Box<SpeedAnalysis>),
    /// It could not be analysed.
    Failed {
        /// What happened, why, and the advice.
        reason: String,
    },
}

/// How a sound contradicts the rotors that were given. Nothing should be built on such a speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contradicted {
    /// Their tone is hardly heard.
    HardlyHeard,
    /// Another rotor fits far better.
    ByAnotherRotor,
}

/// Result of the search for a tone of unknown order.
#[derive(Clone, Debug)]
pub struct Found {
    /// The settings of the search as JSON.
    pub settings: Value,
    /// All tone families, strongest first.
    pub families: Vec<ToneFamily>,
    /// Index of the family of the rotor.
    pub rotor: Option<usize>,
    /// The readings that stay plausible, most plausible first; empty where one is settled, or without a rotor.
    pub alternatives: Vec<Reading>,
}

impl Found {
    /// Whether the number of blades was given to the search.
    pub(crate) fn are_blades_given(&self) -> bool {
        self.settings.pointer("/known/blade_count").is_some_and(|count| !count.is_null())
    }
}

/// One recording with its settings and its result.
#[derive(Clone, Debug)]
pub struct SpeedRecord {
    /// Name of the file as given.
    pub file: String,
    /// The requested method.
    pub method: Method,
    /// Order of the followed tone.
    pub order: Order,
    /// Whether the condition of the rotors was requested.
    pub wants_condition: bool,
    /// The settings of the analysis as JSON.
    pub settings: Value,
    /// Facts about the file, where it could be opened.
    pub recording: Option<RecordingFacts>,
    /// The result.
    pub answer: Answer,
    /// The tone families, where the tone was searched for.
    pub found: Option<Found>,
    /// Labels of the rotors, where they were requested.
    pub labels: Option<RotorLabels>,
    /// A fault of the recording that explains a missing tone, and what to do: it stands in place of the reason of the analysis.
    pub spoiled: Option<String>,
    /// Warnings about the file and the analysis.
    pub notices: Vec<Notice>,
    /// How the advice of [`reason`](Self::reason) is worded.
    pub wording: Wording,
}

impl SpeedRecord {
    /// The same record, with all advice in the words of a command.
    #[must_use]
    pub fn worded(self, wording: Wording) -> Self {
        let notices = self.notices.into_iter().map(|notice| notice.worded(wording)).collect();
        Self { wording, notices, ..self }
    }

    /// The analysis, where the file could be read.
    pub fn analysis(&self) -> Option<&SpeedAnalysis> {
        match &self.answer {
            Answer::Heard(analysis) => Some(analysis),
            Answer::Failed { .. } => None,
        }
    }

    /// The analysis, unless several speeds explain the sound.
    pub fn unambiguous_analysis(&self) -> Option<&SpeedAnalysis> {
        self.analysis().filter(|_| !self.is_ambiguous())
    }

    /// How the sound contradicts the rotors that were given; `None` where it does not.
    pub fn contradiction(&self) -> Option<Contradicted> {
        let analysis = self.unambiguous_analysis()?;
        let has = |is_meant: &dyn Fn(&Warning) -> bool| analysis.warnings.iter().any(is_meant);
        let no_tone_but_another_rotor =
            matches!(&analysis.outcome, Outcome::NoRotorTone { reason: NoTone::NoSeries { instead: Some(_), .. } });
        match () {
            () if no_tone_but_another_rotor || has(&|warning| matches!(warning, Warning::FitsElsewhere(_))) => {
                Some(Contradicted::ByAnotherRotor)
            }
            // in frames of a given length, a clear tone can have gaps
            () if has(&Warning::is_hardly_heard) && !self.given_facts().window => Some(Contradicted::HardlyHeard),
            () => None,
        }
    }

    /// The tone of the rotor, if there is one.
    pub fn tone(&self) -> Option<&RotorTone> {
        match &self.analysis()?.outcome {
            Outcome::Ok(tone) => Some(tone),
            Outcome::NoRotorTone { .. } => None,
        }
    }

    /// The speed by the configured method; `None` where several speeds explain the sound.
    pub fn speed(&self) -> Option<&SpeedEstimate> {
        self.speed_by(self.method)
    }

    /// The speed by a method; `None` where several speeds explain the sound.
    pub fn speed_by(&self, method: Method) -> Option<&SpeedEstimate> {
        self.tone()?.speed(method).filter(|_| !self.is_ambiguous())
    }

    /// The separated rotors, fastest first.
    pub fn rotors(&self) -> &[RotorEstimate] {
        self.tone().filter(|_| !self.is_ambiguous()).map_or(&[], |tone| &tone.rotors)
    }

    /// How the rotors are heard by the configured method; `None` without a speed.
    pub fn rotors_heard(&self) -> Option<RotorsHeard> {
        self.tone().filter(|_| !self.is_ambiguous())?.rotors_heard(self.method)
    }

    /// The label of one of [`rotors`](Self::rotors), where it is known.
    pub fn label(&self, index: usize) -> Option<&RotorLabel> {
        self.labels.as_ref()?.rotors.get(index)?.as_ref()
    }

    /// Mean frequency of the followed tone, with or without a settled order.
    pub fn tone_hz(&self) -> Option<f64> {
        let estimate = self.tone()?.speed(self.method)?;
        Some(estimate.speed.tone_hz(estimate.order))
    }

    /// The plausible readings of the tone, most plausible first; empty where one is settled.
    pub fn alternatives(&self) -> &[Reading] {
        match &self.found {
            Some(found) => &found.alternatives,
            None => self.tone().map_or(&[], |tone| &tone.alternatives),
        }
    }

    /// The used reading, where the tone was searched for.
    pub fn found_reading(&self) -> Option<&Reading> {
        let found = self.found.as_ref()?;
        found.families.get(found.rotor?)?.readings.first()
    }

    /// Whether there is a rotor tone without a settled order.
    pub fn is_ambiguous(&self) -> bool {
        !self.alternatives().is_empty()
    }

    /// The status in the machine output.
    pub fn status(&self) -> &'static str {
        match self.speed() {
            Some(_) => "ok",
            None if self.has_failed() => "error",
            None if self.is_ambiguous() => "ambiguous",
            None => "no_rotor_tone",
        }
    }

    /// Whether the chosen part lies after the end of the recording.
    pub fn is_part_outside(&self) -> bool {
        let outcome = self.analysis().map(|analysis| &analysis.outcome);
        matches!(outcome, Some(Outcome::NoRotorTone { reason: NoTone::OutsideRecording { .. } }))
    }

    /// What stands before the reason for a missing speed. The tone is not to blame where the chosen part is not in the recording.
    pub fn missing_speed_label(&self) -> &'static str {
        match (self.is_ambiguous(), self.is_part_outside()) {
            (true, _) => "ambiguous",
            (false, true) => "no speed",
            (false, false) => "no rotor tone",
        }
    }

    /// Whether one rotor alone is said to turn, as on a bench.
    pub(crate) fn is_one_rotor(&self) -> bool {
        self.given_rotor_count() == Some(1)
    }

    /// The number of rotors, where it is given.
    pub(crate) fn given_rotor_count(&self) -> Option<u64> {
        self.settings.pointer("/known/rotor_count").and_then(Value::as_u64)
    }

    /// Whether the file could not be read.
    pub fn has_failed(&self) -> bool {
        matches!(self.answer, Answer::Failed { .. })
    }

    /// Whether a part of the requested result is missing or doubtful: no rotor tone, an unsettled order, a sound that contradicts the given
    /// rotors or that no multirotor can make, missing labels, a damaged log, or only the beginning of the sound.
    pub fn is_incomplete(&self) -> bool {
        let has_labels = self.labels.as_ref().is_none_or(|labels| labels.not_told.is_none());
        self.speed().is_none()
            || self.contradiction().is_some()
            || self.notices.iter().any(|notice| notice.kind.is_incomplete())
            || !has_labels
            || self.recording.as_ref().is_some_and(|recording| recording.is_prefix)
    }

    /// Whether it has a speed that must not be used: the sound contradicts the given facts, or no multirotor could fly like this.
    pub fn is_doubtful(&self) -> bool {
        let is_forbidden = || self.notices.iter().any(|notice| notice.kind.forbids_use());
        self.speed().is_some() && (self.contradiction().is_some() || is_forbidden())
    }

    /// From the start of the first used stretch to the end of the last.
    pub fn used(&self) -> Option<Span> {
        let segments = &self.analysis()?.hover.segments;
        Some(Span { from_s: segments.first()?.from_s, to_s: segments.last()?.to_s })
    }
}
