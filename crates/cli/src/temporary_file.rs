//! Files that stand only while a run works. Its end removes them, and so does an interrupt, which says what it leaves.

use crate::file_list::NAME;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::NamedTempFile;

/// The temporary files of this run. An interrupt holds it until the process ends, so that no file comes after it.
static FILES: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Folders that this run writes into. An interrupt leaves them incomplete.
static FOLDERS: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Whether long work has begun, so that an interrupt is no ordinary end.
static IS_AT_WORK: AtomicBool = AtomicBool::new(false);

/// Whether a file of results has got its place.
static HAS_WRITTEN: AtomicBool = AtomicBool::new(false);

/// The process ends with this run: from now on an interrupt removes the temporary files and ends it. In a program that calls, interrupts are
/// that program's.
pub(crate) fn end_with_run() {
    #[cfg(unix)]
    interrupt::watch();
}

/// From now on an interrupt says what it leaves.
pub(crate) fn begin_work() {
    IS_AT_WORK.store(true, Ordering::Relaxed);
}

/// A file that is removed when it is dropped.
pub(crate) struct TemporaryFile {
    path: PathBuf,
}

impl TemporaryFile {
    /// A new file of this name.
    pub(crate) fn create(path: PathBuf) -> io::Result<(Self, File)> {
        Self::made(|| Ok((File::options().write(true).create_new(true).open(&path)?, path)))
    }

    /// A new file with a name of its own in the system's folder of temporary files; only its owner can read it.
    pub(crate) fn with_prefix(prefix: &str) -> io::Result<(Self, File)> {
        Self::made(|| Ok(NamedTempFile::with_prefix(prefix)?.keep()?))
    }

    fn made(make: impl FnOnce() -> io::Result<(File, PathBuf)>) -> io::Result<(Self, File)> {
        let mut files = files();
        let (file, path) = make()?;
        files.insert(path.clone());
        Ok((Self { path }, file))
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Puts the file into its place, where it stays.
    pub(crate) fn rename(self, place: &Path) -> io::Result<()> {
        let mut files = files();
        fs::rename(&self.path, place)?;
        files.remove(&self.path);
        // the list of a folder stands there before the results
        if place.file_name().is_none_or(|name| name != NAME) {
            HAS_WRITTEN.store(true, Ordering::Relaxed);
        }
        Ok(())
    }
}

impl Drop for TemporaryFile {
    fn drop(&mut self) {
        let mut files = files();
        if files.remove(&self.path) {
            // a failure to remove it leaves a file that the next run removes
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// A folder that is being written. After an interrupt its results are incomplete, and the interrupt says so.
pub(crate) struct BeingWritten {
    folder: PathBuf,
}

impl BeingWritten {
    pub(crate) fn begin(folder: &Path) -> Self {
        folders().insert(folder.to_owned());
        Self { folder: folder.to_owned() }
    }
}

impl Drop for BeingWritten {
    fn drop(&mut self) {
        folders().remove(&self.folder);
    }
}

fn folders() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    FOLDERS.lock().unwrap_or_else(PoisonError::into_inner)
}

fn files() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(unix)]
mod interrupt {
    use super::{HAS_WRITTEN, IS_AT_WORK, files, folders};
    use crate::failure::Failure;
    use crate::terminal::Terminal;
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;
    use std::io::{self, ErrorKind, IsTerminal};
    use std::path::Path;
    use std::sync::atomic::Ordering;

    /// From now on an interrupt removes the temporary files before it ends the process.
    pub(super) fn watch() {
        let ignored = ignored();
        let is_watched = |signal: &i32| ignored & 1 << (signal - 1) == 0;
        // without it an interrupt leaves files that the next run removes
        let watched = [SIGHUP, SIGINT, SIGTERM, SIGXFSZ].into_iter().filter(is_watched);
        let Ok(mut signals) = Signals::new(watched) else { return };
        // the write beyond a limit (`ulimit -f`) fails then, and has a message of its own
        std::thread::spawn(move || signals.forever().filter(|signal| *signal != SIGXFSZ).for_each(end));
    }

    /// The signals that the caller wants to be ignored, as `nohup` does, a bit for each; none where the system does not tell.
    fn ignored() -> u64 {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let bits = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        bits.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok()).unwrap_or(0)
    }

    fn end(signal: i32) {
        let files = files();
        if IS_AT_WORK.load(Ordering::Relaxed) && io::stderr().is_terminal() {
            Terminal::of_process().say(""); // below the bar of the progress
        }
        for file in files.iter() {
            match std::fs::remove_file(file) {
                Err(error) if error.kind() != ErrorKind::NotFound => {
                    Terminal::of_process().failure(&cannot_remove(&error, file));
                }
                _ => {}
            }
        }
        for folder in folders().iter() {
            Terminal::of_process().failure(&is_incomplete(folder));
        }
        if IS_AT_WORK.load(Ordering::Relaxed) && folders().is_empty() {
            let has_written = HAS_WRITTEN.load(Ordering::Relaxed);
            let words = if has_written { "interrupted" } else { "interrupted: no results were written" };
            Terminal::of_process().say(words);
        }
        // it ends the process as if nobody had watched: a shell with a loop around the command sees the interrupt
        let _ = emulate_default_handler(signal);
    }

    fn is_incomplete(folder: &Path) -> Failure {
        Failure::failed("interrupted: the results in this folder are incomplete", "run the same command again", folder)
    }

    fn cannot_remove(error: &io::Error, file: &Path) -> Failure {
        let what = format!("the program was interrupted, and this unfinished file cannot be removed: {error}");
        Failure::failed(what, "remove the file; if you have no right to do so, ask the owner of the folder", file)
    }
}
