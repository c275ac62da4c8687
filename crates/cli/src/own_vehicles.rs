//! The vehicles of the user: the file `hovertone/vehicles.toml` in the folder of settings.

use crate::failure::Failure;
use crate::files::home;
use crate::toml_file::{NO_RECORDING, TomlFile};
use hovertone_vehicle::{OwnVehicle, OwnVehicleError, Vehicle, find_preset};
use std::collections::BTreeMap;
use std::env;
use std::path::PathBuf;
use std::sync::OnceLock;

const SEE_EXAMPLE: &str = "`hovertone vehicles --help` shows an example of a file of vehicles";
const KIND: &str = "file of vehicles";

/// The vehicles in the user's file, once it was read.
static OWN: OnceLock<Vec<Vehicle>> = OnceLock::new();

/// Place of the user's file: in `$XDG_CONFIG_HOME`, else in `~/.config`. `None` where there is neither.
pub(crate) fn place() -> Option<PathBuf> {
    // the XDG specification: a relative path is to be ignored
    let named = env::var_os("XDG_CONFIG_HOME").map(PathBuf::from).filter(|folder| folder.is_absolute());
    let folder = named.or_else(|| home().map(|home| home.join(".config")))?;
    Some(folder.join("hovertone").join("vehicles.toml"))
}

/// The user's vehicles; none without a file.
pub(crate) fn own_vehicles() -> Result<&'static [Vehicle], Failure> {
    if let Some(vehicles) = OWN.get() {
        return Ok(vehicles);
    }
    let read = match place().filter(|place| place.exists()) {
        Some(place) => vehicles_in(&TomlFile::read(&place, KIND, NO_RECORDING, SEE_EXAMPLE)?)?,
        None => Vec::new(),
    };
    Ok(OWN.get_or_init(|| read))
}

/// The vehicles in a file, in the order of their names.
pub(crate) fn vehicles_in(file: &TomlFile<'_>) -> Result<Vec<Vehicle>, Failure> {
    let written: BTreeMap<String, OwnVehicle> = file.parse()?;
    let refused =
        |what: String, hint: &str| Failure::Usage { what, hint: hint.to_owned(), path: Some(file.path.to_owned()) };
    let mut vehicles = Vec::new();
    for (id, own) in &written {
        if find_preset(id).is_some() {
            let what =
                format!("[{id}] has the name of a preset (a vehicle that hovertone knows), which cannot be replaced");
            return Err(refused(what, "give your vehicle another name, such as my-drone"));
        }
        vehicles.push(own.vehicle(id).map_err(|error| {
            let hint = match &error {
                OwnVehicleError::Vehicle(contradiction) => contradiction.hint(),
                OwnVehicleError::Quantity(_) => format!("correct this number; {SEE_EXAMPLE}"),
                _ => SEE_EXAMPLE.to_owned(),
            };
            let what = error.to_string();
            let what = match what.strip_prefix("diameter_m") {
                Some(rest) => format!("propeller_diameter_m{rest}"),
                None => what,
            };
            refused(format!("[{id}]: {what}"), &hint)
        })?);
    }
    Ok(vehicles)
}

/// Reads a file of vehicles that the user wants to keep.
pub(crate) fn file_to_add(path: &std::path::Path) -> Result<TomlFile<'_>, Failure> {
    TomlFile::read(path, KIND, NO_RECORDING, SEE_EXAMPLE)?.with_content()
}
