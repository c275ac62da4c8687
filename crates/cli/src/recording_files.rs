//! Recordings in a folder, known by their endings: what `init` offers, and what a message about a missing file names.

use crate::caller::command_word;
use crate::files::{files_of, home_expanded, is_pattern, missing_folder};
use crate::inputs::is_stdin;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Endings of files with sound, in lower case.
const ENDINGS: [&str; 22] = [
    "3gp", "aac", "aif", "aiff", "avi", "caf", "flac", "m4a", "m4v", "mka", "mkv", "mov", "mp3", "mp4", "mts", "oga",
    "ogg", "opus", "ts", "wav", "webm", "wma",
];

/// The commands that hear one recording at a time.
const WITH_ONE_RECORDING: [&str; 5] = ["spectrogram", "calibrate", "verify", "greybox", "listen"];

/// Recordings of one folder with one ending.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RecordingGroup {
    /// The pattern that matches them all.
    pub(crate) pattern: PathBuf,
    /// The recordings, sorted.
    pub(crate) files: Vec<PathBuf>,
}

/// The recordings of a folder, a group for each ending as it is spelled.
pub(crate) fn groups_in(folder: &Path) -> Vec<RecordingGroup> {
    let mut groups: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for path in entries_of(folder).into_iter().filter(|path| path.is_file()) {
        if let Some(ending) = ending_of(&path) {
            groups.entry(ending).or_default().push(path);
        }
    }
    let group = |(ending, mut files): (String, Vec<PathBuf>)| {
        files.sort();
        RecordingGroup { pattern: folder.join(format!("*.{ending}")), files }
    };
    groups.into_iter().map(group).collect()
}

/// The names that a typed folder, file or pattern means: patterns of all recordings of a folder, else itself; none where no file is there.
pub(crate) fn recordings_of(typed: &str, folder: &Path) -> Vec<String> {
    let path = home_expanded(&folder.join(typed));
    if path.is_dir() {
        return groups_in(&path).iter().map(|group| group.pattern.to_string_lossy().replace('\\', "/")).collect();
    }
    let is_there = is_stdin(Path::new(typed)) || files_of(&path).iter().any(|file| file.is_file());
    if is_there { vec![typed.to_owned()] } else { Vec::new() }
}

/// The recordings of all folders in a folder.
pub(crate) fn groups_below(folder: &Path) -> Vec<RecordingGroup> {
    let mut folders: Vec<PathBuf> = entries_of(folder).into_iter().filter(|path| path.is_dir()).collect();
    folders.sort();
    folders.iter().flat_map(|folder| groups_in(folder)).collect()
}

/// What to say of a name that is no recording: a folder, or a pattern. `None` for any other.
pub(crate) fn of_wrong_kind(path: &Path) -> Option<String> {
    if path.is_dir() {
        return Some(folder_in_words(path));
    }
    (!path.exists() && is_pattern(&path.to_string_lossy())).then(|| pattern_in_words(path))
}

/// What to say of a folder in place of a recording: which recordings it holds.
fn folder_in_words(folder: &Path) -> String {
    let (inside, below) = (groups_in(folder), groups_below(folder));
    let first = inside.first().or(below.first());
    let hears_one = WITH_ONE_RECORDING.contains(&command_word().as_str());
    let advice = match first.and_then(|group| Some((group, group.files.first()?))) {
        Some((group, file)) if group.files.len() > 1 && !hears_one => {
            format!(
                "give a recording in the folder, such as {}, or several recordings, such as {}",
                file.display(),
                group.pattern.display()
            )
        }
        Some((group, file)) if group.files.len() > 1 => {
            format!("give a recording in the folder, such as {}", file.display())
        }
        Some((_, file)) => format!("give the recording in the folder: {}", file.display()),
        None => "the folder holds no recordings, so give the name of a recording".to_owned(),
    };
    format!("this is a folder, not a recording; {advice}")
}

/// What to say of a pattern where one recording is needed.
fn pattern_in_words(pattern: &Path) -> String {
    match files_of(pattern).iter().filter(|file| file.is_file()).collect::<Vec<_>>().as_slice() {
        [] => match missing_folder(pattern) {
            Some(folder) => {
                format!("no file matches this pattern: there is no folder {}; correct its name", folder.display())
            }
            None => {
                "no file matches this pattern; check the folder and the ending in the pattern, such as *.wav".to_owned()
            }
        },
        [first, ..] => {
            format!(
                "this is a pattern, but this command hears one recording at a time; give one recording, such as {}",
                first.display()
            )
        }
    }
}

/// All recordings in a folder and the folders below it, by their endings; links to folders are not followed.
#[cfg(feature = "archive")]
pub(crate) fn recordings_below(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(folder) = open.pop() {
        for path in entries_of(&folder) {
            match path.is_dir() {
                true if !path.is_symlink() => open.push(path),
                false if ending_of(&path).is_some() => found.push(path),
                _ => {}
            }
        }
    }
    found
}

/// Whether a name has the ending of a recording.
pub(crate) fn has_ending_of_recording(path: &Path) -> bool {
    ending_of(path).is_some()
}

/// The ending of a recording as it is spelled; `None` for other files.
fn ending_of(path: &Path) -> Option<String> {
    let ending = path.extension()?.to_str()?;
    ENDINGS.contains(&ending.to_lowercase().as_str()).then(|| ending.to_owned())
}

/// What is in a folder, without hidden names; empty where it cannot be read. The folder "" is the current one.
fn entries_of(folder: &Path) -> Vec<PathBuf> {
    let read = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let names = fs::read_dir(read).into_iter().flatten().filter_map(Result::ok).map(|entry| entry.file_name());
    names.filter(|name| !name.as_encoded_bytes().starts_with(b".")).map(|name| folder.join(name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_told_by_its_recordings() {
        let folder = tempfile::tempdir().unwrap();
        let said = || folder_in_words(folder.path()).replace(&format!("{}/", folder.path().display()), "");
        assert_eq!(
            said(),
            "this is a folder, not a recording; the folder holds no recordings, so give the name of a recording"
        );
        fs::create_dir(folder.path().join("a")).unwrap();
        fs::write(folder.path().join("a/1.wav"), "").unwrap();
        assert!(said().ends_with("give the recording in the folder: a/1.wav"), "{}", said());
        fs::write(folder.path().join("a/2.wav"), "").unwrap();
        assert!(said().ends_with("such as a/1.wav, or several recordings, such as a/*.wav"), "{}", said());
    }

    #[test]
    fn recordings_are_grouped_by_folder_and_ending() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a/2.MOV", "a/1.MOV", "a/notes.txt", "a/._1.MOV", "b/x.wav", "b/y.mov", ".hidden/z.mov", "c.flac"]
        {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        let shown = |groups: Vec<RecordingGroup>| -> Vec<String> {
            let short = |path: &Path| path.strip_prefix(folder.path()).unwrap().display().to_string();
            groups.iter().map(|group| format!("{} {}", short(&group.pattern), group.files.len())).collect()
        };
        assert_eq!(shown(groups_below(folder.path())), ["a/*.MOV 2", "b/*.mov 1", "b/*.wav 1"]);
        assert_eq!(shown(groups_in(folder.path())), ["*.flac 1"]);
        assert!(groups_in(&folder.path().join("missing")).is_empty());
    }
}
