//! `hovertone export`, `compare` and `weigh` on numbers whose truth is known.

use crate::fit::number;
use crate::testkit::{hovertone, steady_hover, text, write_hover, write_noise};
use hovertone_vehicle::RotorSpeed;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

const TRUTH_TOTAL_N_S2: f64 = 2.83e-5;

fn hover_of(mass_kg: f64) -> RotorSpeed {
    RotorSpeed::from_rad_s((mass_kg * 9.8 / TRUTH_TOTAL_N_S2).sqrt())
}

/// A vehicle heard once, with its results.
fn identified(folder: &Path) -> PathBuf {
    for (name, mass_kg) in [("bare", 0.413), ("laden", 0.463)] {
        write_hover(&folder.join(format!("{name}.wav")), steady_hover("ardrone", hover_of(mass_kg), 4.0));
    }
    let toml = "[vehicle]\npreset = \"ardrone\"\ngravity_m_s2 = 9.8\npropeller_diameter_m = 0.2\n[air]\ntemperature_c = 25.0\n\
                pressure_hpa = 1010.0\nhumidity_percent = 70.0\n[[load]]\nname = \"bare\"\nrecordings = [\"bare.wav\"]\n";
    fs::write(folder.join("experiment.toml"), toml).unwrap();
    let out = folder.join("out");
    hovertone(&["identify", text(&folder.join("experiment.toml")), "-o", text(&out)]).ends_with(0);
    out.join("results.json")
}

#[test]
fn results_are_exported_compared_and_weigh_a_payload() {
    let folder = tempfile::tempdir().unwrap();
    let results = identified(folder.path());
    let formats = [
        "gazebo",
        "px4",
        "rotors",
        "gym-pybullet-drones",
        "rotorpy",
        "flightmare",
        "airsim",
        "crazyflow",
        "json",
        "yaml",
    ];
    let help = hovertone(&["export", "--help"]).ends_with(0).stdout;
    for words in ["px4:", "the same as gazebo", "crazyflie:", "the same as crazyflow"] {
        assert!(help.contains(words), "{words}:\n{help}");
    }
    let mut models = vec!["compare", "--json", text(&results)];
    let paths: Vec<PathBuf> = formats.iter().map(|format| folder.path().join(format)).collect();
    for (format, path) in formats.iter().zip(&paths) {
        hovertone(&["export", text(&results), "--to", format, "-o", text(path)]).ends_with(0);
        models.push(text(path));
    }
    let compared = hovertone(&models).ends_with(0).json_lines();
    assert_eq!(compared.len(), formats.len());
    for row in compared {
        assert!((number(&row, "/over_heard") - 1.0).abs() < 1e-6, "{row}");
        let hovers = number(&row, "/hover_speed_rad_s");
        assert!((hovers / hover_of(0.413).rad_s() - 1.0).abs() < 1e-3, "{row}");
    }
    let compared = hovertone(&["compare", text(&results), text(&paths[0])]).ends_with(0);
    // what weakened the constant is said again wherever it goes
    let exported = hovertone(&["export", text(&results), "--to", "gazebo"]).ends_with(0);
    let laden = folder.path().join("laden.wav");
    let weighed = hovertone(&["weigh", text(&laden), "--constant", text(&results)]).ends_with(0);
    assert!(weighed.stdout.contains("payload: ") && weighed.stdout.contains(" g"), "{}", weighed.stdout);
    for said in [&compared.stderr, &exported.stderr, &weighed.stderr] {
        assert!(said.contains("warning: there is only one load with a speed, so the law cannot be tested"), "{said}");
    }
    assert!(exported.stdout.contains("; warning: there is only one load with a speed"), "{}", exported.stdout);
    for words in ["motorConstant [N/(rad/s)^2]".to_owned(), format!("{:.0}", hover_of(0.413).rpm())] {
        assert!(compared.stdout.contains(&words), "{words}: {}", compared.stdout);
    }
    let weighed = hovertone(&["weigh", text(&laden), "--constant", text(&results), "--json"]).ends_with(0).stdout;
    let weighed: Value = serde_json::from_str(&weighed).unwrap();
    let payload_kg = number(&weighed, "/payload_kg/value");
    assert!((payload_kg - 0.050).abs() < 2.0 * number(&weighed, "/payload_kg/std_uncertainty"), "{weighed}");
    assert!((payload_kg - 0.050).abs() < 0.002, "{weighed}");
    let noise = folder.path().join("noise.wav");
    write_noise(&noise, 3.0);
    let both = ["weigh", text(&laden), text(&noise), "--constant", text(&results), "--json"];
    let both: Value = serde_json::from_str(&hovertone(&both).ends_with(3).stdout).unwrap();
    assert_eq!(both["mass_kg"]["value"], weighed["mass_kg"]["value"], "{both}");
    let status: Vec<&Value> = both["recordings"].as_array().unwrap().iter().map(|line| &line["status"]).collect();
    assert_eq!(status, ["ok", "no_rotor_tone"], "{both}");
    let nothing = ["weigh", text(&noise), "--constant", text(&results), "--json"];
    let nothing: Value = serde_json::from_str(&hovertone(&nothing).ends_with(3).stdout).unwrap();
    assert!(nothing["mass_kg"].is_null() && nothing["recordings"][0]["reason"].is_string(), "{nothing}");
    let nothing = hovertone(&["weigh", text(&noise), "--constant", text(&results)]).ends_with(3);
    assert_eq!(nothing.stdout, "no mass: no speed was heard\n");
    assert!(nothing.stderr.contains("\n1 recording without a speed\n"), "{}", nothing.stderr);
    for (flag, value) in [("--mass-std-kg", "nan"), ("--mass-std-kg", "-1"), ("--mass-kg", "nan")] {
        let refused = hovertone(&["weigh", text(&laden), "--constant", text(&results), flag, value]).ends_with(2);
        assert!(refused.stdout.is_empty() && refused.stderr.contains("must be"), "{flag} {value}: {}", refused.stderr);
    }
    let by_number = ["weigh", text(&laden), "--constant-n-s2", "2.83e-5", "--vehicle", "ardrone"];
    let nowhere = hovertone(&[&by_number[..], &["--latitude-deg", "10", "--height-m", "nan"]].concat()).ends_with(2);
    assert!(nowhere.stderr.contains("height_m"), "{}", nowhere.stderr);
    let nan = hovertone(&[&by_number[..], &["--constant-std-n-s2", "nan"]].concat()).ends_with(2);
    assert!(nan.stderr.contains("constant_std_n_s2"), "{}", nan.stderr);
}

