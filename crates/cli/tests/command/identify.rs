//! `hovertone identify` on sound whose thrust constant is known.

use crate::report_fixture::write_rotor;
use crate::testkit::{Run, files_in, hovertone, recordings, repository, steady_bench, steady_hover, text, write_hover};
use hovertone_vehicle::RotorSpeed;
use serde_json::Value;
use std::fs;
use std::path::Path;

pub(crate) const TRUTH_TOTAL_N_S2: f64 = 2.83e-5;
const GRAVITY_M_S2: f64 = 9.80;
const VEHICLE_KG: f64 = 0.413;
const ADDED_KG: [f64; 2] = [0.0, 0.05];
/// Bias of an interpolated peak (Hann, two-fold zero padding), with room for noise, in bins of the frame.
const PEAK_BIAS_BINS: f64 = 0.01;

fn hover_speed(mass_kg: f64) -> RotorSpeed {
    RotorSpeed::from_rad_s((mass_kg * GRAVITY_M_S2 / TRUTH_TOTAL_N_S2).sqrt())
}

/// Two loads with two recordings each, and the experiment file.
pub(crate) fn write_experiment(folder: &Path) -> String {
    let mut text = format!(
        "[vehicle]\npreset = \"ardrone\"\nmass_kg = {VEHICLE_KG}\ngravity_m_s2 = {GRAVITY_M_S2}\n[tone]\norder = 69\n\
         [samples]\nlength_s = 2.0\n"
    );
    for (index, added_kg) in ADDED_KG.into_iter().enumerate() {
        fs::create_dir_all(folder.join(format!("load{index}"))).unwrap();
        for seed in 0..2 {
            let settings = steady_hover("ardrone", hover_speed(VEHICLE_KG + added_kg), 4.0);
            let path = folder.join(format!("load{index}/trial{seed}.wav"));
            write_hover(&path, hovertone_sim::HoverSettings { seed, ..settings });
        }
        text += &format!(
            "[[load]]\nname = \"l{index}\"\nadded_mass_kg = {added_kg}\nrecordings = [\"load{index}/*.wav\"]\n"
        );
    }
    let path = folder.join("experiment.toml");
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

fn results_in(folder: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join("results.json")).unwrap()).unwrap()
}

/// How far a constant may be off: twice what the peak's bias makes of the speed, in the frames that were used.
fn tolerance_share(results: &Value, speed: RotorSpeed, order: f64) -> f64 {
    let window_s = results["inputs"][0]["window_s"].as_f64().unwrap();
    2.0 * PEAK_BIAS_BINS / window_s / (speed.rev_s() * order)
}

#[test]
fn the_constant_of_a_hover_is_found_by_both_methods() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = write_experiment(folder.path());
    let out = folder.path().join("out");
    let run = hovertone(&["identify", &experiment, "-v", "-o", text(&out)]).ends_with(0);
    for words in [
        "Rotors as a group",
        "Harmonic likelihood",
        "Maximum trace",
        "Gaussian approximation",
        "1e-5 N s²",
        "1e-6 N s²",
        "rpm",
        "rad/s",
        "413.0",
        "463.0",
    ] {
        assert!(run.stdout.contains(words), "{words}:\n{}", run.stdout);
    }
    // all four turn at one speed: a group that has a mean
    assert!(
        run.stderr.contains("the 4 rotors could not be separated, so only their mean speed is known")
            && run.stderr.contains("hint:"),
        "{}",
        run.stderr
    );
    let by_ridge = hovertone(&["identify", &experiment, "--method", "maximum_trace"]).ends_with(0);
    assert!(by_ridge.stderr.contains("one tone is used for all"), "{}", by_ridge.stderr);
    let results = results_in(&out);
    let tolerance = tolerance_share(&results, hover_speed(VEHICLE_KG), 69.0);
    for method in ["harmonic", "maximum_trace", "gaussian"] {
        let total = results["methods"][method]["thrust_constant_total_n_s2"]["value"].as_f64().unwrap();
        let rotor = results["methods"][method]["thrust_constant_per_rotor_n_s2"]["value"].as_f64().unwrap();
        assert!((total / TRUTH_TOTAL_N_S2 - 1.0).abs() < tolerance, "{method}: {total}, tolerance {tolerance}");
        assert!((total / rotor - 4.0).abs() < 1e-9);
    }
    assert_eq!(results["method"], "separated");
    assert_eq!(results["thrust_constant_total_n_s2"], results["methods"]["separated"]["thrust_constant_total_n_s2"]);
    let total = results["thrust_constant_total_n_s2"]["value"].as_f64().unwrap();
    let expanded = results["uncertainty_budget"]["expanded_uncertainty_n_s2"].as_f64().unwrap();
    assert!((total - TRUTH_TOTAL_N_S2).abs() < expanded, "{total} ± {expanded}");
    assert!(expanded < 0.005 * total, "what is not known of each rotor is less than one ridge leaves open: {expanded}");
    assert_eq!(results["thrust_constant_total_n_s2"]["ending"], "solved");
    assert!(results["thrust_constant_total_n_s2"]["std_uncertainty"].as_f64().unwrap() > 0.0);
    let loads = results["loads"].as_array().unwrap();
    assert_eq!(loads.len(), 2);
    for (load, added_kg) in loads.iter().zip(ADDED_KG) {
        let mass_kg = VEHICLE_KG + added_kg;
        assert!((load["mass_kg"].as_f64().unwrap() - mass_kg).abs() < 1e-12);
        let is_close = |load: &Value, tolerance: f64| {
            let speed_rad_s = load["speed_rad_s"].as_f64().unwrap();
            assert!((speed_rad_s / hover_speed(mass_kg).rad_s() - 1.0).abs() < tolerance / 2.0, "{speed_rad_s}");
        };
        is_close(load, expanded / total);
        let of_name = |other: &&Value| other["name"] == load["name"];
        is_close(results["methods"]["harmonic"]["loads"].as_array().unwrap().iter().find(of_name).unwrap(), tolerance);
        assert!(
            load["fits"].is_boolean()
                && load["thrust_constant_total_n_s2"]["value"].is_f64()
                && load["name"].is_string()
        );
    }
    let inputs = results["inputs"].as_array().unwrap();
    let names: Vec<_> = inputs.iter().map(|input| input["file"].as_str().unwrap()).collect();
    assert_eq!(names, ["load0/trial0.wav", "load0/trial1.wav", "load1/trial0.wav", "load1/trial1.wav"]);
    assert!(inputs.iter().all(|input| input["recording"]["sha256"].as_str().unwrap().len() == 64));
    assert!(results["version"].is_string() && results["settings"]["experiment"].is_object());
    assert_rows_of_samples(&out);
}

