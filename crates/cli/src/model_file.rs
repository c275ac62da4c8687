//! The file of a simulator's model.

use crate::failure::Failure;
use crate::inputs::read_text;
use hovertone_exchange::{ModelError, SimulatorModel, model_from_text};
use std::path::Path;

/// Reads the model of a simulator.
pub(crate) fn read_model(path: &Path) -> Result<SimulatorModel, Failure> {
    let text = read_text(path, "the model")?;
    model_from_text(&text).map_err(|error| model_failure(&error, path))
}

/// The failure of a file that should be a model.
pub(crate) fn model_failure(error: &ModelError, path: &Path) -> Failure {
    Failure::failed(error.to_string(), model_hint(error), path)
}

/// What to do about a file that should be a model.
pub(crate) fn model_hint(error: &ModelError) -> &'static str {
    match error {
        ModelError::NoExport => {
            "give the model of a simulator; to see the constant of a results.json, open the report.html beside it"
        }
        ModelError::WebPage => "give the file of the model itself, not a web page that shows the file",
        ModelError::Expression { .. } => "write the number into the model, in place of the expression",
        ModelError::Broken { .. } | ModelError::Quantity(_) => "correct the file, or give another model",
        ModelError::Incomplete { .. } => "correct the model, or give a file with one complete model",
        ModelError::UnlikeRotors { .. } => "give a model whose rotors all have the same constant",
        ModelError::Unknown => {
            "give the file of the model in which the thrust constant has one of these names; `hovertone compare --help` \
             lists the simulators"
        }
        _ => "give a model that hovertone knows: `hovertone compare --help` lists them",
    }
}
