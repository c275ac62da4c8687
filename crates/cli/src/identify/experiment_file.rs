//! The experiment file: reading it, and saying where it is wrong.

use crate::failure::Failure;
use crate::files::sha256_of_bytes;
use crate::nearest::nearest;
use crate::vehicles::preset_hint;
use hovertone::{Experiment, ExperimentError, ExperimentFile};
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

const SEE_EXAMPLE: &str = "`hovertone identify --help` shows an experiment file";
/// What the parser expects, as people call it.
const TYPES: [(&str, &str); 3] = [
    ("expected f64", "expected a number"),
    ("expected u32", "expected a whole number"),
    ("a sequence", "a list [...]"),
];

/// An experiment file that was read and settled.
pub(crate) struct ExperimentSource {
    /// Where it is.
    pub(crate) path: PathBuf,
    /// The folder it is in.
    pub(crate) folder: PathBuf,
    /// Its file name.
    pub(crate) name: String,
    /// SHA-256 of its bytes.
    pub(crate) sha256: String,
    /// Whether it begins with a comment.
    pub(crate) has_notes: bool,
    /// What it says.
    pub(crate) experiment: Experiment,
}

impl ExperimentSource {
    /// Reads and settles an experiment file.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let bytes = fs::read(path).map_err(|error| {
            Failure::failed(format!("the experiment file cannot be read: {error}"), "check its name", path)
        })?;
        let text = std::str::from_utf8(&bytes).map_err(|error| {
            let what = format!("the experiment file is not text: {error}");
            Failure::failed(what, "give the TOML file that describes the experiment, not a recording", path)
        })?;
        let file: ExperimentFile = toml::from_str(text).map_err(|error| toml_failure(&error, text, path))?;
        let experiment = file.resolve().map_err(|error| meaning_failure(&error, path))?;
        Ok(Self {
            path: path.to_owned(),
            folder: path.parent().map(Path::to_owned).unwrap_or_default(),
            name: path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default(),
            sha256: sha256_of_bytes(&bytes),
            has_notes: text.trim_start().starts_with('#'),
            experiment,
        })
    }
}

fn meaning_failure(error: &ExperimentError, path: &Path) -> Failure {
    let (what, hint) = match error {
        ExperimentError::UnknownPreset { name } => {
            (format!("the experiment file names a vehicle preset that does not exist: \"{name}\""), preset_hint(name))
        }
        _ => (error.to_string(), SEE_EXAMPLE.to_owned()),
    };
    Failure::Usage { what, hint, path: Some(path.to_owned()) }
}

/// The line with the fault underlined, and the nearest name where one was misspelt.
fn toml_failure(error: &toml::de::Error, text: &str, path: &Path) -> Failure {
    let message = error.message();
    let (what, hint) = match unknown_key(message) {
        Some((key, known)) => {
            let list = known.join(", ");
            let hint = match nearest(key, known.iter().copied()) {
                Some(name) => format!("did you mean \"{name}\"? Known here: {list}"),
                None => format!("known here: {list}"),
            };
            (format!("the experiment file has an unknown key \"{key}\""), hint)
        }
        None => {
            let message = message.trim_end().replace('\n', " ");
            let message = TYPES.iter().fold(message, |text, (rust, words)| text.replace(rust, words));
            (format!("the experiment file has a fault: {message}"), SEE_EXAMPLE.to_owned())
        }
    };
    let Some(place) = error.span().map(|span| Place::of(span, text)) else {
        return Failure::Usage { what, hint, path: Some(path.to_owned()) };
    };
    let what = format!("{what}\n{}", place.underlined());
    let path = PathBuf::from(format!("{}:{}:{}", path.display(), place.line_number, place.column));
    Failure::Usage { what, hint, path: Some(path) }
}

/// The key and the known ones, from "unknown field `a`, expected one of `b`, `c`".
fn unknown_key(message: &str) -> Option<(&str, Vec<&str>)> {
    let list = message.strip_prefix("unknown field ")?;
    let mut quoted = list.split('`').skip(1).step_by(2);
    Some((quoted.next()?, quoted.collect()))
}

/// A place in a text, lines and columns counted from 1.
struct Place<'a> {
    line: &'a str,
    line_number: usize,
    column: usize,
    length: usize,
}

impl<'a> Place<'a> {
    fn of(span: Range<usize>, text: &'a str) -> Self {
        let before = text.get(..span.start).unwrap_or(text);
        let line_start = before.rfind('\n').map_or(0, |feed| feed + 1);
        let line = text[line_start..].lines().next().unwrap_or("");
        let indent = before[line_start..].chars().count();
        let marked = text.get(span).unwrap_or("").lines().next().unwrap_or("").chars().count();
        Self { line, line_number: before.matches('\n').count() + 1, column: indent + 1, length: marked.max(1) }
    }

    fn underlined(&self) -> String {
        let number = self.line_number.to_string();
        let (margin, indent) = (" ".repeat(number.len()), " ".repeat(self.column - 1));
        format!("  {margin} |\n  {number} | {}\n  {margin} | {indent}{}", self.line, "^".repeat(self.length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_counted_from_one_and_underlined() {
        let text = "[vehicle]\n  mas_kg = 1\n";
        let place = Place::of(12..18, text);
        assert_eq!((place.line_number, place.column), (2, 3));
        assert_eq!(place.underlined(), "    |\n  2 |   mas_kg = 1\n    |   ^^^^^^");
        let end = Place::of(23..23, text);
        assert_eq!((end.line_number, end.line), (3, ""));
    }

    #[test]
    fn the_known_keys_are_read_from_the_parsers_message() {
        let message = "unknown field `mas_kg`, expected one of `mass_kg`, `rotors`";
        assert_eq!(unknown_key(message), Some(("mas_kg", vec!["mass_kg", "rotors"])));
        assert_eq!(unknown_key("invalid type"), None);
    }
}
