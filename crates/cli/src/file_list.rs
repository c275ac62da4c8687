//! The list of the files that a run wrote into its folder, with their hashes: by it a later run knows which of them nobody changed.

use crate::files::sha256_of_file;
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Name of the list. `sha256sum --check` reads it.
pub(crate) const NAME: &str = "files.sha256";

/// The list of a folder.
#[derive(Clone)]
pub(crate) struct FileList {
    folder: PathBuf,
    /// First line, which names the run.
    head: String,
    turn: Arc<Mutex<()>>,
}

impl FileList {
    /// The list in a folder of a run, which the words tell from all others.
    pub(crate) fn of(folder: &Path, run: &str) -> Self {
        Self { folder: folder.to_owned(), head: format!("# hovertone {run}"), turn: Arc::default() }
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

    /// The text with which this run begins: one line for each file of earlier runs of the same kind that is still there.
    pub(crate) fn beginning(&self) -> String {
        let mut kept = format!("{}\n", self.head);
        if self.is_of_same_run() {
            let text = self.text();
            kept.extend(self.names().iter().filter_map(|name| self.line_of_earlier_run(&text, name)));
        }
        kept
    }

    /// The line that is kept for a file: after an interrupt there are two, for the file before and after.
    fn line_of_earlier_run(&self, text: &str, name: &str) -> Option<String> {
        let sha256 = sha256_of_file(&self.folder.join(name)).ok()?;
        let lines = || text.lines().filter_map(listed).filter(|file| file.name == name);
        let kept = lines().find(|file| file.sha256 == sha256).or_else(|| lines().next_back())?;
        Some(kept.line())
    }

    /// The line for a file with the content of another.
    pub(crate) fn line(name: &str, content: &Path) -> io::Result<String> {
        Ok(Listed { sha256: &sha256_of_file(content)?, name }.line())
    }

    /// The text with the last line of a file alone; `None` where it has no more.
    pub(crate) fn without_earlier(&self, name: &str) -> Option<String> {
        let text = self.text();
        let is_of_file = |line: &str| listed(line).is_some_and(|file| file.name == name);
        let (of_file, others): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| is_of_file(line));
        let last = of_file.last().filter(|_| of_file.len() > 1)?;
        Some(others.iter().chain([last]).map(|line| format!("{line}\n")).collect())
    }

    /// The files of a run are written in parallel, and the list by one of them at a time.
    pub(crate) fn turn(&self) -> MutexGuard<'_, ()> {
        self.turn.lock().unwrap_or_else(PoisonError::into_inner)
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

impl Listed<'_> {
    fn line(&self) -> String {
        format!("{}  {}\n", self.sha256, self.name)
    }
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

    #[test]
    fn a_file_has_one_line_and_after_an_interrupt_that_of_its_content() {
        let folder = tempfile::tempdir().unwrap();
        let list = FileList::of(folder.path(), "identify abc");
        fs::write(list.place(), list.beginning()).unwrap();
        let write = |name: &str, content: &str| {
            let file = folder.path().join(name);
            fs::write(&file, content).unwrap();
            fs::write(list.place(), list.text() + &FileList::line(name, &file).unwrap()).unwrap();
        };
        write("a.csv", "first");
        write("b.csv", "other");
        assert_eq!(list.without_earlier("a.csv"), None);
        write("a.csv", "second");
        fs::write(list.place(), list.without_earlier("a.csv").unwrap()).unwrap();
        assert_eq!(list.text().lines().count(), 3, "{}", list.text());
        assert!(list.has_unchanged("a.csv") && list.has_unchanged("b.csv"));
        // an interrupt before the new file came into its place, and a file that is gone
        let new = folder.path().join("new");
        fs::write(&new, "third").unwrap();
        fs::write(list.place(), list.text() + &FileList::line("a.csv", &new).unwrap()).unwrap();
        fs::remove_file(folder.path().join("b.csv")).unwrap();
        fs::write(list.place(), list.beginning()).unwrap();
        assert!(list.has_unchanged("a.csv"));
        assert_eq!(list.text().lines().count(), 2, "{}", list.text());
    }
}
