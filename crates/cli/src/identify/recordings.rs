//! From the names and patterns in an experiment file to recordings on disk.

use super::ExperimentSource;
use crate::copies::{GIVE_ONE, refuse_copies};
use crate::failure::Failure;
use crate::files::{files_of, home_expanded, is_pattern, missing_folder};
use crate::inputs::{is_stdin, name_of, recording_of_stdin};
use crate::recording::{Job, Requests};
use crate::recording_files::{RecordingGroup, groups_below, groups_in};
use crate::rights::{CLOSED_FOLDER, GET_RIGHT, closed_folder};
use hovertone::experiment::ExperimentLoad;
use hovertone_report::{Notice, counted};
use std::path::{Path, PathBuf};

/// Most names in the list of missing recordings.
const NAMES_MAX: usize = 3;
const HINT_OF_LOG: &str =
    "correct the name of the log, or put the log there; without a log, write the name of the recording alone";

/// A recording of a load.
pub(crate) struct LoadJob {
    pub(crate) job: Job,
    /// Name of the load.
    pub(crate) load: String,
    /// The log of its flight.
    pub(crate) log: Option<LogFile>,
}

/// A log that the experiment names.
#[derive(Clone, Debug)]
pub(crate) struct LogFile {
    pub(crate) path: PathBuf,
    /// Name in the output.
    pub(crate) name: String,
}

/// A name or pattern of a load that no file matches.
pub(super) struct Missing<'a> {
    pub(super) load: &'a ExperimentLoad,
    pub(super) name: &'a str,
    /// Whether it names the log of a recording.
    pub(super) is_log: bool,
}

impl Missing<'_> {
    /// That the file is missing, and what to do.
    pub(super) fn notice(&self, root: &Path) -> Notice {
        let Self { load, name, is_log } = self;
        let place = place_of(name, root);
        if *is_log {
            let what = format!("the log {name} of load \"{}\" is not there: {}", load.name, why_no_log(&place));
            return Notice::new(what, HINT_OF_LOG);
        }
        if let Some(folder) = closed_folder(&place) {
            return Notice::new(format!("{}: {CLOSED_FOLDER}", folder.display()), GET_RIGHT);
        }
        if let Some(folder) = folder_without_recordings(&place) {
            return Notice::new(format!("{}: {}", folder.path.display(), folder.what), folder.hint);
        }
        let nearby = nearby(&place).map_or(String::new(), |nearby| format!("; {nearby}"));
        let what = format!("no file matches {name} of load \"{}\"{nearby}", load.name);
        Notice::new(what, "correct the name, or put the file there")
    }
}

/// What stands in the place of a log that is missing.
fn why_no_log(place: &Path) -> String {
    if place.is_dir() {
        return "this is the name of a folder".to_owned();
    }
    match place.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        Some(folder) if folder.is_dir() => format!("the folder {} has no file of this name", folder.display()),
        Some(folder) => format!("there is no folder {}", folder.display()),
        None => "the folder of the experiment file has no file of this name".to_owned(),
    }
}

/// The recordings of an experiment, and the names without a file.
pub(super) struct FoundRecordings<'a> {
    pub(super) jobs: Vec<LoadJob>,
    pub(super) missing: Vec<Missing<'a>>,
}

/// All recordings, load by load. Two that are the same recording are refused.
pub(crate) fn jobs_of(source: &ExperimentSource, data_root: Option<&Path>) -> Result<Vec<LoadJob>, Failure> {
    let FoundRecordings { mut jobs, missing } = found_recordings(source, data_root)?;
    if !missing.is_empty() {
        let root = data_root.unwrap_or(&source.folder);
        let (logs, recordings): (Vec<_>, Vec<_>) = missing.into_iter().partition(|missing| missing.is_log);
        return Err(match logs.first().filter(|_| recordings.is_empty()) {
            Some(log) => missing_log(log, logs.len(), source, root),
            None => missing_failure(&recordings, source, root, data_root.is_some()),
        });
    }
    refuse_twice(&mut jobs, source)?;
    Ok(jobs)
}

