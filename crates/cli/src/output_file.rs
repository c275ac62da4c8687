//! A file that is written beside its place and then renamed: an interrupt leaves the old file or the new one, never half of it.

use crate::failure::Failure;
use crate::file_list::FileList;
use crate::temporary_file::TemporaryFile;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Last part of the name of a file that is not finished.
const UNFINISHED: &str = ".hovertone-unfinished";
/// Last part of the name of a file that only keeps runs apart.
pub(crate) const LOCK: &str = ".hovertone-lock";

/// An output file that is not finished. Dropped without [`OutputFile::keep`], it leaves what was there before.
pub(crate) struct OutputFile {
    /// The place that the user named, for messages.
    place: PathBuf,
    /// The place itself, behind symbolic links.
    target: PathBuf,
    /// The file beside it; absent for a terminal, a pipe or another device, which is written directly.
    unfinished: Option<TemporaryFile>,
    file: File,
    /// Its entry in the list of its folder.
    entry: Option<Entry>,
}

/// A list of files, and a name for it.
struct Entry {
    list: FileList,
    name: String,
}

impl OutputFile {
    /// Begins a file. The old file stays as it is until [`OutputFile::keep`].
    pub(crate) fn create(place: &Path) -> Result<Self, Failure> {
        Self::begin(place).map_err(|error| Failure::cannot_write(&error, place))
    }

    fn begin(place: &Path) -> io::Result<Self> {
        let old = fs::metadata(place).ok();
        if old.as_ref().is_some_and(fs::Metadata::is_dir) {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "this is a folder"));
        }
        if old.as_ref().is_some_and(|old| !old.is_file()) {
            let file = File::options().write(true).open(place)?;
            return Ok(Self { place: place.to_owned(), target: place.to_owned(), unfinished: None, file, entry: None });
        }
        if old.as_ref().is_some_and(|old| old.permissions().readonly()) {
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, "this file is protected against writing"));
        }
        // a symbolic link stays a link
        let target = if old.is_some() { fs::canonicalize(place)? } else { place.to_owned() };
        remove_unfinished(&target);
        let unfinished = beside(&target, &format!(".{}{UNFINISHED}", std::process::id()))?;
        let (unfinished, file) = TemporaryFile::create(unfinished)?;
        let begun = Self { place: place.to_owned(), target, unfinished: Some(unfinished), file, entry: None };
        if let Some(old) = old {
            begun.file.set_permissions(old.permissions())?;
        }
        Ok(begun)
    }

    /// The same file, which is put into a list of files when it is finished.
    pub(crate) fn listed(mut self, list: FileList, name: String) -> Self {
        self.entry = Some(Entry { list, name });
        self
    }

    /// A handle for writing; all handles share one position.
    pub(crate) fn handle(&self) -> Result<File, Failure> {
        self.file.try_clone().map_err(|error| Failure::cannot_write(&error, &self.place))
    }

    /// The place that the user named.
    pub(crate) fn place(&self) -> &Path {
        &self.place
    }

    /// Puts the finished file into its place.
    pub(crate) fn keep(mut self) -> Result<(), Failure> {
        let Some(unfinished) = self.unfinished.take() else { return Ok(()) };
        // the list comes first: after an interrupt it may name a file that is not there, but no file lacks its name
        let listed = self.entry.as_ref().map_or(Ok(()), |entry| entry.add(unfinished.path()));
        listed
            .and_then(|()| unfinished.rename(&self.target))
            .map_err(|error| Failure::cannot_write(&error, &self.place))?;
        self.entry.as_ref().map_or(Ok(()), Entry::drop_earlier)
    }
}

impl Entry {
    /// Adds the line of the file with this content. Those of its earlier content stay until [`Entry::drop_earlier`].
    fn add(&self, content: &Path) -> io::Result<()> {
        let line = FileList::line(&self.name, content)?;
        let _alone = self.list.turn();
        File::options().append(true).open(self.list.place())?.write_all(line.as_bytes())
    }

    /// Drops the lines of the earlier content.
    fn drop_earlier(&self) -> Result<(), Failure> {
        let _alone = self.list.turn();
        let Some(text) = self.list.without_earlier(&self.name) else { return Ok(()) };
        let (place, output) = (self.list.place(), OutputFile::create(&self.list.place())?);
        output.handle()?.write_all(text.as_bytes()).map_err(|error| Failure::cannot_write(&error, &place))?;
        output.keep()
    }
}

