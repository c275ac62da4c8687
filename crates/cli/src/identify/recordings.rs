//! The names and patterns of an experiment file to recordings on disk.

use super::ExperimentSource;
use crate::failure::Failure;
use crate::files::files_of;
use crate::recording::{Job, Requests};
use hovertone::experiment::ExperimentLoad;
use std::path::{Path, PathBuf};

/// Names that are listed when recordings are missing.
const NAMES_MAX: usize = 8;

/// All recordings, load by load, each with the name of its load.
pub(super) fn jobs_of(source: &ExperimentSource, data_root: Option<&Path>) -> Result<Vec<(Job, String)>, Failure> {
    let root = data_root.unwrap_or(&source.folder);
    if !root.is_dir() && data_root.is_some() {
        let hint = "give --data-root the folder that holds the recordings";
        return Err(Failure::failed("there is no such folder", hint, root));
    }
    let (mut jobs, mut missing) = (Vec::new(), Vec::new());
    for load in &source.experiment.loads {
        for name in &load.recordings {
            let files: Vec<PathBuf> = files_of(&root.join(name)).into_iter().filter(|file| file.exists()).collect();
            if files.is_empty() {
                missing.push((load, name.as_str()));
            }
            for path in files {
                let job = Job {
                    name: name_of(&path, root),
                    path,
                    config: load.config(&source.experiment),
                    discovery: None,
                    requests: Requests::default(),
                };
                let is_known = |(known, of): &(Job, String)| *of == load.name && known.path == job.path;
                if !jobs.iter().any(is_known) {
                    jobs.push((job, load.name.clone()));
                }
            }
        }
    }
    if missing.is_empty() { Ok(jobs) } else { Err(missing_failure(&missing, source, root, data_root.is_some())) }
}

/// The same wherever the folder is.
fn name_of(path: &Path, root: &Path) -> String {
    path.strip_prefix(root).unwrap_or(path).display().to_string().replace('\\', "/")
}

fn missing_failure(
    missing: &[(&ExperimentLoad, &str)],
    source: &ExperimentSource,
    root: &Path,
    is_root_given: bool,
) -> Failure {
    let listed = missing.iter().take(NAMES_MAX).map(|(load, name)| format!("{name} of load \"{}\"", load.name));
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
