//! Experiment files as JSON and back, so that the page edits them key by key; known vehicles; results of an earlier run.

use hovertone::experiment::ExperimentFile;
use hovertone_report::{VERSION, vehicles_json};
use hovertone_vehicle::presets;
use hovertone_workflow::simulators_of;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use wasm_bindgen::prelude::wasm_bindgen;

/// Version of hovertone.
#[wasm_bindgen]
pub fn version() -> String {
    VERSION.to_owned()
}

/// The known vehicles as JSON.
#[wasm_bindgen]
pub fn vehicles() -> String {
    vehicles_json(presets()).unwrap_or_default()
}

/// The colours of the levels of a spectrogram, darkest first: red, green and blue of each.
#[wasm_bindgen]
pub fn level_colours() -> Vec<u8> {
    hovertone_figures::level_colours().concat()
}

/// The text of an experiment file from its entries as JSON.
///
/// # Errors
/// Entries that no experiment file has.
#[wasm_bindgen]
pub fn experiment_text(entries: &str) -> Result<String, String> {
    let entries: Value = serde_json::from_str(entries).map_err(|error| error.to_string())?;
    let body = toml::to_string_pretty(&without_nulls(entries)).map_err(|error| error.to_string())?;
    Ok(format!("# Written by the page of hovertone {VERSION}.\n\n{body}"))
}

/// The entries of an experiment file as JSON.
///
/// # Errors
/// One line: which entry has no meaning.
#[wasm_bindgen]
pub fn experiment_entries(text: &str) -> Result<String, String> {
    let _: ExperimentFile = toml::from_str(text).map_err(|error| in_one_line(&error))?;
    let entries: toml::Table = toml::from_str(text).map_err(|error| in_one_line(&error))?;
    serde_json::to_string(&entries).map_err(|error| error.to_string())
}

/// The lines for simulators from the text of `results.json`, as JSON.
///
/// # Errors
/// The text is of another kind.
#[wasm_bindgen]
pub fn simulator_lines(results: &str) -> Result<String, String> {
    let lines = simulators_of(results);
    if lines.is_empty() {
        return Err("this file holds no thrust constant; give the results.json of hovertone".to_owned());
    }
    let lines: Vec<Value> = lines.iter().map(|line| json!({ "name": line.name, "text": line.text })).collect();
    Ok(Value::Array(lines).to_string())
}

/// A fault of a TOML text on one line.
pub(crate) fn in_one_line(error: &toml::de::Error) -> String {
    format!("the experiment file has a fault: {}", error.message().replace('\n', " "))
}

/// Bytes in hexadecimal.
pub(crate) fn in_hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        // writing into a string does not fail
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// TOML has no word for nothing: such entries are left out.
fn without_nulls(value: Value) -> Value {
    match value {
        Value::Object(entries) => {
            let kept = entries.into_iter().filter(|(_, value)| !value.is_null());
            Value::Object(kept.map(|(key, value)| (key, without_nulls(value))).collect::<Map<_, _>>())
        }
        Value::Array(values) => Value::Array(values.into_iter().map(without_nulls).collect()),
        value => value,
    }
}

#[cfg(test)]
mod tests {
    use super::{experiment_entries, experiment_text};
    use crate::example::example_plan;
    use hovertone::experiment::ExperimentFile;
    use serde_json::Value;

    const FILE: &str = "[vehicle]\nblades = 2\nrotors = 4\nmass_kg = 0.413\n\n[ridge]\ngaussian_threshold_share = 0.7\n\n\
        [[load]]\nname = \"a \\\"b\\\"\"\nadded_mass_kg = 0.031\nfrom_s = 2\nrecordings = [\"x.wav\", { file = \"y.wav\", log = \"y.ulg\" }]\n";

    #[test]
    fn entries_and_text_are_the_same_experiment() {
        let text = experiment_text(&experiment_entries(FILE).unwrap()).unwrap();
        let read = |text: &str| toml::from_str::<ExperimentFile>(text).unwrap();
        assert_eq!(read(&text), read(FILE), "{text}");
        assert!(text.starts_with("# Written by"), "{text}");
    }

    #[test]
    fn what_the_page_empties_is_left_out() {
        let mut entries: Value = serde_json::from_str(&experiment_entries(FILE).unwrap()).unwrap();
        entries["load"][0]["from_s"] = Value::Null;
        let text = experiment_text(&entries.to_string()).unwrap();
        assert!(!text.contains("from_s") && text.contains("gaussian_threshold_share"), "{text}");
    }

    #[test]
    fn a_fault_is_one_line_that_names_the_entry() {
        let fault = experiment_entries("[vehicle]\nmas_kg = 1\n").unwrap_err();
        assert!(fault.contains("mas_kg") && !fault.contains('\n'), "{fault}");
    }

    #[test]
    fn the_example_is_an_experiment() {
        let plan: Value = serde_json::from_str(&example_plan()).unwrap();
        let text = experiment_text(&plan["experiment"].to_string()).unwrap();
        let experiment = toml::from_str::<ExperimentFile>(&text).unwrap().resolve(None).unwrap();
        let listed: usize = experiment.loads.iter().map(|load| load.recordings.len()).sum();
        assert_eq!((experiment.loads.len(), listed), (3, plan["recordings"].as_array().unwrap().len()));
    }
}
