//! From the names of files to the recordings to hear, and from their records to the exit code.

use crate::failure::{Ending, Failure};
use crate::files::files_of;
use crate::inputs::{is_stdin, name_of, recording_of_stdin};
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
) -> Result<Vec<Job>, Failure> {
    let mut jobs = Vec::new();
    for name in names {
        let job = |name: String, path: PathBuf| Job {
            name,
            path,
            config: config.clone(),
            discovery,
            requests,
            sha256: None,
            samples: None,
        };
        if is_stdin(name) {
            jobs.push(job(name_of(name), recording_of_stdin()?));
            continue;
        }
        let files = files_of(name);
        // a pattern without files stays in the list, so that the output has its failure in the right place
        let files = if files.is_empty() { vec![name.clone()] } else { files };
        jobs.extend(files.into_iter().map(|path| job(name_of(&path), path)));
    }
    Ok(jobs)
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
