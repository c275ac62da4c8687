//! Copies of one recording, which would count as trials of their own and make the ± too small.

use crate::failure::Failure;
use crate::files::sha256_of_file;
use crate::recording::Job;
use hovertone_report::{Notice, SpeedRecord, counted};
use hovertone_workflow::{same_recording_text, same_sound};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// What to do about two recordings that are the same, where they are typed.
pub(crate) const GIVE_ONE: &str =
    "give only one of them: leave the other out of the command, or move it out of its folder";

/// The tip that recordings with which the constant was measured show no mass that was not put into it. Only where the results name their recordings,
/// files are read for it; their hashes stay with the jobs. A file that cannot be read is left to the analysis, which says why.
pub(crate) fn tip_of_circle(jobs: &mut [Job], behind_sha256: &[String]) -> Option<Notice> {
    if behind_sha256.is_empty() {
        return None;
    }
    for job in jobs.iter_mut().filter(|job| job.sha256.is_none()) {
        job.sha256 = sha256_of_file(&job.path).ok();
    }
    let is_behind = |job: &&Job| job.sha256.as_ref().is_some_and(|sha256| behind_sha256.contains(sha256));
    let behind: Vec<&str> = jobs.iter().filter(is_behind).map(|job| job.name.as_str()).collect();
    let (first, others) = behind.split_first()?;
    let others = match others.len() {
        0 => String::new(),
        count => format!(" and {}", counted(count, "other recording")),
    };
    Some(Notice::new(
        format!("the constant was measured with {first}{others}, so this mass is no independent result"),
        "to test the constant, weigh a flight that `hovertone identify` did not use",
    ))
}

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
                    false => same_recording_text([&first, &job.name]),
                };
                return Err(Failure::Usage { what, hint: hint.to_owned(), path: path.map(Path::to_owned) });
            }
        }
    }
    Ok(())
}

/// Refuses two recordings in which exactly the same speed is heard.
pub(crate) fn refuse_equal_speeds<'a>(
    records: impl IntoIterator<Item = &'a SpeedRecord>,
    hint: &str,
    path: Option<&Path>,
) -> Result<(), Failure> {
    let Some(names) = same_sound(records) else { return Ok(()) };
    let what = same_recording_text(names);
    Err(Failure::Usage { what, hint: hint.to_owned(), path: path.map(Path::to_owned) })
}