/// Refuses two recordings that are the same.
pub(super) fn refuse_twice(jobs: &mut [LoadJob], source: &ExperimentSource) -> Result<(), Failure> {
    let (hint, path) = advice_on_copies(source);
    refuse_copies(jobs.iter_mut().map(|LoadJob { job, .. }| job), hint, path)
}

/// What to do about two recordings that are the same, and in which file.
pub(super) fn advice_on_copies(source: &ExperimentSource) -> (&'static str, Option<&Path>) {
    match source.typed {
        Some(_) => (GIVE_ONE, None),
        None => ("remove one of the two from the experiment file, or from the folder", Some(source.path.as_path())),
    }
}

/// All recordings, load by load, as far as there are files.
pub(super) fn found_recordings<'a>(
    source: &'a ExperimentSource,
    data_root: Option<&Path>,
) -> Result<FoundRecordings<'a>, Failure> {
    let root = data_root.unwrap_or(&source.folder);
    if !root.is_dir() && data_root.is_some() {
        let hint = "correct the name after --data-root: it must be the folder that holds the recordings";
        return Err(Failure::failed("there is no such folder", hint, root));
    }
    let (mut jobs, mut missing): (Vec<LoadJob>, Vec<Missing<'_>>) = (Vec::new(), Vec::new());
    let mut named: Vec<(&str, &str)> = Vec::new();
    for load in &source.experiment.loads {
        for recording in &load.recordings {
            let name = recording.file();
            let is_piped = is_stdin(Path::new(name));
            let files: Vec<PathBuf> = match is_piped {
                true => vec![recording_of_stdin()?],
                false => files_at(&place_of(name, root)),
            };
            if files.is_empty() {
                missing.push(Missing { load, name, is_log: false });
            }
            if recording.log().is_some() && files.len() > 1 {
                return Err(several_with_one_log(name, files.len(), source));
            }
            let log = recording.log().map(|name| LogFile { path: place_of(name, root), name: name.to_owned() });
            if let (Some(log), Some(name)) = (&log, recording.log())
                && !log.path.is_file()
            {
                missing.push(Missing { load, name, is_log: true });
            }
            for path in files {
                let job = Job {
                    name: if is_piped { name_of(Path::new(name)) } else { name_below(&path, root) },
                    path,
                    config: load.config(&source.experiment),
                    discovery: None,
                    requests: Requests::default(),
                    sha256: None,
                    samples: None,
                };
                // a pattern may hold a file that is named as well; two equal names are refused as copies are
                let is_known = |known: &LoadJob| known.load == load.name && known.job.path == job.path;
                let is_named_again = !is_pattern(name) && named.contains(&(load.name.as_str(), name));
                if is_named_again || !jobs.iter().any(is_known) {
                    jobs.push(LoadJob { job, load: load.name.clone(), log: log.clone() });
                }
            }
            named.push((load.name.as_str(), name));
        }
    }
    Ok(FoundRecordings { jobs, missing })
}

/// The failure of a log that belongs to more than one recording.
fn several_with_one_log(name: &str, count: usize, source: &ExperimentSource) -> Failure {
    Failure::Usage {
        what: format!("a log belongs to one flight, but {name} matches {count} recordings"),
        hint: "name each recording with its own log: { file = \"a.wav\", log = \"a.ulg\" }".to_owned(),
        path: Some(source.path.clone()),
    }
}

/// The files of a name or pattern; of a folder, its recordings.
fn files_at(place: &Path) -> Vec<PathBuf> {
    if place.is_dir() {
        return groups_in(place).into_iter().flat_map(|group| group.files).collect();
    }
    files_of(place).into_iter().filter(|file| file.is_file()).collect()
}

/// The place that a name or pattern means, from the folder of the recordings.
fn place_of(name: &str, root: &Path) -> PathBuf {
    root.join(home_expanded(Path::new(name)))
}

/// Name of a recording relative to the folder, with forward slashes on all systems.
fn name_below(path: &Path, root: &Path) -> String {
    path.strip_prefix(root).unwrap_or(path).display().to_string().replace('\\', "/")
}

