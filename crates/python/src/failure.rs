//! Refusals as exceptions of the package, with the words of the command line.

use hovertone_cli::Failure;
use hovertone_cli::calls::failure_in_words;
use pyo3::prelude::*;
use std::path::PathBuf;

/// Where the exceptions are defined.
const MODULE: &str = "hovertone._errors";

/// The exception of a refusal.
pub(crate) fn raised(py: Python<'_>, failure: &Failure) -> PyErr {
    let none: (&str, &str, Option<&PathBuf>) = ("", "", None);
    let (name, (what, hint, path)) = match failure {
        Failure::Usage { what, hint, path } => ("WrongUseError", (what.as_str(), hint.as_str(), path.as_ref())),
        Failure::Failed { what, hint, path: Some(path) } => ("FileError", (what.as_str(), hint.as_str(), Some(path))),
        Failure::Failed { what, hint, path: None } => ("HovertoneError", (what.as_str(), hint.as_str(), None)),
        Failure::StdoutClosed => ("HovertoneError", none),
    };
    let exception = PyModule::import(py, MODULE)
        .and_then(|module| module.getattr(name)?.call1((failure_in_words(failure), what, hint, path)));
    exception.map_or_else(|error| error, PyErr::from_value)
}
