//! Endings of a run and their exit codes.

use crate::caller::typed_words;
use crate::number_advice::correct_number;
use crate::see_help::see_help;
use hovertone_report::printable;
use hovertone_vehicle::{ConfigError, Contradiction, QuantityError};
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Ending of a run that was possible.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Ending {
    /// Everything was done.
    Done,
    /// Done with a gap: no rotor tone, or only the beginning of a recording.
    Incomplete,
    /// A file could not be read; the others were done.
    FilesFailed,
}

impl Ending {
    pub(crate) fn exit_code(self) -> ExitCode {
        ExitCode::from(match self {
            Self::Done => 0,
            Self::FilesFailed => 1,
            Self::Incomplete => 3,
        })
    }
}

/// Whether a file is there that its owner protected.
fn is_protected(path: &Path) -> bool {
    path.metadata().is_ok_and(|metadata| metadata.is_file() && metadata.permissions().readonly())
}

/// Two statements about a vehicle of which one must be wrong.
impl From<Contradiction> for Failure {
    fn from(contradiction: Contradiction) -> Self {
        Self::usage(contradiction.to_string(), contradiction.hint())
    }
}

/// A number out of its range.
impl From<QuantityError> for Failure {
    fn from(error: QuantityError) -> Self {
        Self::usage(error.to_string(), correct_number(error.name, &typed_words()))
    }
}

/// A setting out of its range, or a span or band without content.
impl From<ConfigError> for Failure {
    fn from(error: ConfigError) -> Self {
        let hint = match &error {
            ConfigError::EmptySpan { .. } => {
                format!(
                    "give a later end (--to) or an earlier start (--from), in seconds or as 1:02.5; {}",
                    see_help(&typed_words())
                )
            }
            ConfigError::EmptyBand { low_hz, high_hz } if low_hz > high_hz => {
                format!("write the lower edge first: {high_hz}:{low_hz}")
            }
            ConfigError::EmptyBand { low_hz, .. } => {
                format!("write two different edges around the tone, such as {:.0}:{:.0}", 0.9 * low_hz, 1.1 * low_hz)
            }
            ConfigError::OutOfRange { name, .. } => correct_number(name, &typed_words()),
            _ => see_help(&typed_words()),
        };
        Self::usage(error.to_string(), hint)
    }
}

/// Reason why a run was impossible: what happened and why, what to do, and which file.
#[derive(Debug)]
pub enum Failure {
    /// The command line or a file of the user has no meaning, or the run would replace a file.
    Usage {
        /// What happened, and why.
        what: String,
        /// What to do.
        hint: String,
        /// The file that it is about.
        path: Option<PathBuf>,
    },
    /// A file or folder is not there, is of another kind, or cannot be read or written.
    Failed {
        /// What happened, and why.
        what: String,
        /// What to do.
        hint: String,
        /// The file that it is about.
        path: Option<PathBuf>,
    },
    /// The reader of stdout closed it.
    StdoutClosed,
}

impl Failure {
    pub(crate) fn usage(what: impl Into<String>, hint: impl Into<String>) -> Self {
        Self::Usage { what: what.into(), hint: hint.into(), path: None }
    }

    pub(crate) fn failed(what: impl Into<String>, hint: impl Into<String>, path: &Path) -> Self {
        Self::Failed { what: what.into(), hint: hint.into(), path: Some(path.to_owned()) }
    }

    pub(crate) fn cannot_write(error: &io::Error, path: &Path) -> Self {
        let (what, hint) = match error.kind() {
            io::ErrorKind::NotFound if path.parent().is_some_and(Path::is_dir) => {
                ("no file can be made in the folder of this file".to_owned(), "choose another place")
            }
            io::ErrorKind::NotFound => {
                ("the folder of this file does not exist".to_owned(), "make the folder, or choose another place")
            }
            io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists => {
                match path.ancestors().find(|part| part.is_file()) {
                    Some(file) => (
                        format!(
                            "{} is a file, not a folder, so nothing can be written into it",
                            printable(&file.display().to_string())
                        ),
                        "choose another place",
                    ),
                    None => (format!("this file cannot be written: {error}"), "choose another place"),
                }
            }
            io::ErrorKind::PermissionDenied if is_protected(path) => {
                ("this file is protected against writing".to_owned(), "choose another name, or remove the protection")
            }
            io::ErrorKind::PermissionDenied => (
                "you have no right to write into the folder of this file".to_owned(),
                "write into a folder of your own",
            ),
            io::ErrorKind::FileTooLarge => (
                "this file becomes larger than the system allows: it was not written".to_owned(),
                "choose a place on another disk, or raise the limit (`ulimit -f unlimited`)",
            ),
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => (
                "the disk is full: this file was not written".to_owned(),
                "make room, or choose a place on another disk",
            ),
            _ => (format!("this file cannot be written: {error}"), "choose another place, or check the disk"),
        };
        Self::failed(what, hint, path)
    }

    /// For errors that should be impossible, in place of a panic.
    pub fn internal(error: impl std::fmt::Display) -> Self {
        let hint = "this is a bug of hovertone: please report it".to_owned();
        Self::Failed { what: error.to_string(), hint, path: None }
    }

    pub(crate) fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Usage { .. } => 2,
            Self::Failed { .. } => 1,
            Self::StdoutClosed => 0,
        })
    }
}
