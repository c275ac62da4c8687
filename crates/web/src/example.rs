//! The example of the page: hovers of the paper's AR.Drone with its three loads, simulated here.

use crate::picture::wav_of;
use hovertone_sim::paper::{GRAVITY_M_S2, LOADS};
use hovertone_sim::scenario::{ScenarioFile, ScenarioRun};
use serde_json::json;
use std::collections::BTreeMap;
use wasm_bindgen::prelude::wasm_bindgen;

/// Trials of each load: two tell how much the speed differs from flight to flight.
const TRIALS: u32 = 2;
/// Seed of all flights.
const SEED: u64 = 1;

/// The recordings of the example and its loads, as JSON: an experiment, and the name of each recording with the number of its load and trial.
#[wasm_bindgen]
pub fn example_plan() -> String {
    let name = |load: usize, trial: u32| format!("{}_{}.wav", LOADS[load].name.replace(' ', "_"), trial + 1);
    let loads: Vec<_> = LOADS
        .iter()
        .enumerate()
        .map(|(index, load)| {
            let added_g = ((load.mass_kg - LOADS[0].mass_kg) * 1e3).round();
            let recordings: Vec<String> = (0..TRIALS).map(|trial| name(index, trial)).collect();
            json!({ "name": load.name, "added_mass_kg": added_g / 1e3, "recordings": recordings })
        })
        .collect();
    let recordings: Vec<_> = (0..TRIALS)
        .flat_map(|trial| (0..LOADS.len()).map(move |load| (load, trial)))
        .map(|(load, trial)| json!({ "name": name(load, trial), "load": load, "trial": trial }))
        .collect();
    let vehicle = json!({ "preset": "ardrone", "mass_kg": LOADS[0].mass_kg, "gravity_m_s2": GRAVITY_M_S2 });
    json!({ "experiment": { "vehicle": vehicle, "load": loads }, "recordings": recordings }).to_string()
}

/// The sound of one hover of the example as a WAV file.
///
/// # Errors
/// None is known.
#[wasm_bindgen]
pub fn example_recording(load: usize, trial: u32) -> Result<Vec<u8>, String> {
    let load = LOADS.get(load).ok_or("the example has no such load")?;
    let scenario = ScenarioFile::paper_trial(load, trial, SEED).resolve(&BTreeMap::new());
    let scenario = scenario.map_err(|error| error.to_string())?;
    let sample_rate = scenario.sound.sample_rate_hz;
    let mut flown = ScenarioRun::new(scenario).map_err(|error| error.to_string())?;
    let (mut channels, mut rows) = (Vec::new(), Vec::new());
    while flown.advance(&mut channels, &mut rows).map_err(|error| error.to_string())? {}
    flown.finish(&mut channels);
    wav_of(channels.first().map_or(&[][..], Vec::as_slice), sample_rate)
}
