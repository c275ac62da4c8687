//! How the bytes of a file are reached: at a path, or through a program that hands them out in slices, such as a browser.

use std::fs::File;
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};

/// Bytes that can be read from any place.
pub trait ReadSeek: Read + Seek + Send + Sync {}

impl<T: Read + Seek + Send + Sync> ReadSeek for T {}

/// An open file.
pub type OpenFile = Box<dyn ReadSeek>;

/// A file that can be opened any number of times: each pass over the sound opens it again.
pub trait FileAccess: Send + Sync {
    /// Its bytes, from the first on.
    ///
    /// # Errors
    /// The file cannot be opened.
    fn open(&self) -> io::Result<OpenFile>;

    /// Its name, with or without folders.
    fn name(&self) -> &Path;

    /// Its path, where other programs can open it.
    fn path(&self) -> Option<&Path> {
        None
    }

    /// The first read that failed. A decoder may have taken it for the end of the sound, which it is not.
    fn failure(&self) -> Option<io::Error> {
        None
    }
}

impl FileAccess for PathBuf {
    fn open(&self) -> io::Result<OpenFile> {
        Ok(Box::new(File::open(self)?))
    }

    fn name(&self) -> &Path {
        self
    }

    fn path(&self) -> Option<&Path> {
        Some(self)
    }
}