/// The constant of one rotor on a stand weighs a vehicle only when somebody says how many rotors carry it.
#[test]
fn a_constant_of_one_rotor_needs_to_know_how_many_carry() {
    let folder = tempfile::tempdir().unwrap();
    let (table, fitted) = (folder.path().join("stand.csv"), folder.path().join("fitted.json"));
    let rows: String = [3000.0, 3600.0, 4200.0, 5000.0]
        .map(|rpm| {
            let thrust_n = TRUTH_TOTAL_N_S2 / 4.0 * RotorSpeed::from_rpm(rpm).rad_s().powi(2);
            format!("{rpm},{thrust_n},0.001\n")
        })
        .concat();
    fs::write(&table, format!("rpm,thrust_n,thrust_std_n\n{rows}")).unwrap();
    fs::write(&fitted, hovertone(&["fit", text(&table), "--json"]).ends_with(0).stdout).unwrap();
    let hover = folder.path().join("laden.wav");
    write_hover(&hover, steady_hover("ardrone", hover_of(0.463), 4.0));
    let weigh = ["weigh", text(&hover), "--constant", text(&fitted), "--json"];
    let refused = hovertone(&[&weigh[..], &["--order", "69"]].concat()).ends_with(2).stderr;
    assert!(refused.contains("--rotors"), "{refused}");
    for more in [&["--vehicle", "ardrone"][..], &["--order", "69", "--rotors", "4"]] {
        let more = [more, &["--gravity-m-s2", "9.8"]].concat();
        let weighed = hovertone(&[&weigh[..], &more].concat()).ends_with(0).stdout;
        let mass_kg = number(&serde_json::from_str(&weighed).unwrap(), "/mass_kg/value");
        assert!((mass_kg - 0.463).abs() < 0.001, "{mass_kg}");
    }
    // on a stand nobody's gravity cancels
    let weighed = hovertone(&[&weigh[..], &["--vehicle", "ardrone"]].concat()).ends_with(0).stdout;
    let std_kg = number(&serde_json::from_str(&weighed).unwrap(), "/mass_kg/std_uncertainty");
    assert!(std_kg > 0.463 * 0.015 / 9.80665, "{std_kg}");
}