/// Two loads, two trials, two samples of 2 s with 40 % overlap in 4 s, four methods.
fn assert_rows_of_samples(out: &Path) {
    let mut table = csv::Reader::from_path(out.join("samples.csv")).unwrap();
    let head: Vec<String> = table.headers().unwrap().iter().map(str::to_owned).collect();
    for name in [
        "load",
        "trial",
        "sample",
        "method",
        "speed_rad_s",
        "spread_rev_s",
        "frame_count",
        "thrust_constant_total_n_s2",
    ] {
        assert!(head.iter().any(|known| known == name), "{name} is not in {head:?}");
    }
    assert_eq!(table.records().count(), 2 * 2 * 2 * 4);
}

#[test]
fn a_bench_run_tells_of_one_rotor_and_json_is_results_json() {
    let folder = tempfile::tempdir().unwrap();
    let speed = RotorSpeed::from_rev_s(300.0);
    let settings = steady_bench("crazyflie", speed, 4.0);
    write_hover(&folder.path().join("bench.wav"), settings);
    let path = folder.path().join("experiment.toml");
    let text_of = "[vehicle]\npreset = \"crazyflie\"\n[[load]]\nname = \"bench\"\nthrust_n = 0.1\nrotors_running = 1\n\
                   recordings = [\"bench.wav\"]\n";
    fs::write(&path, text_of).unwrap();
    let out = folder.path().join("out");
    let printed = hovertone(&["identify", text(&path), "--json", "-o", text(&out)]).ends_with(0).stdout;
    assert_eq!(printed, fs::read_to_string(out.join("results.json")).unwrap());
    let results = results_in(&out);
    let rotor = results["thrust_constant_per_rotor_n_s2"]["value"].as_f64().unwrap();
    let truth = 0.1 / speed.rad_s().powi(2);
    assert!((rotor / truth - 1.0).abs() < tolerance_share(&results, speed, 2.0), "{rotor} {truth}");
    assert_eq!(results["thrust_constant_per_rotor_n_s2"]["ending"], "single_observation");
    assert!(results["loads"][0]["mass_kg"].is_null() && results["loads"][0]["fits"].is_null());
}

#[test]
fn recordings_that_are_not_there_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("experiment.toml");
    fs::write(
        &path,
        "# notes\n[vehicle]\npreset = \"ardrone\"\n[[load]]\nname = \"big\"\nrecordings = [\"big/*.mov\"]\n",
    )
    .unwrap();
    let says = |run: Run, words: &[&str]| {
        let run = run.ends_with(1);
        for word in words {
            assert!(run.stderr.contains(word), "{word}:\n{}", run.stderr);
        }
        let begin = format!("error: {}: ", path.display());
        assert!(run.stderr.starts_with(&begin), "the path stands first:\n{}", run.stderr);
    };
    says(hovertone(&["identify", text(&path)]), &["big/*.mov of load \"big\"", "--data-root", "notes at the top"]);
    let elsewhere = tempfile::tempdir().unwrap();
    let root = text(elsewhere.path());
    says(
        hovertone(&["identify", text(&path), "--data-root", root]),
        &["big/*.mov", root, "put the files into the folder"],
    );
    let nowhere = hovertone(&["identify", text(&path), "--data-root", "/no/such/folder"]).ends_with(1);
    assert!(nowhere.stderr.contains("no such folder"), "{}", nowhere.stderr);
    hovertone(&["identify", "/no/such/experiment.toml"]).ends_with(1);
}

