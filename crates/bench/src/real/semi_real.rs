//! Recordings of several rotors with exact truth, made out of recordings of one rotor.

use super::cases::TruthSet;
use crate::accuracy::Workbench;
use crate::workspace::{output_of, target};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The name of the set.
pub(super) const NAME: &str = "semi-real";

/// The set in a folder, or made once below the build folder.
pub(super) fn semi_real(root: &Path, data: &Path, given: Option<&str>) -> Result<TruthSet, String> {
    let folder = match given {
        Some(given) => PathBuf::from(given),
        None => made_once(root, data)?,
    };
    TruthSet::read(NAME, &folder)
}

/// Runs the script of the recordings, unless its outcome is there.
fn made_once(root: &Path, data: &Path) -> Result<PathBuf, String> {
    let folder = target(root).join("real").join(NAME);
    if folder.join("truth.json").is_file() {
        return Ok(folder);
    }
    let script = data.join("real/make_semi_real.py");
    if !script.is_file() {
        return Err(format!("{} is missing", script.display()));
    }
    let unfinished = folder.with_extension("unfinished");
    let failed = |error: std::io::Error| format!("{}: {error}", unfinished.display());
    if unfinished.exists() {
        fs::remove_dir_all(&unfinished).map_err(failed)?;
    }
    fs::create_dir_all(&unfinished).map_err(failed)?;
    eprintln!("making the semi-real recordings; this takes a minute or two");
    output_of(python(root).arg(&script).arg(&unfinished)).map_err(|error| {
        format!("the semi-real recordings could not be made: {error} (needs python3 with numpy and soundfile)")
    })?;
    fs::rename(&unfinished, &folder).map_err(failed)?;
    Ok(folder)
}

/// The Python of the exams' own environment, else the one on the path.
pub(super) fn python(root: &Path) -> Command {
    Workbench::beside(root).map_or_else(|| Command::new("python3"), |workbench| workbench.python())
}
