//! Copies of one recording, which would count as trials of their own and make the ± too small.

use crate::failure::Failure;
use crate::files::sha256_of_file;
use crate::recording::Job;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Refuses two recordings with the same content, whatever their names. A file that cannot be read is left to the analysis, which says why.
///
/// Only files of equal length are read for it; their hashes stay with the jobs.
pub(crate) fn refuse_copies<'a>(
    jobs: impl IntoIterator<Item = &'a mut Job>,
    hint: &str,
    path: Option<&Path>,
) -> Result<(), Failure> {
    let mut of_length: BTreeMap<u64, Vec<&mut Job>> = BTreeMap::new();
    for job in jobs {
        if let Ok(facts) = fs::metadata(&job.path) {
            of_length.entry(facts.len()).or_default().push(job);
        }
    }
    for alike in of_length.into_values().filter(|alike| alike.len() > 1) {
        let mut known: BTreeMap<String, String> = BTreeMap::new();
        for job in alike {
            let Ok(sha256) = sha256_of_file(&job.path) else { continue };
            job.sha256 = Some(sha256.clone());
            if let Some(first) = known.insert(sha256, job.name.clone()) {
                let what = match first == job.name {
                    true => format!(
                        "{first} is given twice: a recording that counts twice makes the uncertainty (±) too small"
                    ),
                    false => format!(
                        "{first} and {} are the same recording: a recording that counts twice makes the uncertainty (±) too small",
                        job.name
                    ),
                };
                return Err(Failure::Usage { what, hint: hint.to_owned(), path: path.map(Path::to_owned) });
            }
        }
    }
    Ok(())
}
