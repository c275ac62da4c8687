//! An experiment that was typed in place of its file.

use super::ExperimentSource;
use crate::args::DraftArguments;
use crate::draft::{Draft, LoadDraft, recordings_from};
use crate::failure::Failure;
use crate::files::sha256_of_bytes;
use crate::typed::typed_command;
use crate::vehicles::preset;
use crate::wording::IN_PLACE_OF_FILE;
use hovertone_report::VERSION;
use hovertone_vehicle::Vehicle;
use std::path::{Path, PathBuf};

/// Name of the file that the folder of results gets.
pub(crate) const EXPERIMENT: &str = "experiment.toml";

/// A typed experiment.
pub(crate) struct TypedExperiment {
    draft: Draft,
    vehicle: Option<&'static Vehicle>,
}

impl TypedExperiment {
    /// What the arguments describe. Recordings count from the current folder.
    pub(crate) fn from_arguments(
        arguments: &DraftArguments,
        clock_correction_ppm: Option<f64>,
    ) -> Result<Self, Failure> {
        let vehicle = arguments.vehicle.as_deref().map(preset).transpose()?;
        let draft = Draft { clock_correction_ppm, ..Draft::from_arguments(arguments, vehicle)? };
        let missing = draft.missing(vehicle);
        if missing.is_empty() {
            return Ok(Self { draft, vehicle });
        }
        let what = format!("the experiment is not complete without {}", missing.join("; and "));
        Err(Failure::usage(what, "add the missing flags, or give an experiment file; `hovertone init` writes one"))
    }

    /// The same as an experiment file in the current folder.
    pub(crate) fn source(self) -> Result<ExperimentSource, Failure> {
        let text = self.text(&self.draft.loads);
        let source = ExperimentSource::of_flags(&text, PathBuf::from(EXPERIMENT), "identify")?;
        Ok(ExperimentSource { typed: Some(self), wording: IN_PLACE_OF_FILE, ..source })
    }

    fn text(&self, loads: &[LoadDraft]) -> String {
        let head = format!("# Written by hovertone {VERSION} for this command:\n#   {}\n", typed_command());
        Draft { loads: loads.to_vec(), ..self.draft.clone() }.experiment_text(&head, self.vehicle)
    }
}

impl ExperimentSource {
    /// A hash of the file, or of what the flags say of the experiment: it differs from experiment to experiment.
    pub(crate) fn fingerprint(&self) -> String {
        match &self.typed {
            Some(typed) => sha256_of_bytes(typed.draft.experiment_text("", typed.vehicle).as_bytes()),
            None => self.sha256.clone(),
        }
    }

    /// For a typed experiment: the text of the file in the folder of results that repeats it, whose hash the results get. Its recordings
    /// are named from there.
    pub(crate) fn text_for(&mut self, folder: &Path, data_root: Option<&Path>) -> Result<Option<String>, Failure> {
        let Some(typed) = &self.typed else { return Ok(None) };
        let root = data_root.unwrap_or(Path::new(""));
        let mut loads = typed.draft.loads.clone();
        for name in loads.iter_mut().flat_map(|load| &mut load.recordings) {
            *name = recordings_from(name, root, folder)?;
        }
        let text = typed.text(&loads);
        self.sha256 = sha256_of_bytes(text.as_bytes());
        Ok(Some(text))
    }
}
