//! The experiment file: reading it, and saying where it is wrong.

use crate::failure::Failure;
use crate::files::sha256_of_bytes;
use crate::toml_file::TomlFile;
use crate::vehicles::preset_hint;
use hovertone::{Experiment, ExperimentError, ExperimentFile};
use std::path::{Path, PathBuf};

const SEE_EXAMPLE: &str = "`hovertone identify --help` shows an experiment file";

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
        let toml = TomlFile::read(path, "experiment file", "recording", SEE_EXAMPLE)?;
        let file: ExperimentFile = toml.parse()?;
        let experiment = file.resolve().map_err(|error| meaning_failure(&error, path))?;
        Ok(Self {
            path: path.to_owned(),
            folder: path.parent().map(Path::to_owned).unwrap_or_default(),
            name: path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default(),
            sha256: sha256_of_bytes(toml.text.as_bytes()),
            has_notes: toml.text.trim_start().starts_with('#'),
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
