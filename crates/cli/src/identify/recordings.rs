//! From the names and patterns in an experiment file to recordings on disk.

use super::ExperimentSource;
use crate::copies::refuse_copies;
use crate::failure::Failure;
use crate::files::files_of;
use crate::recording::{Job, Requests};
use hovertone::experiment::ExperimentLoad;
use std::path::{Path, PathBuf};

/// Most names in the list of missing recordings.
const NAMES_MAX: usize = 8;

/// A recording of a load.
pub(crate) struct LoadJob {
    pub(crate) job: Job,
    /// Name of the load.
    pub(crate) load: String,
}

/// A name or pattern of a load that no file matches.
struct Missing<'a> {
    load: &'a ExperimentLoad,
    name: &'a str,
}

/// All recordings, load by load. Two that are the same recording are refused.
pub(crate) fn jobs_of(source: &ExperimentSource, data_root: Option<&Path>) -> Result<Vec<LoadJob>, Failure> {
    let root = data_root.unwrap_or(&source.folder);
    if !root.is_dir() && data_root.is_some() {
        let hint = "give --data-root the folder that holds the recordings";
        return Err(Failure::failed("there is no such folder", hint, root));
    }
    let (mut jobs, mut missing): (Vec<LoadJob>, Vec<Missing<'_>>) = (Vec::new(), Vec::new());
    for load in &source.experiment.loads {
        for name in &load.recordings {
            let files: Vec<PathBuf> = files_of(&root.join(name)).into_iter().filter(|file| file.exists()).collect();
            if files.is_empty() {
                missing.push(Missing { load, name });
            }
            for path in files {
                let job = Job {
                    name: name_of(&path, root),
                    path,
                    config: load.config(&source.experiment),
                    discovery: None,
                    requests: Requests::default(),
                    sha256: None,
                };
                let is_known = |known: &LoadJob| known.load == load.name && known.job.path == job.path;
                if !jobs.iter().any(is_known) {
                    jobs.push(LoadJob { job, load: load.name.clone() });
                }
            }
        }
    }
    if !missing.is_empty() {
        return Err(missing_failure(&missing, source, root, data_root.is_some()));
    }
    let hint = "take one of them out of the experiment file, or out of the folder";
    refuse_copies(jobs.iter_mut().map(|LoadJob { job, .. }| job), hint, Some(&source.path))?;
    Ok(jobs)
}

/// Name of a recording relative to the folder, with forward slashes on all systems.
fn name_of(path: &Path, root: &Path) -> String {
    path.strip_prefix(root).unwrap_or(path).display().to_string().replace('\\', "/")
}

fn missing_failure(missing: &[Missing<'_>], source: &ExperimentSource, root: &Path, is_root_given: bool) -> Failure {
    let listed =
        missing.iter().take(NAMES_MAX).map(|Missing { load, name }| format!("{name} of load \"{}\"", load.name));
    let mut list = listed.collect::<Vec<_>>().join("\n  ");
    if missing.len() > NAMES_MAX {
        list += &format!("\n  and {} more", missing.len() - NAMES_MAX);
    }
    let shown_root = if root.as_os_str().is_empty() { Path::new(".") } else { root };
    let what = format!("no file matches these recordings of {}:\n  {list}\nlooked in", source.name);
    let what = format!("{what} {}", shown_root.display());
    let notes = if source.has_notes { "; the notes at the top of the file may say where they come from" } else { "" };
    let hint = if is_root_given {
        format!("put them into the folder that --data-root names, or name another{notes}")
    } else {
        format!("put them beside the experiment file, or say with --data-root DIR which folder holds them{notes}")
    };
    Failure::failed(what, hint, &source.path)
}
