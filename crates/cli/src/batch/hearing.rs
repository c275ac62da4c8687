//! All recordings that are not finished, one on each core at a time.

use super::counts::{Counted, Counts};
use super::folder::BatchFolder;
use super::inputs::Names;
use crate::failure::Failure;
use crate::progress::Progress;
use crate::recording::{Heard, Hearing, Job, Requests, broken, heard_or_failed};
use hovertone::speed::Config;
use hovertone::tones::Discovery;
use hovertone_archive::{ArchiveRow, Part, Plan, Planned, Shard};
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, PoisonError};

/// How the recordings are heard.
pub(crate) struct Manner {
    pub(crate) names: Names,
    pub(crate) config: Config,
    pub(crate) discovery: Option<Discovery>,
    pub(crate) requests: Requests,
    pub(crate) hearing: Hearing,
    pub(crate) shard: Shard,
    /// Recordings at the same time; one for each core where absent.
    pub(crate) threads: Option<usize>,
    /// Whether those that could not be heard are heard again.
    pub(crate) retries: bool,
    pub(crate) wants_progress: bool,
}

impl Manner {
    fn job(&self, recording: &Planned) -> Job {
        Job {
            path: self.names.path(&recording.name),
            name: recording.name.clone(),
            config: self.config.clone(),
            discovery: self.discovery,
            requests: self.requests,
            sha256: None,
            samples: None,
        }
    }
}

/// Hears the recordings of this job that are not finished, and keeps each at once. Memory does not grow with their number.
pub(crate) fn hear_missing(plan: &Plan, folder: &BatchFolder, manner: &Manner) -> Result<Counts, Failure> {
    let of_job = plan.recordings().iter().enumerate().filter(|(index, _)| manner.shard.has(*index));
    let missing: Vec<&Planned> =
        of_job.map(|(_, recording)| recording).filter(|recording| is_missing(recording, folder, manner)).collect();
    let progress = Progress::new("hearing", missing.len(), manner.wants_progress);
    let counts = Mutex::new(Counts::default());
    let pool = ThreadPoolBuilder::new().num_threads(manner.threads.unwrap_or(0)).build().map_err(Failure::internal)?;
    let ended = pool.install(|| {
        missing.par_iter().try_for_each(|recording| {
            let row = heard_row(recording, manner, folder, &progress)?;
            let mut counts = counts.lock().unwrap_or_else(PoisonError::into_inner);
            counts.add(Counted::from(&row.record));
            progress.say(format!("{} of {}: {counts}", counts.total(), missing.len()));
            Ok(())
        })
    });
    progress.finish();
    ended.map(|()| counts.into_inner().unwrap_or_else(PoisonError::into_inner))
}

fn is_missing(recording: &Planned, folder: &BatchFolder, manner: &Manner) -> bool {
    if !folder.has(recording) {
        return true;
    }
    // a part that cannot be read is heard again, too
    manner.retries
        && folder.part(recording).ok().and_then(|part| part.summary().ok()).is_none_or(|row| row.status == "error")
}

fn heard_row(
    recording: &Planned,
    manner: &Manner,
    folder: &BatchFolder,
    progress: &Progress,
) -> Result<ArchiveRow, Failure> {
    let job = manner.job(recording);
    let heard = heard_always(&job, manner.hearing, progress);
    let row = ArchiveRow { record: heard.record, error_class: heard.error_class };
    folder.keep(recording, &Part::new(&row, heard.thumbnail).map_err(Failure::internal)?)?;
    Ok(row)
}

/// One recording that breaks the analysis does not end a run of a night.
pub(super) fn heard_always(job: &Job, hearing: Hearing, progress: &Progress) -> Heard {
    let mut share = progress.recording();
    let heard = catch_unwind(AssertUnwindSafe(|| heard_or_failed(job, hearing, &mut share)));
    heard.unwrap_or_else(|_| broken(job))
}
