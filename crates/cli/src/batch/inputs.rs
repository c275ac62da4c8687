//! The recordings of an archive, from what was typed.

use crate::failure::Failure;
use crate::files::{files_of, home_expanded, is_pattern, missing_folder, sha256_of_bytes};
use crate::inputs::{is_stdin, read_text};
use crate::recording_files::{has_ending_of_recording, recordings_below};
use crate::stored::{self, StoredRecording, is_address};
use hovertone_archive::{BatchIdentity, Plan};
use hovertone_report::counted;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{self, Path, PathBuf};
use std::time::UNIX_EPOCH;

/// Ending of a list of recordings.
const LIST: &str = "txt";
/// The mark that some editors write before the first letter of a text.
const BYTE_ORDER_MARK: char = '\u{feff}';
/// Letters of a hash that tell two lists from each other in a message.
const HASH_LETTERS: usize = 16;

/// All recordings of a run.
pub(crate) struct Recordings {
    /// In the order in which they were found, each once.
    pub(crate) found: Vec<Found>,
    /// Number and hash of the names that came from stdin, in any order.
    pub(crate) list_from_stdin: Option<String>,
}

/// The names of recordings in the tables, and how to find them.
pub(crate) struct Names {
    names: Vec<String>,
    /// The paths that are no text, which their names only resemble.
    odd: BTreeMap<String, PathBuf>,
    /// Those in stores, where the store has told what tells them from earlier ones.
    stored: BTreeMap<String, String>,
}

/// A recording that was found.
pub(crate) struct Found {
    pub(crate) path: PathBuf,
    /// What tells it from an earlier one of the same name, where it is known already.
    state: Option<String>,
}

impl Found {
    fn file(path: PathBuf) -> Self {
        Self { path, state: None }
    }
}

impl From<StoredRecording> for Found {
    fn from(stored: StoredRecording) -> Self {
        Self { path: stored.path, state: Some(stored.state) }
    }
}

impl AsRef<Path> for Found {
    fn as_ref(&self) -> &Path {
        &self.path
    }
}

impl Names {
    /// Of these recordings.
    pub(crate) fn of(recordings: &[Found]) -> Result<Self, Failure> {
        let (mut names, mut odd, mut stored) = (Vec::new(), BTreeMap::new(), BTreeMap::new());
        for Found { path, state } in recordings {
            let name = path.to_string_lossy().into_owned();
            if path.to_str().is_none() && odd.insert(name.clone(), path.clone()).is_some_and(|other| other != *path) {
                let what = "the names of two recordings are not valid UTF-8 text, and they look the same in a table";
                return Err(Failure::failed(what, "rename one of the two files", path));
            }
            if let Some(state) = state {
                stored.insert(name.clone(), state.clone());
            }
            names.push(name);
        }
        Ok(Self { names, odd, stored })
    }

    /// The plan, in the order of the names.
    pub(crate) fn plan(&self) -> Plan {
        Plan::of(self.names.clone(), |name| {
            self.stored.get(name).cloned().unwrap_or_else(|| state_of(&self.path(name)))
        })
    }

    /// The path of a recording.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.odd.get(name).cloned().unwrap_or_else(|| PathBuf::from(name))
    }
}

/// The recordings in the order in which they were found. A name of a list that leads nowhere stays, so that it has a row with its error.
pub(crate) fn recordings_of(typed: &[PathBuf]) -> Result<Recordings, Failure> {
    let mut found = Vec::new();
    let mut list_from_stdin = None;
    for input in typed {
        let of_input = recordings_of_one(input)?;
        if of_input.is_empty() {
            let (what, hint) = match input {
                input if input.is_dir() => (
                    "this folder has no recordings",
                    "hovertone finds recordings by the endings of their names, such as .wav or .mp4",
                ),
                input if is_list(input) => {
                    ("this list names no recording", "write the name of a recording on each line")
                }
                input if is_address(input) => (
                    "there are no recordings at this address",
                    "hovertone finds recordings by the endings of their names, such as .wav or .mp4",
                ),
                pattern if missing_folder(pattern).is_some() => {
                    ("there is no such folder: no file matches this pattern", "correct the name of the folder")
                }
                pattern if !below_matches(pattern).is_empty() => (
                    "the folders that match this pattern have no recordings",
                    "hovertone finds recordings by the endings of their names, such as .wav or .mp4",
                ),
                _ => ("no file matches this pattern", "check the folder and the ending in the pattern, such as *.wav"),
            };
            return Err(Failure::failed(what, hint, input));
        }
        if is_stdin(input) {
            list_from_stdin = Some(list_in_short(&of_input));
        }
        found.extend(of_input);
    }
    let mut places = BTreeSet::new();
    found.retain(|one| places.insert(place_of(&one.path)));
    Ok(Recordings { found, list_from_stdin })
}

