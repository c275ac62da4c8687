//! `hovertone vehicles`: the presets and the sources of their numbers.

use crate::args::VehiclesArguments;
use crate::failure::{Ending, Failure};
use crate::nearest::nearest;
use crate::terminal::Terminal;
use hovertone_report::{vehicles_json, vehicles_text};
use hovertone_vehicle::{Vehicle, find_preset, presets};

/// Prints all presets.
pub(crate) fn run(arguments: &VehiclesArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let text = if arguments.json {
        vehicles_json(presets()).map_err(Failure::internal)?
    } else {
        vehicles_text(presets(), terminal.width())
    };
    terminal.data(&text)?;
    Ok(Ending::Done)
}

/// The preset of a name, or a failure with the nearest name as a hint.
pub(crate) fn preset(id: &str) -> Result<&'static Vehicle, Failure> {
    find_preset(id).ok_or_else(|| Failure::usage(format!("there is no vehicle preset \"{id}\""), preset_hint(id)))
}

/// Hint for a name without a preset.
pub(crate) fn preset_hint(id: &str) -> String {
    match nearest(id, presets().iter().map(|vehicle| vehicle.id)) {
        Some(name) => format!("did you mean \"{name}\"? `hovertone vehicles` lists all"),
        None => "`hovertone vehicles` lists all".to_owned(),
    }
}
