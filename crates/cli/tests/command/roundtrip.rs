//! Simulate → WAV → identify: C_f comes back. `hovertone-bench roundtrip` does a hundred of longer sound.

use crate::testkit::{flown_hover, hovertone, text};
use hovertone_vehicle::COVERAGE_FACTOR;
use serde_json::Value;
use std::fs;
use std::path::Path;

const SCENARIO_COUNT: u64 = 10;
const DURATION_S: f64 = 5.0;
const SPREAD_SHARE: f64 = 0.01;
const METHODS: [&str; 2] = ["maximum_trace", "gaussian"];
/// No answer may be off by more than this.
const GROSS_SHARE: f64 = 0.05;
/// A ridge that follows one rotor instead of the mean of four is off by at most the fastest from the mean: speeds within
/// ±`SPREAD_SHARE`/2, so C_f within twice that …
const ONE_ROTOR_SHARE: f64 = SPREAD_SHARE;
/// … and half of that is what the median may be: the loudest rotor is any of the four, not the fastest each time.
const MEDIAN_SHARE: f64 = ONE_ROTOR_SHARE / 2.0;

/// Error, standard uncertainty by weighing and speeds, and expanded uncertainty of the budget, as shares of the truth, by method.
fn trip(folder: &Path, seed: u64) -> Vec<(f64, f64, f64)> {
    let (file, truth) = flown_hover(folder, seed, DURATION_S, SPREAD_SHARE);
    let experiment = format!(
        "[vehicle]\npreset = \"{}\"\nmass_kg = {}\nmass_std_kg = 0.0\ngravity_m_s2 = {}\n\
         [[load]]\nname = \"hover\"\nrecordings = [\"flown/sound.wav\"]\n",
        file.vehicle.preset, truth["mass_kg"], file.flight.gravity_m_s2,
    );
    fs::write(folder.join("experiment.toml"), experiment).unwrap();
    let said = hovertone(&["identify", text(&folder.join("experiment.toml")), "--json"]).ends_with(0).stdout;
    let results: Value = serde_json::from_str(&said).unwrap();
    let true_total = truth["hover"]["thrust_constant_total_n_s2"].as_f64().unwrap();
    METHODS
        .map(|method| {
            let constant = &results["methods"][method]["thrust_constant_total_n_s2"];
            let of = |field: &str| constant[field].as_f64().unwrap() / true_total;
            let expanded = results["methods"][method]["expanded_uncertainty_total_n_s2"].as_f64().unwrap();
            let measured = results["methods"][method]["measured_std_total_n_s2"].as_f64().unwrap();
            (of("value") - 1.0, measured / true_total, expanded / true_total)
        })
        .to_vec()
}

#[test]
fn ten_random_hovers_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let trips: Vec<_> = (1..=SCENARIO_COUNT).map(|seed| trip(&folder.path().join(seed.to_string()), seed)).collect();
    for (index, method) in METHODS.iter().enumerate() {
        let answers: Vec<(f64, f64, f64)> = trips.iter().map(|trip| trip[index]).collect();
        let mut within = 0;
        for (seed, &(error, std, expanded)) in (1..).zip(&answers) {
            println!("{method}, seed {seed}: {:+.2} %, U {:.2} %", 100.0 * error, 100.0 * COVERAGE_FACTOR * std);
            assert!(error.abs() < GROSS_SHARE, "{method}, seed {seed}: {error}");
            // what it says of itself, and what one ridge for four rotors can add to it
            assert!(error.abs() < ONE_ROTOR_SHARE + 3.0 * std, "{method}, seed {seed}: {error} ± {std}");
            // the budget knows that one ridge stands for four rotors
            assert!(error.abs() <= expanded, "{method}, seed {seed}: {error}, U of the budget {expanded}");
            within += u32::from(error.abs() <= COVERAGE_FACTOR * std);
        }
        let mut errors: Vec<f64> = answers.iter().map(|(error, ..)| error.abs()).collect();
        errors.sort_by(f64::total_cmp);
        assert!(errors[errors.len() / 2] < MEDIAN_SHARE, "{method}: {errors:?}");
        // of answers that are within U by a chance of 0.9, fewer than 6 of 10 are so in 1 of 600 lists of seeds
        assert!(within >= 6, "{method}: {within} of {SCENARIO_COUNT} within U");
    }
}