/// The inputs in the spelling of an earlier run, where they are the same files and folders: then its recordings keep their names.
pub(crate) fn spelled_as_before(typed: &[PathBuf], before: &BatchIdentity) -> Vec<PathBuf> {
    let is_same = |(one, other): (&PathBuf, &String)| {
        one.to_string_lossy() == *other || (!is_stdin(one) && place_of(one) == place_of(Path::new(other)))
    };
    if typed.len() != before.inputs.len() || !typed.iter().zip(&before.inputs).all(is_same) {
        return typed.to_vec();
    }
    let spelled = |(one, other): (&PathBuf, &String)| {
        // a name that is no text is in the earlier run only what it looks like
        if one.to_string_lossy() == *other { one.clone() } else { PathBuf::from(other) }
    };
    typed.iter().zip(&before.inputs).map(spelled).collect()
}

/// A file or folder whatever its spelling, behind symbolic links; where it is not there, its name in its folder. An address stays as it is.
fn place_of(path: &Path) -> PathBuf {
    if is_address(path) || is_stdin(path) {
        return path.to_owned();
    }
    let path = home_expanded(path);
    let in_folder = |path: &Path| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Some(fs::canonicalize(folder).ok()?.join(path.file_name()?))
    };
    let there = fs::canonicalize(&path).ok().or_else(|| in_folder(&path));
    there.or_else(|| path::absolute(&path).ok()).unwrap_or(path)
}

fn list_in_short(found: &[Found]) -> String {
    let names: BTreeSet<String> = found.iter().map(|one| one.path.to_string_lossy().into_owned()).collect();
    let hash = sha256_of_bytes(names.iter().map(|name| format!("{name}\n")).collect::<String>().as_bytes());
    format!("{} (SHA-256 {})", counted(names.len(), "name"), hash.get(..HASH_LETTERS).unwrap_or(&hash))
}

fn recordings_of_one(input: &Path) -> Result<Vec<Found>, Failure> {
    if is_list(input) && !input.is_dir() {
        return names_in(input);
    }
    if is_address(input) {
        return Ok(stored::recordings_at(input)?.into_iter().map(Found::from).collect());
    }
    Ok(files_of_one(input)?.into_iter().map(Found::file).collect())
}

fn files_of_one(input: &Path) -> Result<Vec<PathBuf>, Failure> {
    if input.is_dir() {
        return Ok(sorted_below(input));
    }
    let files = files_of(input);
    if files.is_empty() {
        return Ok(below_matches(input).into_iter().filter(|path| has_ending_of_recording(path)).collect());
    }
    let is_missing = |path: &PathBuf| !path.exists();
    match files.iter().find(|path| is_missing(path)) {
        Some(path) if !is_pattern(&path.to_string_lossy()) => {
            let hint = "check the name; give a folder, a pattern such as *.wav, a recording, or a text file (.txt) \
                        with a name on each line";
            Err(Failure::failed("there is no such file or folder", hint, path))
        }
        _ => Ok(files
            .into_iter()
            .flat_map(|path| if path.is_dir() { sorted_below(&path) } else { vec![path] })
            .collect()),
    }
}

/// All files in the folders that a pattern matches, at any depth.
fn below_matches(pattern: &Path) -> Vec<PathBuf> {
    files_of(&pattern.join("**"))
}

/// In the order of the names: of two names of one file, the first is the same one on every disk.
fn sorted_below(folder: &Path) -> Vec<PathBuf> {
    let mut found = recordings_below(folder);
    found.sort();
    found
}

fn is_list(input: &Path) -> bool {
    is_stdin(input) || input.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(LIST))
}

/// The names in a list. Those in a file are relative to its folder, those from stdin to the current one.
fn names_in(list: &Path) -> Result<Vec<Found>, Failure> {
    let text = if is_address(list) { stored::text_of(list)? } else { read_text(list, "a list of recordings")? };
    let folder = if is_stdin(list) { Path::new("") } else { list.parent().unwrap_or(Path::new("")) };
    let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&text);
    let names = text.lines().map(str::trim_end).filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let path = |name: &str| match Path::new(name) {
        name if is_address(name) => name.to_owned(),
        name => folder.join(home_expanded(name)),
    };
    let paths: Vec<PathBuf> = names.map(path).collect();
    stored::refuse_addresses(&paths)?;
    // a store is asked for each of them, so that some are asked at the same time
    Ok(paths
        .into_par_iter()
        .map(|path| Found { state: is_address(&path).then(|| stored::state_of(&path)), path })
        .collect())
}

/// Length and time of change of a file, by which one that changed is heard again. They stand in no table.
fn state_of(path: &Path) -> String {
    let Ok(facts) = fs::metadata(path) else { return "absent".to_owned() };
    let changed = facts.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    format!("{} {}", facts.len(), changed.unwrap_or_default().as_nanos())
}
