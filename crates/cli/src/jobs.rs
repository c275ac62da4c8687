//! From the names of files to the recordings to hear, and from their records to the exit code.

use crate::failure::Ending;
use crate::files::files_of;
use crate::recording::{Job, Requests};
use hovertone::speed::Config;
use hovertone::tones::Discovery;
use hovertone_report::SpeedRecord;
use std::path::PathBuf;

/// One job for each file, with equal settings.
pub(crate) fn jobs_of(
    names: &[PathBuf],
    config: &Config,
    discovery: Option<Discovery>,
    requests: Requests,
) -> Vec<Job> {
    let mut jobs = Vec::new();
    for name in names {
        let files = files_of(name);
        // a pattern without files stays in the list, so that the output has its failure in the right place
        let files = if files.is_empty() { vec![name.clone()] } else { files };
        jobs.extend(files.into_iter().map(|path| Job {
            name: path.display().to_string(),
            path,
            config: config.clone(),
            discovery,
            requests,
            sha256: None,
        }));
    }
    jobs
}

/// The worst ending of the recordings.
pub(crate) fn ending_of<'a>(records: impl IntoIterator<Item = &'a SpeedRecord>) -> Ending {
    let ending = |record: &SpeedRecord| match record {
        record if record.has_failed() => Ending::FilesFailed,
        record if record.is_incomplete() => Ending::Incomplete,
        _ => Ending::Done,
    };
    records.into_iter().map(ending).max().unwrap_or(Ending::Done)
}
