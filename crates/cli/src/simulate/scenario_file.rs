//! Reading the scenario file and its command tables, with messages for their errors.

use crate::failure::Failure;
use crate::files::sha256_of_bytes;
use crate::toml_file::{NO_RECORDING, TomlFile};
use crate::vehicles::not_in_flight_model;
use hovertone_sim::HOVER_VOLTAGE;
use hovertone_sim::scenario::{Scenario, ScenarioError, ScenarioFile};
use hovertone_vehicle::{MASS_ALONE_KG_MAX, QuantityError};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

const SEE_EXAMPLE: &str = "`hovertone simulate --help` shows a scenario file, docs/formats.md lists all keys";

const SEE_SCENARIO: &str = "give the TOML file; `hovertone simulate --help` shows a scenario file";

/// A scenario file that was read and resolved.
pub(crate) struct ScenarioSource {
    /// Path of the file.
    pub(crate) path: PathBuf,
    /// Its file name.
    pub(crate) name: String,
    /// SHA-256 of its bytes.
    pub(crate) sha256: String,
    /// Its content, with the used seed.
    pub(crate) file: ScenarioFile,
    /// Its meaning.
    pub(crate) scenario: Scenario,
}

impl ScenarioSource {
    /// Reads and resolves a scenario file; `seed` replaces its own seed.
    pub(crate) fn read(path: &Path, seed: Option<u64>) -> Result<Self, Failure> {
        let toml = TomlFile::read(path, "scenario file", NO_RECORDING, SEE_EXAMPLE)?;
        if let Some((found, hint)) = other_format(&toml.text) {
            let what = format!("this file is {found}, so it cannot be the scenario file");
            return Err(Failure::failed(what, hint, path));
        }
        let mut file: ScenarioFile = toml.parse()?;
        file.seed = seed.unwrap_or(file.seed);
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut tables = BTreeMap::new();
        for name in file.command_files() {
            let table = folder.join(name);
            let text = fs::read_to_string(&table).map_err(|error| {
                let what = format!("the table of commands cannot be read: {error}");
                Failure::failed(
                    what,
                    "check the name of the table: it is relative to the folder of the scenario file",
                    &table,
                )
            })?;
            tables.insert(name.to_owned(), text);
        }
        let scenario = file.resolve(&tables).map_err(|error| failure_of(&error, path))?;
        Ok(Self {
            path: path.to_owned(),
            name: path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default(),
            sha256: sha256_of_bytes(toml.text.as_bytes()),
            file,
            scenario,
        })
    }

    /// The scenario file and its tables of commands.
    pub(crate) fn inputs(&self) -> Vec<PathBuf> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let tables = self.file.command_files();
        [self.path.clone()].into_iter().chain(tables.into_iter().map(|name| folder.join(name))).collect()
    }

    /// The failure for a part of the file that fails later.
    pub(crate) fn failure(&self, error: &ScenarioError) -> Failure {
        match error {
            ScenarioError::Quantity(QuantityError { name: HOVER_VOLTAGE, value, .. }) => self.too_heavy(*value),
            _ => failure_of(error, &self.path),
        }
    }

    /// The failure for a vehicle whose hover needs this voltage.
    fn too_heavy(&self, needed_v: f64) -> Failure {
        let flight = &self.scenario.flight;
        let payloads_kg: f64 = flight.payloads.iter().map(|payload| payload.mass_kg).sum();
        let (vehicle_kg, battery_v) = (flight.vehicle.mass_kg.value, flight.vehicle.battery.voltage_v.value);
        let (key, mass_kg) = match payloads_kg > vehicle_kg {
            true => ("mass_kg of [[payload]]", payloads_kg),
            false => ("mass_kg", vehicle_kg),
        };
        let what = format!(
            "{key} = {mass_kg}: the vehicle is too heavy to hover, because its motors would need {needed_v:.0} V, and \
             its battery has {battery_v:.1} V"
        );
        let hint = if mass_kg > MASS_ALONE_KG_MAX {
            format!("masses are in kilograms: for {mass_kg} g write {}", mass_kg / 1e3)
        } else {
            "give a smaller mass (in kilograms), or another vehicle".to_owned()
        };
        Failure::Usage { what, hint, path: Some(self.path.clone()) }
    }
}

/// What a text is that is no TOML, and what to do.
fn other_format(text: &str) -> Option<(&'static str, &'static str)> {
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    let first = lines.next()?.trim_start_matches('\u{feff}');
    if first.starts_with('<') {
        let models = [
            ("<sdf", "a simulator's model (SDF)"),
            ("<robot", "a simulator's model (URDF)"),
            ("<mujoco", "a simulator's model (MJCF)"),
        ];
        let found = models.iter().find(|(tag, _)| text.contains(tag)).map_or("XML", |(_, model)| model);
        return Some((found, SEE_SCENARIO));
    }
    // a line of TOML without a value names a section
    let is_table = first.contains([',', ';', '\t']) && !first.contains('=') && !first.starts_with('[');
    is_table.then_some((
        "a table (CSV)",
        "give the TOML file; a table of commands is named there: file = \"commands.csv\" under [[maneuver]] with kind = \"csv\"",
    ))
}

fn failure_of(error: &ScenarioError, path: &Path) -> Failure {
    let (what, hint) = match error {
        ScenarioError::UnknownPreset { name } => not_in_flight_model(name),
        ScenarioError::Contradiction { what, hint } => (what.clone(), (*hint).to_owned()),
        ScenarioError::Missing { what, hint } => (format!("{what} is missing"), (*hint).to_owned()),
        _ => (error.to_string(), SEE_EXAMPLE.to_owned()),
    };
    Failure::Usage { what, hint, path: Some(path.to_owned()) }
}
