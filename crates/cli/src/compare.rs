//! `hovertone compare`: models of simulators against the measured constant.

use crate::args::CompareArguments;
use crate::export::{identified, say_doubts};
use crate::failure::{Ending, Failure};
use crate::inputs::read_text;
use crate::terminal::Terminal;
use hovertone_exchange::{ModelError, SimulatorModel, model_from_text};
use hovertone_report::{ComparedModel, models_json, models_text};
use std::path::Path;

/// Reads all models and prints them beside the results.
pub(crate) fn run(arguments: &CompareArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let heard = identified(&arguments.results, arguments.of.group.as_deref())?;
    say_doubts(&heard, &arguments.results, terminal);
    let models: Vec<ComparedModel> = arguments.models.iter().map(|path| model_of(path)).collect::<Result<_, _>>()?;
    if arguments.json {
        terminal.data(&models_json(&models, &heard).map_err(Failure::internal)?)?;
    } else {
        terminal.text(&models_text(&models, &heard, terminal.fold_width()))?;
    }
    Ok(Ending::Done)
}

fn model_of(path: &Path) -> Result<ComparedModel, Failure> {
    Ok(ComparedModel { file: path.display().to_string(), model: read_model(path)? })
}

/// Reads the model of a simulator.
pub(crate) fn read_model(path: &Path) -> Result<SimulatorModel, Failure> {
    let text = read_text(path, "the model")?;
    model_from_text(&text).map_err(|error| model_failure(&error, path))
}

/// The failure of a file that should be a model.
pub(crate) fn model_failure(error: &ModelError, path: &Path) -> Failure {
    let hint = match error {
        ModelError::NoExport => {
            "give the model of a simulator; the constant of each results.json stands in its report.html"
        }
        _ => "`hovertone compare --help` lists the files that it knows",
    };
    Failure::failed(error.to_string(), hint, path)
}
