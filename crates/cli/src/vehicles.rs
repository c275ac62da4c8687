//! `hovertone vehicles`: the presets, the vehicles of the user, and the sources of their numbers.

use crate::args::VehiclesArguments;
use crate::failure::{Ending, Failure};
use crate::nearest::nearest;
use crate::outputs::Outputs;
use crate::own_vehicles::{file_to_add, own_vehicles, place, vehicles_in};
use crate::terminal::Terminal;
use hovertone_report::{printable, vehicles_json, vehicles_text};
use hovertone_vehicle::{Vehicle, find_preset, flight_preset_names, presets};
use std::fs;
use std::path::Path;

/// Prints all vehicles, or adds those of a file to the user's own.
pub(crate) fn run(arguments: &VehiclesArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    if let Some(file) = &arguments.add {
        return add(file, terminal);
    }
    if !arguments.names.is_empty() {
        let named: Vec<Vehicle> = arguments.names.iter().map(|name| named(name)).collect::<Result<_, _>>()?;
        return show(&named, arguments.json, terminal);
    }
    if arguments.json {
        return show(&known_vehicles()?, true, terminal);
    }
    let own = own_vehicles()?;
    terminal.text(&vehicles_text(presets(), terminal.width()))?;
    match place().filter(|_| !own.is_empty()) {
        Some(place) => {
            terminal.text(&format!("Your own, in {}:\n\n", printable(&place.display().to_string())))?;
            terminal.text(&vehicles_text(own, terminal.width()))?;
        }
        None => terminal.text("Your own: none; `hovertone vehicles --help` shows how to add one\n")?,
    }
    Ok(Ending::Done)
}

/// Prints some vehicles.
fn show(vehicles: &[Vehicle], is_json: bool, terminal: &mut Terminal) -> Result<Ending, Failure> {
    if is_json {
        terminal.data(&vehicles_json(vehicles).map_err(Failure::internal)?)?;
    } else {
        terminal.text(&vehicles_text(vehicles, terminal.width()))?;
    }
    Ok(Ending::Done)
}

/// The vehicle of a name. The name of a file is a file to add.
fn named(name: &str) -> Result<Vehicle, Failure> {
    if name.ends_with(".toml") {
        let hint = format!("to add the vehicles of this file to your own, write --add {name}");
        return Err(Failure::usage(format!("{name}: this is a file, but the name of a vehicle is needed"), hint));
    }
    preset(name).cloned()
}

/// Adds the vehicles of a file to the user's own. The text is kept as it is, with its comments.
fn add(path: &Path, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let Some(place) = place() else {
        return Err(Failure::usage("there is no home folder to keep your vehicles in", "set HOME or XDG_CONFIG_HOME"));
    };
    let file = file_to_add(path)?;
    let added = vehicles_in(&file)?;
    if added.is_empty() {
        let what = "this file has no vehicle".to_owned();
        let hint = "`hovertone vehicles --help` shows an example".to_owned();
        return Err(Failure::Usage { what, hint, path: Some(path.to_owned()) });
    }
    if let Some(known) = added.iter().find_map(|new| own_vehicles().ok()?.iter().find(|known| known.id == new.id)) {
        return Err(Failure::Usage {
            what: format!("you have a vehicle \"{}\" already: nothing was written", known.id),
            hint: format!("remove [{}] from this file first, or give the new vehicle another name", known.id),
            path: Some(place),
        });
    }
    own_vehicles()?;
    let before = match fs::read_to_string(&place) {
        Ok(text) if text.trim().is_empty() => String::new(),
        Ok(text) => text.trim_end().to_owned() + "\n\n",
        Err(_) => "# Vehicles for `hovertone --vehicle NAME` and preset = \"NAME\".\n\n".to_owned(),
    };
    if let Some(folder) = place.parent() {
        fs::create_dir_all(folder).map_err(|error| Failure::cannot_write(&error, folder))?;
    }
    // the old content is part of the new
    Outputs::beside([path], true).write(&place, before + file.text.trim() + "\n")?;
    let names: Vec<&str> = added.iter().map(|vehicle| vehicle.id).collect();
    terminal.say(&format!("added to {}: {}", printable(&place.display().to_string()), names.join(", ")));
    Ok(Ending::Done)
}

/// The presets and the vehicles of the user.
pub(crate) fn known_vehicles() -> Result<Vec<Vehicle>, Failure> {
    Ok(presets().iter().chain(own_vehicles()?).cloned().collect())
}

/// What is wrong with a name that the flight model does not know, and the hint.
pub(crate) fn not_in_flight_model(name: &str) -> (String, String) {
    let known = flight_preset_names();
    let list = known.join(", ");
    if preset(name).is_ok() {
        let hint = format!(
            "this command works only with these vehicles: {list}; do not give one of them in place of another vehicle, because the result would be wrong"
        );
        return (
            format!(
                "hovertone has no flight model of the vehicle \"{name}\": it does not know its motors and its controller"
            ),
            hint,
        );
    }
    let hint = match nearest(name, known) {
        Some(nearest) => format!("did you mean \"{nearest}\"? Vehicles with a flight model: {list}"),
        None => format!("vehicles with a flight model: {list}"),
    };
    (format!("there is no vehicle \"{name}\" with a flight model"), hint)
}

/// The vehicle of a name, or a failure with the nearest name as a hint.
pub(crate) fn preset(id: &str) -> Result<&'static Vehicle, Failure> {
    if let Some(vehicle) = find_preset(id) {
        return Ok(vehicle);
    }
    let own = own_vehicles()?.iter().find(|vehicle| vehicle.id == id);
    own.ok_or_else(|| Failure::usage(format!("there is no vehicle \"{id}\""), preset_hint(id)))
}

/// Hint for a name without a vehicle.
pub(crate) fn preset_hint(id: &str) -> String {
    let own = own_vehicles().unwrap_or_default();
    match nearest(id, presets().iter().chain(own).map(|vehicle| vehicle.id)) {
        Some(name) => format!("did you mean \"{name}\"? `hovertone vehicles` lists all vehicles"),
        None => "`hovertone vehicles` lists all vehicles; `hovertone vehicles --add FILE` adds your own".to_owned(),
    }
}
