//! `hovertone export`: lines to paste into the model of a simulator.

use crate::args::ExportArguments;
use crate::failure::{Ending, Failure};
use crate::outputs::{Outputs, written};
use crate::terminal::Terminal;
use hovertone::vehicle::PROPELLER_DIAMETER_M;
use hovertone_exchange::{IdentifiedRotor, ResultsError, export_text, identified_from_results};
use std::fs;
use std::path::Path;

/// Writes or prints the lines.
pub(crate) fn run(arguments: &ExportArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let rotor = resolve(arguments)?;
    let outputs = Outputs::beside([&arguments.results], arguments.replace.force);
    let text = export_text(&rotor, arguments.to)
        .map_err(|error| Failure::usage(error.to_string(), "see `hovertone export --help`"))?;
    match &arguments.output {
        Some(path) => {
            outputs.write(path, text)?;
            terminal.say(&written(path));
        }
        None => terminal.data(&text)?,
    }
    Ok(Ending::Done)
}

fn resolve(arguments: &ExportArguments) -> Result<IdentifiedRotor, Failure> {
    let rotor = identified(&arguments.results, arguments.of.group.as_deref())?;
    let diameter = PROPELLER_DIAMETER_M;
    for (name, value, allowed, words) in [
        ("torque_constant_n_m_s2", arguments.torque_constant_n_m_s2, f64::MIN_POSITIVE..=f64::MAX, "a number above 0"),
        ("hover_command", arguments.hover_command, f64::MIN_POSITIVE..=1.0, "above 0 and at most 1"),
        ("diameter_m", arguments.diameter_m, diameter, "from 0.01 to 10"),
        // densities from the highest mountain in summer to a pole in winter
        ("air_density_kg_m3", arguments.air_density_kg_m3, 0.3..=1.8, "from 0.3 to 1.8"),
    ] {
        if let Some(value) = value.filter(|value| !allowed.contains(value)) {
            return Err(Failure::usage(format!("{name} = {value}, must be {words}"), "see `hovertone export --help`"));
        }
    }
    Ok(IdentifiedRotor {
        torque_constant_n_m_s2: arguments.torque_constant_n_m_s2.or(rotor.torque_constant_n_m_s2),
        hover_command: arguments.hover_command,
        propeller_diameter_m: arguments.diameter_m.or(rotor.propeller_diameter_m),
        air_density_kg_m3: arguments.air_density_kg_m3.or(rotor.air_density_kg_m3),
        ..rotor
    })
}

/// Reads results.json, or one group of the results of a table.
pub(crate) fn identified(path: &Path, group: Option<&str>) -> Result<IdentifiedRotor, Failure> {
    let text = fs::read_to_string(path)
        .map_err(|error| Failure::failed(format!("the results cannot be read: {error}"), "check the name", path))?;
    identified_from_results(&text, group).map_err(|error| match error {
        ResultsError::SeveralGroups { .. } | ResultsError::NoSuchGroup { .. } => {
            Failure::Usage { what: error.to_string(), hint: "say --group NAME".to_owned(), path: Some(path.to_owned()) }
        }
        _ => {
            let hint = "give the results.json that `hovertone identify EXPERIMENT.toml -o DIR` wrote";
            Failure::failed(error.to_string(), hint, path)
        }
    })
}
