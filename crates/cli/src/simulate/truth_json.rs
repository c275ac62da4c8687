//! `truth.json`: exact means over the hovers, and all settings.

use super::{SOUND, ScenarioSource, TABLE};
use crate::failure::Failure;
use crate::output_folder::OutputFolder;
use hovertone_report::VERSION;
use hovertone_sim::scenario::{ScenarioFile, ScenarioTruth};
use hovertone_vehicle::FlightParameters;
use serde::Serialize;

/// Name of the file.
pub(super) const NAME: &str = "truth.json";

#[derive(Serialize)]
struct TruthFile<'a> {
    made_by: &'static str,
    version: &'static str,
    seed: u64,
    #[serde(flatten)]
    truth: &'a ScenarioTruth,
    files: Files,
    settings: Settings<'a>,
}

#[derive(Serialize)]
struct Files {
    sound: &'static str,
    table: &'static str,
}

#[derive(Serialize)]
struct Settings<'a> {
    file: &'a str,
    sha256: &'a str,
    scenario: &'a ScenarioFile,
    vehicle: &'a FlightParameters,
}

/// Writes the truth.
pub(super) fn write(folder: &OutputFolder, source: &ScenarioSource, truth: &ScenarioTruth) -> Result<(), Failure> {
    let file = TruthFile {
        made_by: "hovertone simulate",
        version: VERSION,
        seed: source.file.seed,
        truth,
        files: Files { sound: SOUND, table: TABLE },
        settings: Settings {
            file: &source.name,
            sha256: &source.sha256,
            scenario: &source.file,
            vehicle: &source.scenario.flight.vehicle,
        },
    };
    folder.write(NAME, serde_json::to_string_pretty(&file).map_err(Failure::internal)? + "\n")
}