/// A simulator's model as the vehicle of an experiment: its mass and rotors are used, its constant is compared.
#[test]
fn a_model_is_the_vehicle_of_an_experiment() {
    let folder = tempfile::tempdir().unwrap();
    write_hover(&folder.path().join("bare.wav"), steady_hover("ardrone", hover_of(0.413), 4.0));
    let results = |model: &str, vehicle: &str| {
        fs::write(folder.path().join("model.py"), model).unwrap();
        let toml = format!(
            "[vehicle]\npreset = \"ardrone\"\nmodel = \"model.py\"\ngravity_m_s2 = 9.8\n{vehicle}[[load]]\nname = \"bare\"\n\
             recordings = [\"bare.wav\"]\n"
        );
        let path = folder.path().join("experiment.toml");
        fs::write(&path, toml).unwrap();
        hovertone(&["identify", text(&path), "--json"])
    };
    let right = "{\n'mass': 0.413,\n'num_rotors': 4,\n'rotor_radius': 0.1,\n'k_eta': 7.075e-6,\n}\n";
    let run = results(right, "").ends_with(0);
    let found: Value = serde_json::from_str(&run.stdout).unwrap();
    assert!((number(&found, "/vehicle_model/over_heard") - 1.0).abs() < 2e-3, "{}", found["vehicle_model"]);
    assert_eq!(found["vehicle_model"]["agrees"], true);
    assert!((number(&found, "/settings/experiment/propeller_diameter_m") - 0.2).abs() < 1e-12);
    assert!(run.stderr.contains("this vehicle was not weighed"), "{}", run.stderr);
    let wrong = results(&right.replace("7.075e-6", "8.54858e-6"), "mass_kg = 0.413\n").ends_with(0);
    let found: Value = serde_json::from_str(&wrong.stdout).unwrap();
    assert!((number(&found, "/vehicle_model/over_heard") - 8.54858 / 7.075).abs() < 2e-3);
    assert_eq!(found["vehicle_model"]["agrees"], false);
    assert!(!wrong.stderr.contains("nobody weighed"), "{}", wrong.stderr);
    let words = hovertone(&["identify", text(&folder.path().join("experiment.toml"))]).ends_with(0).stdout;
    assert!(words.contains("model.py (rotorpy)") && words.contains("outside the ± of the measured"), "{words}");
    let broken = results("{\n'k_eta': -1.0,\n}", "").ends_with(1);
    assert!(broken.stderr.contains("k_eta = -1") && broken.stderr.contains("model.py"), "{}", broken.stderr);
    fs::remove_file(folder.path().join("model.py")).unwrap();
    let missing = hovertone(&["identify", text(&folder.path().join("experiment.toml"))]).ends_with(1);
    assert!(missing.stderr.contains("model.py"), "{}", missing.stderr);
}

#[test]
fn what_cannot_be_exported_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results.json");
    for (content, words) in [
        ("nonsense", "no results.json"),
        ("{}", "missing"),
        ("{\"thrust_constant_per_rotor_n_s2\": null, \"rotor_count\": 4}", "these results have no thrust constant"),
        ("{\"thrust_constant_per_rotor_n_s2\": {\"value\": -1.0}, \"rotor_count\": 4}", "above 0"),
    ] {
        fs::write(&path, content).unwrap();
        let run = hovertone(&["export", text(&path), "--to", "gazebo"]).ends_with(1);
        assert!(run.stderr.contains(words), "{content}: {}", run.stderr);
    }
    fs::write(&path, "{\"thrust_constant_per_rotor_n_s2\": {\"value\": 7e-6}, \"rotor_count\": 4}").unwrap();
    let bare = hovertone(&["export", text(&path), "--to", "airsim"]).ends_with(2).stderr;
    assert!(bare.contains("--air-density-kg-m3"), "{bare}");
    hovertone(&["export", text(&path), "--to", "airsim", "--diameter-m", "0.2", "--air-density-kg-m3", "1.2"])
        .ends_with(0);
    for (flag, value) in [
        ("--torque-constant-n-m-s2", "-1"),
        ("--hover-command", "7"),
        ("--hover-command", "nan"),
        ("--diameter-m", "254"),
        ("--air-density-kg-m3", "1200"),
    ] {
        let refused = hovertone(&["export", text(&path), "--to", "gazebo", flag, value]).ends_with(2).stderr;
        assert!(refused.contains("must be"), "{flag} {value}: {refused}");
    }
    let giant = ["export", text(&path), "--to", "airsim", "--diameter-m", "8", "--air-density-kg-m3", "1.2"];
    assert!(hovertone(&giant).ends_with(2).stderr.contains("no propeller has this value"));
    fs::write(folder.path().join("model.sdf"), "<a/>").unwrap();
    let model = folder.path().join("model.sdf");
    assert!(hovertone(&["compare", text(&path), text(&model)]).ends_with(1).stderr.contains("motorConstant"));
}
