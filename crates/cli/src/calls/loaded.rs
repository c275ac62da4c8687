//! A recording that was decoded, for a program that calls.

use crate::failure::Failure;
use hovertone::sound::SignalSource;
use hovertone_media::Recording;
use hovertone_report::{Notice, RecordingFacts};
use hovertone_workflow::{facts_of, notices_of};

/// The sound of a recording as the commands hear it: one channel, at its own rate.
pub struct LoadedSound {
    /// All samples; full scale is 1.
    pub samples: Vec<f32>,
    /// Time of the first sample on the clock of the recording.
    pub start_s: f64,
    /// Facts about the file.
    pub facts: RecordingFacts,
    /// What weakens the recording.
    pub notices: Vec<Notice>,
}

impl LoadedSound {
    /// Decodes a recording to its end.
    pub(crate) fn of(mut recording: Recording) -> Result<Self, Failure> {
        let mut samples = Vec::new();
        while let Some(block) = recording.next_block().map_err(Failure::internal)? {
            samples.extend_from_slice(block);
        }
        Ok(Self {
            samples,
            start_s: recording.info().start_s,
            notices: notices_of(&recording),
            facts: facts_of(&recording, None),
        })
    }
}
