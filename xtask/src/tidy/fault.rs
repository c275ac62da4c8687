//! One fault, and where it is.

use std::fmt;

/// What is wrong at which line of which file, and what to do about it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Fault {
    /// Below the root of the workspace, with `/` between folders.
    pub(super) path: String,
    /// The first line of a file is line 1.
    pub(super) line: usize,
    pub(super) message: String,
}

impl Fault {
    pub(super) fn new(path: &str, line: usize, message: String) -> Self {
        Self { path: path.to_owned(), line, message }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}:{}: {}", self.path, self.line, self.message)
    }
}
