//! A recording that was heard, for a program that calls.

use crate::drawing::drawing_of;
use crate::failure::Failure;
use crate::recording::{HeardJobs, Hearing, Job};
use hovertone_figures::{Figure, recording_figure};
use hovertone_report::SpeedRecord;
use hovertone_workflow::trial_of;

/// A recording with its answer. Its sound can be read again for a picture.
pub struct HeardRecording {
    job: Job,
    hearing: Hearing,
    record: SpeedRecord,
}

impl HeardRecording {
    /// Each job with its answer.
    pub(crate) fn all(HeardJobs { jobs, records, hearing }: HeardJobs) -> Vec<Self> {
        jobs.into_iter().zip(records).map(|(job, record)| Self { job, hearing, record }).collect()
    }

    /// The answer.
    pub fn record(&self) -> &SpeedRecord {
        &self.record
    }

    /// The spectrogram with the tracks of the rotors, by another pass over the sound; `None` where the sound is too short for it.
    ///
    /// # Errors
    /// A recording that could not be heard, or cannot be read again.
    pub fn figure(&self) -> Result<Option<Figure>, Failure> {
        let drawing = drawing_of(&self.job, &self.record, self.hearing, None)?;
        let reason = self.record.reason();
        let trial = trial_of("", &self.record, reason.as_deref(), Some(&drawing));
        recording_figure(&trial, "spectrogram").map_err(Failure::internal)
    }
}
