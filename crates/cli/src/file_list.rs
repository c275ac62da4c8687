//! The list of the files that a run wrote into its folder, with their hashes: by it a later run knows which of them nobody changed.

use crate::files::sha256_of_file;
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Name of the list. `sha256sum --check` reads it.
const NAME: &str = "files.sha256";

/// The list of a folder.
#[derive(Clone)]
pub(crate) struct FileList {
    folder: PathBuf,
    /// First line, which names the run.
    head: String,
}

impl FileList {
    /// The list in a folder of a run, which the words tell from all others.
    pub(crate) fn of(folder: &Path, run: &str) -> Self {
        Self { folder: folder.to_owned(), head: format!("# hovertone {run}") }
    }

    /// Path of the list.
    pub(crate) fn place(&self) -> PathBuf {
        self.folder.join(NAME)
    }

    /// Whether an earlier run of the same kind wrote the folder.
    pub(crate) fn is_of_same_run(&self) -> bool {
        self.text().lines().next() == Some(self.head.as_str())
    }

    /// Names of the listed files.
    pub(crate) fn names(&self) -> BTreeSet<String> {
        self.text().lines().filter_map(listed).map(|file| file.name.to_owned()).collect()
    }

    /// Whether a file is still as a run wrote it.
    pub(crate) fn has_unchanged(&self, name: &str) -> bool {
        let text = self.text();
        let Ok(sha256) = sha256_of_file(&self.folder.join(name)) else { return false };
        text.lines().filter_map(listed).any(|file| file.name == name && file.sha256 == sha256)
    }

    /// The text with which this run begins: with the files of earlier runs of the same kind.
    pub(crate) fn beginning(&self) -> String {
        let kept = self.text();
        let kept = if self.is_of_same_run() { kept.trim_end() } else { &self.head };
        format!("{kept}\n")
    }

    /// The line for a file with the content of another.
    pub(crate) fn line(name: &str, content: &Path) -> io::Result<String> {
        Ok(format!("{}  {name}\n", sha256_of_file(content)?))
    }

    /// The text of the list; empty where there is none.
    fn text(&self) -> String {
        fs::read_to_string(self.place()).unwrap_or_default()
    }
}

/// A listed file.
struct Listed<'a> {
    sha256: &'a str,
    name: &'a str,
}

fn listed(line: &str) -> Option<Listed<'_>> {
    let (sha256, name) = line.split_once("  ").filter(|_| !line.starts_with('#'))?;
    Some(Listed { sha256, name })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_listed_file_is_known_until_it_is_changed() {
        let folder = tempfile::tempdir().unwrap();
        let list = FileList::of(folder.path(), "identify abc");
        assert!(!list.is_of_same_run() && list.names().is_empty());
        fs::write(list.place(), list.beginning()).unwrap();
        let file = folder.path().join("a b.csv");
        fs::write(&file, "old").unwrap();
        assert!(!list.has_unchanged("a b.csv"), "it is not listed");
        fs::write(list.place(), list.beginning() + &FileList::line("a b.csv", &file).unwrap()).unwrap();
        assert!(list.has_unchanged("a b.csv") && list.is_of_same_run());
        fs::write(&file, "changed").unwrap();
        assert!(!list.has_unchanged("a b.csv"));
        assert_eq!(list.names().into_iter().collect::<Vec<_>>(), ["a b.csv"]);
        assert!(!FileList::of(folder.path(), "identify abd").is_of_same_run());
    }
}