/// A file that only keeps runs apart; it stays empty.
#[cfg(feature = "archive")]
pub(crate) fn open_lock(place: &Path) -> Result<File, Failure> {
    let file = File::options().create(true).append(true).open(place);
    file.map_err(|error| Failure::cannot_write(&error, place))
}

/// Removes a file that an earlier run wrote. Returns whether it was there.
#[cfg(feature = "archive")]
pub(crate) fn remove_written(place: &Path) -> Result<bool, Failure> {
    match fs::remove_file(place) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(Failure::cannot_write(&error, place)),
    }
}

/// Whether a file of this name is none of the user's: an interrupted run left it, or it is a lock.
pub(crate) fn is_left_by_run(name: &OsStr) -> bool {
    [UNFINISHED, LOCK].iter().any(|ending| name.as_encoded_bytes().ends_with(ending.as_bytes()))
}

/// The hidden name ".NAME" with an ending, in the same folder: a file can be renamed only within one file system.
fn beside(target: &Path, ending: &str) -> io::Result<PathBuf> {
    let name = target.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "this names no file"))?;
    let mut hidden = OsString::from(".");
    hidden.push(name);
    hidden.push(ending);
    Ok(target.with_file_name(hidden))
}

/// Removes what interrupted runs left of this file.
fn remove_unfinished(target: &Path) {
    let Ok(begin) = beside(target, ".") else { return };
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (Some(begin), Ok(entries)) = (begin.file_name().map(OsStr::to_owned), fs::read_dir(folder)) else { return };
    for entry in entries.filter_map(Result::ok) {
        if is_unfinished(&entry.file_name(), &begin) {
            // where it cannot be removed it only takes space
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether a name is `begin`, the number of a process, and the ending of unfinished files.
fn is_unfinished(name: &OsStr, begin: &OsStr) -> bool {
    let name = name.as_encoded_bytes();
    let process = name.strip_prefix(begin.as_encoded_bytes()).and_then(|rest| rest.strip_suffix(UNFINISHED.as_bytes()));
    process.is_some_and(|process| !process.is_empty() && process.iter().all(u8::is_ascii_digit))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names_in(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn the_old_file_stays_until_the_new_one_is_finished() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("x.csv");
        fs::write(&place, "old").unwrap();
        let output = OutputFile::create(&place).unwrap();
        output.handle().unwrap().write_all(b"half of").unwrap();
        assert_eq!(fs::read_to_string(&place).unwrap(), "old");
        drop(output);
        assert_eq!(
            (fs::read_to_string(&place).unwrap().as_str(), names_in(folder.path())),
            ("old", vec!["x.csv".into()])
        );
        let output = OutputFile::create(&place).unwrap();
        output.handle().unwrap().write_all(b"new").unwrap();
        output.keep().unwrap();
        assert_eq!(
            (fs::read_to_string(&place).unwrap().as_str(), names_in(folder.path())),
            ("new", vec!["x.csv".into()])
        );
    }

    #[test]
    fn what_an_interrupted_run_left_is_removed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            ".x.csv.123.hovertone-unfinished",
            ".x.csv.notes.hovertone-unfinished",
            ".x.csv.123",
            ".y.csv.123.hovertone-unfinished",
        ] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        OutputFile::create(&folder.path().join("x.csv")).unwrap().keep().unwrap();
        let kept = [".x.csv.123", ".x.csv.notes.hovertone-unfinished", ".y.csv.123.hovertone-unfinished", "x.csv"];
        assert_eq!(names_in(folder.path()), kept);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_a_device_a_device() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let output = OutputFile::create(&link).unwrap();
        output.handle().unwrap().write_all(b"new").unwrap();
        output.keep().unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
        let null = Path::new("/dev/null");
        OutputFile::create(null).unwrap().keep().unwrap();
        assert!(!fs::metadata(null).unwrap().is_file());
    }

    #[test]
    fn a_protected_file_is_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("x.csv");
        fs::write(&place, "old").unwrap();
        let mut rights = fs::metadata(&place).unwrap().permissions();
        rights.set_readonly(true);
        fs::set_permissions(&place, rights).unwrap();
        assert!(OutputFile::create(&place).is_err() && OutputFile::create(folder.path()).is_err());
        assert_eq!(names_in(folder.path()), ["x.csv"]);
    }
}