/// The constant that follows from Bitcraze's table and the speeds of the recordings' README, not from our own output:
/// mean of the thrusts over the squared speeds. The tolerance is twice the 0.5 rev/s that the speeds are known to.
#[test]
fn the_shipped_bench_experiment_gives_a_constant_per_rotor() {
    let Some(data) = recordings("crazyflie-propeller") else { return };
    assert_eq!(files_in(&data, ".wav").len(), 7);
    let path = repository().join("examples/crazyflie-bench.toml");
    let run = hovertone(&["identify", text(&path), "--data-root", text(&data), "--json"]).ends_with(0);
    let results: Value = serde_json::from_str(&run.stdout).unwrap();
    let known =
        [(0.07800, 325.6), (0.08860, 347.3), (0.09920, 360.1), (0.10957, 376.6), (0.12250, 388.3), (0.13678, 405.2)];
    let constants = known.map(|(thrust_n, rev_s)| thrust_n / RotorSpeed::from_rev_s(rev_s).rad_s().powi(2));
    let expected = constants.iter().sum::<f64>() / constants.len() as f64;
    let plain = results["plain_mean_total_n_s2"]["value"].as_f64().unwrap() / 4.0;
    assert!((plain / expected - 1.0).abs() < 2.0 * 0.5 / 325.6, "{plain} {expected}");
    // the fit weighs by the thrusts' uncertainty, a tenth of each: by York's formula with the README's speeds
    let ratios = known.map(|(thrust_n, rev_s)| RotorSpeed::from_rev_s(rev_s).rad_s().powi(2) / thrust_n);
    let weighed = ratios.iter().sum::<f64>() / ratios.iter().map(|ratio| ratio * ratio).sum::<f64>();
    let rotor = results["thrust_constant_per_rotor_n_s2"]["value"].as_f64().unwrap();
    assert!((rotor / weighed - 1.0).abs() < 2.0 * 0.5 / 325.6, "{rotor} {weighed}");
    let stranger = hovertone(&["identify", text(&path)]).ends_with(1);
    assert!(stranger.stderr.contains("40000.wav") && stranger.stderr.contains("--data-root"), "{}", stranger.stderr);
}

/// Where the diameter is such that the thrust contradicts the sound, no single speed is told, and the recording is no trial.
#[test]
fn a_recording_with_several_possible_speeds_is_no_trial() {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("hover.wav");
    write_rotor(&recording, 100.0, 0.0, 6.0, 1);
    let vehicle = |diameter: &str| ["--blades", "2", "--rotors", "4", "--diameter-m", diameter].map(str::to_owned);
    let is_ambiguous = |diameter: &String| {
        let known = vehicle(diameter);
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        let flags = ["speed", "--json", "--mean-only", "--mass-kg", "0.5", text(&recording)];
        hovertone(&[&flags, &known[..]].concat()).json_lines()[0]["status"] == "ambiguous"
    };
    let diameters = (12u32..40).map(|step| format!("{:.2}", 0.01 * f64::from(step)));
    let diameter = diameters.into_iter().find(is_ambiguous).expect("no diameter leaves two speeds");
    let known = vehicle(&diameter);
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    let mass = format!("0.5={}", text(&recording));
    let out = folder.path().join("out");
    let flags = ["identify", "--mass", &mass, "--method", "harmonic", "-o", text(&out)];
    let run = hovertone(&[&flags, &known[..]].concat()).ends_with(3);
    assert!(run.stderr.contains("ambiguous: several rotor speeds explain this sound"), "{}", run.stderr);
    assert!(run.stdout.contains("a speed was heard in none; ") && run.stdout.contains("C_f: none"), "{}", run.stdout);
    // the page weighs the speeds against each other, and draws them over the spectrogram
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    let row = page.split("<tr>").find(|row| row.contains("<span class=\"spoken\">ambiguous</span>")).unwrap();
    assert!(row.contains("not decided: ") && row.contains(" rev/s, odds ") && row.contains(" %)"), "{row}");
    let fold = page.split("<details class=\"trial\"").nth(1).unwrap();
    for words in
        ["<dt>runner-up</dt>", "<dt>possible speeds</dt>", "tracks reading-1", "reading reading-2", "key readings"]
    {
        assert!(fold.contains(words), "{words}");
    }
}
