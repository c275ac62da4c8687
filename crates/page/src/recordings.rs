//! The recordings as words and cells of the template.

use crate::input::TrialReport;
use crate::sound::{SoundShare, opus_uri};
use crate::warnings::recording_id;
use hovertone_report::{
    DecisionWords, FoldedWarning, InputRecord, Notice, RecordingFacts, SpeedRecord, counted, cuts_in_words,
    decision_in_words, distinct_notices, short_names, with_uncertainty,
};

/// A playable sound.
pub(crate) struct SoundView {
    pub(crate) uri: String,
    pub(crate) from_s: f64,
}

/// A recording with its decision, picture and sound.
pub(crate) struct TrialView<'a> {
    pub(crate) id: String,
    pub(crate) load: &'a str,
    /// Its file without folders.
    pub(crate) name: String,
    pub(crate) speed: Option<String>,
    /// Absent without a rotor tone.
    pub(crate) decision: Option<DecisionWords>,
    /// Whether several speeds remain possible.
    pub(crate) is_ambiguous: bool,
    pub(crate) reason: Option<String>,
    pub(crate) cuts: Option<String>,
    /// "9.4 of 10.0", seconds.
    pub(crate) used: String,
    /// Its warnings, without those that all recordings have in the same words.
    pub(crate) warnings: Vec<&'a Notice>,
    /// Whether all recordings have a warning in the same words, which stands above them.
    has_shared_warning: bool,
    pub(crate) svg: Option<&'a str>,
    pub(crate) words: &'a str,
    pub(crate) sound: Option<SoundView>,
}

impl<'a> TrialView<'a> {
    /// A recording; the warnings in `folded` stand above all recordings.
    pub(crate) fn new(
        index: usize,
        input: &'a InputRecord,
        name: &str,
        trial: &TrialReport<'a>,
        share: SoundShare,
        folded: &[FoldedWarning],
    ) -> Self {
        let record = &input.record;
        let sound = trial.sound.and_then(|clip| Some(SoundView { uri: opus_uri(clip, share)?, from_s: clip.from_s }));
        let used = record.analysis().map_or("–".to_owned(), |analysis| {
            let used_s = if record.tone().is_some() { analysis.hover.length_s() } else { 0.0 };
            format!("{used_s:.1} of {:.1}", analysis.heard.length_s())
        });
        Self {
            id: recording_id(index),
            load: &input.load,
            name: name.to_owned(),
            speed: record
                .speed()
                .map(|speed| with_uncertainty(speed.speed.rev_s(), speed.combined_std_uncertainty_rev_s())),
            decision: decision_in_words(record),
            is_ambiguous: record.is_ambiguous(),
            reason: record.reason(),
            cuts: cuts_of(record),
            used,
            warnings: distinct_notices(record, folded),
            has_shared_warning: folded.iter().any(|kind| kind.is_of_all),
            svg: trial.figure.map(|figure| figure.svg.as_str()),
            words: trial.figure.map_or("", |figure| figure.description.as_str()),
            sound,
        }
    }

    /// Class, sign and meaning of the state of the recording.
    pub(crate) fn mark(&self) -> (&'static str, &'static str, &'static str) {
        match (&self.speed, self.warnings.is_empty()) {
            (None, _) if self.is_ambiguous => ("doubt", "?", "ambiguous"),
            (None, _) => ("fails", "✗", "no speed"),
            (Some(_), false) => ("doubt", "!", "has warnings"),
            (Some(_), true) if self.has_shared_warning => ("holds", "✓", "no warning of its own"),
            (Some(_), true) => ("holds", "✓", "without warnings"),
        }
    }

    pub(crate) fn reason_in_words(&self) -> &str {
        self.reason.as_deref().unwrap_or("no speed")
    }

    pub(crate) fn warnings_counted(&self) -> String {
        counted(self.warnings.len(), "warning")
    }
}

/// The parts that are not used; a recording without a rotor tone is not used at all.
fn cuts_of(record: &SpeedRecord) -> Option<String> {
    let cuts = cuts_in_words(&record.analysis()?.hover.cuts);
    cuts.or_else(|| record.tone().is_none().then(|| "all of it".to_owned()))
}

/// Names of the recordings without folders; two of one load keep as much of their folders as tells them apart.
pub fn names_of(inputs: &[InputRecord]) -> Vec<String> {
    inputs
        .iter()
        .map(|input| {
            let of_load: Vec<&str> = inputs
                .iter()
                .filter(|other| other.load == input.load)
                .map(|other| other.record.file.as_str())
                .collect();
            let index = of_load.iter().position(|file| *file == input.record.file).unwrap_or(0);
            short_names(&of_load).swap_remove(index)
        })
        .collect()
}

/// Facts about the file of a recording.
pub(crate) struct InputView<'a> {
    pub(crate) load: &'a str,
    pub(crate) file: &'a str,
    pub(crate) status: &'static str,
    pub(crate) facts: Option<&'a RecordingFacts>,
}

impl<'a> InputView<'a> {
    pub(crate) fn new(input: &'a InputRecord) -> Self {
        let record = &input.record;
        Self { load: &input.load, file: &record.file, status: record.status(), facts: record.recording.as_ref() }
    }
}
