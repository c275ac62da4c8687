//! Rights to read: the folder or file that a user has none for.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Advice where a right to read is missing.
pub(crate) const GET_RIGHT: &str = "ask the owner for the right to read it, or for a copy";
/// What happened, where the folder stands before the message.
pub(crate) const CLOSED_FOLDER: &str = "you have no right to open this folder";

/// The outermost folder on the way to a file, or to the files of a pattern, that the user has no right to open.
pub(crate) fn closed_folder(path: &Path) -> Option<PathBuf> {
    let own = path.is_dir().then_some(path);
    let above = path.ancestors().skip(1);
    let way: Vec<&Path> = own.into_iter().chain(above).map(shown).collect();
    let is_hidden = path.is_dir() || !path.exists();
    let unlisted =
        way.iter().find(|folder| folder.is_dir()).filter(|folder| is_hidden && is_denied(fs::read_dir(folder)));
    // the folder itself is an entry that only those see who may open it
    let unopened = way.iter().rev().find(|folder| is_denied(fs::metadata(folder.join("."))));
    unopened.or(unlisted).map(|folder| folder.to_path_buf())
}

fn shown(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

fn is_denied<T>(result: io::Result<T>) -> bool {
    result.is_err_and(|error| error.kind() == io::ErrorKind::PermissionDenied)
}