/// The failure of an experiment with all recordings, and without all logs.
fn missing_log(log: &Missing<'_>, count: usize, source: &ExperimentSource, root: &Path) -> Failure {
    let Notice { text, hint, .. } = log.notice(root);
    let more = match count {
        1 => String::new(),
        count => format!("; {} more (--check lists all)", counted(count - 1, "missing log")),
    };
    Failure::failed(format!("{text}{more}"), hint, &source.path)
}

fn missing_failure(missing: &[Missing<'_>], source: &ExperimentSource, root: &Path, is_root_given: bool) -> Failure {
    if let Some(folder) = missing.iter().find_map(|missing| closed_folder(&place_of(missing.name, root))) {
        return Failure::failed(CLOSED_FOLDER, GET_RIGHT, &folder);
    }
    if let Some(folder) = missing.iter().find_map(|missing| folder_without_recordings(&place_of(missing.name, root))) {
        return Failure::failed(folder.what, folder.hint, &folder.path);
    }
    let listed = missing.iter().take(NAMES_MAX).map(|Missing { load, name, .. }| {
        let nearby = nearby(&place_of(name, root)).map_or(String::new(), |nearby| format!(" ({nearby})"));
        format!("{name} of load \"{}\"{nearby}", load.name)
    });
    let mut list = listed.collect::<Vec<_>>().join(", ");
    if missing.len() > NAMES_MAX {
        list += &format!(" and {} more (--check lists all)", missing.len() - NAMES_MAX);
    }
    let folder = if root.as_os_str().is_empty() { "this folder".to_owned() } else { root.display().to_string() };
    let notes = if source.has_notes {
        "; the notes at the top of the experiment file may say where to get the recordings"
    } else {
        ""
    };
    let what = format!("no file in {folder} matches {list}");
    let is_list = |missing: &&Missing<'_>| missing.name.split(',').all(|part| place_of(part.trim(), root).is_file());
    let hint = if let Some(list) = missing.iter().find(is_list) {
        format!("a comma does not separate recordings: give {} as separate names", list.name.replace(',', " and "))
    } else if source.typed.is_some() {
        "correct the names: they are relative to the current folder, or to the folder of --data-root".to_owned()
    } else if is_root_given {
        format!("correct the names, put the files into the folder of --data-root, or give another folder{notes}")
    } else {
        format!(
            "correct the names, put the files beside the experiment file, or give their folder: --data-root DIR{notes}"
        )
    };
    match source.typed {
        Some(_) => Failure::Failed { what, hint, path: None },
        None => Failure::failed(what, hint, &source.path),
    }
}

/// A folder that is named in place of its recordings and holds none.
struct EmptyFolder {
    path: PathBuf,
    what: &'static str,
    hint: String,
}

/// What to say of a folder that holds no recording itself: the folders below it that do.
fn folder_without_recordings(place: &Path) -> Option<EmptyFolder> {
    let is_named = place.is_dir() && groups_in(place).is_empty();
    let below = is_named.then(|| groups_below(place))?;
    let shown: Vec<String> = below.iter().take(NAMES_MAX).map(in_words).collect();
    let hint = match shown.is_empty() {
        true => "give a folder that holds recordings".to_owned(),
        false => format!("give a folder below it, such as {}", shown.join(", ")),
    };
    Some(EmptyFolder { path: place.to_owned(), what: "this folder holds no recording", hint })
}

/// "a/*.wav (3 files)".
fn in_words(group: &RecordingGroup) -> String {
    format!("{} ({})", group.pattern.display(), counted(group.files.len(), "file"))
}

/// What is in the folder of a pattern that matches nothing: often the ending of the recordings is spelled otherwise, or there is no such folder.
fn nearby(pattern: &Path) -> Option<String> {
    if let Some(folder) = missing_folder(pattern) {
        return Some(format!("there is no folder {}", folder.display()));
    }
    let folder = pattern.parent()?;
    let groups = groups_in(folder);
    let shown: Vec<String> = groups.iter().map(in_words).collect();
    (!shown.is_empty()).then(|| format!("the folder has {}", shown.join(", ")))
}
