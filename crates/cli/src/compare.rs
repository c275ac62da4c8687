//! `hovertone compare`: models of simulators against the measured constant.

use crate::args::CompareArguments;
use crate::export::{ending_of, identified, say_doubts};
use crate::failure::{Ending, Failure};
use crate::inputs::name_of;
use crate::model_file::read_model;
use crate::terminal::Terminal;
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
    Ok(ending_of(&heard))
}

fn model_of(path: &Path) -> Result<ComparedModel, Failure> {
    Ok(ComparedModel { file: name_of(path), model: read_model(path)? })
}
