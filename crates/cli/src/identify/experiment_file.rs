//! Reading the experiment file, with messages for its errors.

use super::typed::TypedExperiment;
use crate::failure::Failure;
use crate::files::{home_expanded, sha256_of_bytes};
use crate::model_file::read_model;
use crate::recording_files::groups_in;
use crate::toml_file::TomlFile;
use crate::typed::quoted;
use crate::vehicles::{known_vehicles, preset_hint};
use hovertone::experiment::{Experiment, ExperimentError, ExperimentFile};
use hovertone::thrust::VehicleModel;
use hovertone_report::{Notice, Wording};
use hovertone_vehicle::{Contradiction, find_preset, presets};
use std::path::{Path, PathBuf};

const KIND: &str = "experiment file";
const SEE_EXAMPLE: &str = "`hovertone identify --help` shows an experiment file";

/// An experiment file that was read and resolved.
pub(crate) struct ExperimentSource {
    /// Path of the file.
    pub(crate) path: PathBuf,
    /// Its folder.
    pub(crate) folder: PathBuf,
    /// Its file name.
    pub(crate) name: String,
    /// SHA-256 of its bytes.
    pub(crate) sha256: String,
    /// Whether the file begins with a comment.
    pub(crate) has_notes: bool,
    /// Its meaning.
    pub(crate) experiment: Experiment,
    /// The flags that stand in place of the file.
    pub(crate) typed: Option<TypedExperiment>,
    /// How advice about its recordings is worded.
    pub(crate) wording: Wording,
    /// What to say where a flag replaces the correction of the clock in the file.
    pub(crate) replaced_correction: Option<Notice>,
}

impl ExperimentSource {
    /// The experiment file, where it is one, and the simulator's model that it names.
    pub(crate) fn inputs(&self) -> Vec<PathBuf> {
        let model = self.experiment.model.as_ref().map(|model| self.folder.join(&model.file));
        let file = self.typed.is_none().then(|| self.path.clone());
        file.into_iter().chain(model).collect()
    }

    /// Reads and resolves an experiment file.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        refuse_folder(path)?;
        let toml = TomlFile::read(
            path,
            KIND,
            "give an experiment file; or, to hear a recording without one, write the mass before it, as in --mass 413g hover.mov",
            SEE_EXAMPLE,
        )?
        .with_content()?;
        Self::of_text(&toml.text, path.to_owned())
    }

    /// The meaning of flags of a command, whose text would stand at a path: no file is named where they mean nothing.
    pub(crate) fn of_flags(text: &str, path: PathBuf, command: &str) -> Result<Self, Failure> {
        Self::of_text(text, path).map_err(|failure| match failure {
            Failure::Usage { what, .. } => Failure::usage(what, format!("see `hovertone {command} --help`")),
            other => other,
        })
    }

    /// The meaning of a text that stands at a path.
    fn of_text(text: &str, path: PathBuf) -> Result<Self, Failure> {
        let file: ExperimentFile = TomlFile::of_text(&path, KIND, SEE_EXAMPLE, text).parse()?;
        let model = file.vehicle.model.as_deref().map(|name| model_of(name, &path)).transpose()?;
        // the user's own file is read only where it is needed: a fault in it does not stop other experiments
        let is_own = file.vehicle.preset.as_deref().is_some_and(|name| find_preset(name).is_none());
        let vehicles = if is_own { known_vehicles()? } else { presets().to_vec() };
        let experiment = file.resolve_among(&vehicles, model).map_err(|error| meaning_failure(&error, &path))?;
        let is_flight = experiment.is_flight();
        Ok(Self {
            folder: path.parent().map(Path::to_owned).unwrap_or_default(),
            name: path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default(),
            sha256: sha256_of_bytes(text.as_bytes()),
            has_notes: text.trim_start().starts_with('#'),
            experiment,
            typed: None,
            wording: Wording::of_experiment(is_flight),
            replaced_correction: None,
            path,
        })
    }

    /// The same with the correction of the clock that a flag gives: it replaces the one in the file.
    pub(crate) fn with_correction(mut self, flag_ppm: Option<f64>) -> Self {
        let Some(flag_ppm) = flag_ppm else { return self };
        let file_ppm = self.experiment.clock_correction_ppm;
        if file_ppm != 0.0 && file_ppm != flag_ppm {
            self.replaced_correction = Some(Notice::new(
                format!(
                    "--clock-correction-ppm {flag_ppm} is used, and clock_correction_ppm = {file_ppm} of the experiment file is not"
                ),
                "leave the flag out to use the correction in the file",
            ));
        }
        self.experiment.clock_correction_ppm = flag_ppm;
        self
    }
}

/// Whether a text is an experiment file, or an attempt at one.
pub(crate) fn names_loads(text: &str) -> bool {
    text.lines().any(|line| line.trim().starts_with("[[load]]"))
}

/// Refuses a folder, with what to give in its place: the experiment file in it, or its recordings with their mass.
fn refuse_folder(path: &Path) -> Result<(), Failure> {
    if !path.is_dir() {
        return Ok(());
    }
    let names = std::fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path());
    let tables = names.filter(|name| name.extension().is_some_and(|ending| ending == "toml"));
    let file = tables.filter(|name| std::fs::read_to_string(name).is_ok_and(|text| names_loads(&text))).min();
    let hint = match file {
        Some(file) => format!("name the file in it: {}", file.display()),
        None if groups_in(path).is_empty() => "give the experiment file; `hovertone init` writes one".to_owned(),
        None => format!(
            "to hear the recordings in the folder, write the mass of the vehicle before the folder, as in --mass {}",
            quoted(&format!("413g={}", path.display()))
        ),
    };
    Err(Failure::failed("this is a folder, but an experiment file is needed", hint, path))
}

/// The simulator's model that an experiment names, relative to the folder of the experiment.
fn model_of(name: &str, experiment: &Path) -> Result<VehicleModel, Failure> {
    let path = experiment.parent().unwrap_or(Path::new("")).join(home_expanded(Path::new(name)));
    let model = read_model(&path)?;
    Ok(VehicleModel {
        file: name.to_owned(),
        format: model.format.name().to_owned(),
        rotor_count: model.rotor_count,
        mass_kg: model.mass_kg,
        propeller_diameter_m: model.propeller_diameter_m,
        thrust_constant_n_s2: model.thrust_constant_n_s2,
        thrust_linear_n_s: model.thrust_linear_n_s,
        thrust_offset_n: model.thrust_offset_n,
    })
}

fn meaning_failure(error: &ExperimentError, path: &Path) -> Failure {
    let (what, hint) = match error {
        ExperimentError::UnknownPreset { name } => {
            (format!("the experiment file names a vehicle that does not exist: \"{name}\""), preset_hint(name))
        }
        ExperimentError::Vehicle(contradiction @ Contradiction::Rotors { .. }) => {
            let hint = "leave rotors or preset out under [vehicle]; if fewer rotors run on a bench, write rotors_running \
                 under the [[load]] of the bench";
            (contradiction.to_string(), hint.to_owned())
        }
        ExperimentError::Vehicle(contradiction) => (contradiction.to_string(), contradiction.hint()),
        ExperimentError::Missing { what, hint } => (format!("{what} is missing"), (*hint).to_owned()),
        ExperimentError::Contradiction { what, hint } => (what.clone(), (*hint).to_owned()),
        _ => (error.to_string(), SEE_EXAMPLE.to_owned()),
    };
    Failure::Usage { what, hint, path: Some(path.to_owned()) }
}
