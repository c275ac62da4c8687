//! `hovertone fit`, `export`, `compare` and `weigh` on numbers whose truth is known.

use crate::testkit::{files_in, hovertone, recordings, steady_hover, text, write_hover, write_noise};
use hovertone_vehicle::RotorSpeed;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// The paper's table 1 as a CSV, with its speeds' standard errors over 25 samples.
fn paper_table(folder: &Path, big_hull_g: u32) -> PathBuf {
    let path = folder.join("paper.csv");
    let rows = format!(
        "mass_g,mass_std_g,rpm,speed_std_rpm\n413,0.5,3610.3438,8.89832\n444,0.5,3742.0275,9.67626\n{big_hull_g},0.5,3820.1625,9.54946\n"
    );
    fs::write(&path, rows).unwrap();
    path
}

fn number(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("{pointer} in {value}"))
}

#[test]
fn the_papers_rows_fit_with_462_g_and_not_with_472() {
    let folder = tempfile::tempdir().unwrap();
    let fit = |big_hull_g: u32| {
        let table = paper_table(folder.path(), big_hull_g);
        let arguments = ["fit", text(&table), "--rotors", "4", "--gravity-m-s2", "9.8", "--json"];
        hovertone(&arguments).ends_with(0).json_lines().remove(0)
    };
    let right = fit(462);
    assert!((number(&right, "/thrust_constant_total_n_s2/value") - 2.8314e-5).abs() < 5e-10);
    assert!((number(&right, "/thrust_constant_total_n_s2/std_uncertainty") - 0.0084e-5).abs() < 5e-9);
    let rotor = number(&right, "/thrust_constant_per_rotor_n_s2/value");
    assert!((rotor * 4.0 - number(&right, "/thrust_constant_total_n_s2/value")).abs() < 1e-18);
    assert!(number(&right, "/fit/agreement/chi_square") < 0.1);
    assert!(right.to_string().contains("is 1.12 times the smallest, but must be 1.41 times the smallest"), "{right}");
    let wrong = fit(472);
    assert!((number(&wrong, "/fit/agreement/p_value") - 0.0055).abs() < 2e-4);
    let misfits: Vec<&Value> =
        wrong["fit"]["points"].as_array().unwrap().iter().filter(|point| point["fits"] == false).collect();
    assert_eq!(misfits.len(), 1);
    let mass_g = 1e3 * number(misfits[0], "/force_that_fits_n") / 9.8;
    assert!((mass_g - 462.4).abs() < 0.5, "{mass_g}");
    let words = hovertone(&["fit", text(&paper_table(folder.path(), 472)), "--gravity-m-s2", "9.8"]).ends_with(0);
    assert!(words.stderr.contains("line 4 of the table does not fit the others; a mass of 462."), "{}", words.stderr);
}

/// Constants and exponents as the README of the recordings has them, to its digits.
#[test]
fn thrust_stands_as_their_readme_says() {
    let Some(data) = recordings("thrust-stands") else { return };
    let mut fits: Vec<Value> = Vec::new();
    for path in files_in(&data, ".csv") {
        let document: Value =
            serde_json::from_str(&hovertone(&["fit", text(&path), "--json"]).ends_with(0).stdout).unwrap();
        match document["groups"].as_array() {
            Some(groups) => fits.extend(groups.iter().cloned()),
            None => fits.push(document),
        }
    }
    assert_eq!(fits.len(), 7, "three runs and four motors");
    for (name, constant, unit) in
        [("b4_7", 6.1, 1e-7), ("g8_11", 1.45, 1e-6), ("m8_11", 1.36, 1e-6), ("DJI 9450", 1.12, 1e-5)]
    {
        let is_named = |fit: &&Value| {
            fit["file"].as_str().unwrap().contains(name) || fit["group"].as_str().unwrap().contains(name)
        };
        let fit = fits.iter().find(is_named).unwrap();
        let found = number(fit, "/thrust_constant_per_rotor_n_s2/value") / unit;
        let digits = if constant == 6.1 { 0.05 } else { 0.005 };
        assert!((found - constant).abs() <= digits, "{name}: {found}");
        let residual_percent = (100.0 * number(fit, "/fit/residual_max_share")).round();
        assert!((1.0..=3.0).contains(&residual_percent), "{name}: {residual_percent} % of full scale");
    }
    for fit in &fits {
        let exponent = number(fit, "/fit/power_law/exponent/value");
        assert!((1.95..2.25).contains(&exponent), "{exponent}: 2.0 to 2.2");
    }
    let m8_11 = fits.iter().find(|fit| fit["file"].as_str().unwrap().contains("m8_11")).unwrap();
    assert!(m8_11["notices"].to_string().contains("used as positive ones"), "{m8_11}");
    let bitcraze = recordings("crazyflie-propeller").unwrap().join("pwm_to_thrust.csv");
    let fit = hovertone(&["fit", text(&bitcraze), "--rotors", "4", "--json"]).ends_with(0).json_lines().remove(0);
    assert!((number(&fit, "/thrust_constant_per_rotor_n_s2/value") - 2.218e-8).abs() < 5e-12);
    assert!((number(&fit, "/fit/power_law/exponent/value") - 2.15).abs() < 0.005);
}

#[test]
fn bad_tables_are_refused_or_flagged() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv");
    let run = |rows: &str| {
        fs::write(&path, rows).unwrap();
        hovertone(&["fit", text(&path), "--json"])
    };
    for (rows, words) in [
        ("rpm,mass_g\n3600,0\n", &["line 2", "above 0", "table.csv"][..]),
        ("rpm,mass_g\n3600,-413\n", &["line 2", "above 0"]),
        ("rpm,mass_g\n3600,NaN\n", &["line 2", "no number"]),
        ("rpm,volts\n3600,11\n", &["rpm, volts", "--help"]),
        ("rpm,thrust_n\n0,1\n", &["nothing to fit"]),
        ("rpm,mass_g\n3600,413\n", &["at least 3 usable rows", "has 1", "mass_std_g"]),
        ("rpm,mass_g\n3600,413\n3700,1744\n", &["at least 3 usable rows", "has 2", "mass_std_g"]),
        // three rows that are one row
        ("rpm,mass_g\n3600,413\n3600,413\n3600,413\n", &["exactly on F = C ω²", "scatter of measured rows"]),
    ] {
        let refused = run(rows).ends_with(2);
        assert!(refused.stdout.is_empty());
        assert!(words.iter().all(|word| refused.stderr.contains(word)), "{rows:?}: {}", refused.stderr);
    }
    let one = run("rpm,mass_g,mass_std_g\n3600,413,1\n").ends_with(0).json_lines().remove(0);
    assert!(one["notices"].to_string().contains("only one load"), "{one}");
    let equal = run("rpm,mass_g\n3600,413\n3610,413\n3605,413\n").ends_with(0).json_lines().remove(0);
    assert!(equal["notices"].to_string().contains("all 3 loads have the same force"), "{equal}");
    assert!(equal["fit"]["with_intercept"].is_null() && equal["fit"]["power_law"].is_null(), "{equal}");
    // three rows that are nearly one
    for rows in ["rpm,thrust_n\n3600,1.00\n3601,1.002\n3602,0.999\n", "rpm,thrust_n\n3600,1\n3620,1.012\n3640,1.021\n"]
    {
        let near = run(rows).ends_with(0).json_lines().remove(0);
        assert!(near["fit"]["with_intercept"].is_null() && near["fit"]["power_law"].is_null(), "{near}");
        let said = hovertone(&["fit", text(&path)]).ends_with(0);
        assert!(said.stdout.contains("no other law is compared") && !said.stdout.contains("F₀ + C"), "{}", said.stdout);
        let is_said = ["have the same force", "forces are too alike"].iter().any(|words| said.stderr.contains(words));
        assert!(is_said && said.stderr.contains("hint: "), "{}", said.stderr);
    }
    // half of the rows are four times too heavy, and nobody knows which half
    let halves = run("rpm,mass_g\n3600,413\n3610,416\n3700,1744\n3710,1755\n").ends_with(3).json_lines().remove(0);
    assert!(halves["notices"].to_string().contains("which group is right (hint: do not use this constant"), "{halves}");
    let said = hovertone(&["fit", text(&path)]).ends_with(3).stdout;
    assert!(said.contains("\ndo not use this constant: C_f, one rotor = "), "{said}");
    // 300 % too heavy
    let outlier = run("rpm,mass_g\n3600,400\n3818,450\n4025,2000\n4221,550\n").ends_with(0).json_lines().remove(0);
    assert!(outlier["notices"].to_string().contains("line 4 of the table does not fit"), "{outlier}");
    assert!(outlier["notices"].to_string().contains("left out"), "{outlier}");
    let said = hovertone(&["fit", text(&path)]).ends_with(0).stdout;
    assert!(said.contains("4 table rows, 1 of them left out of the fit, mass_g against rpm"), "{said}");
    let expected = 0.4 * 9.80665 / RotorSpeed::from_rpm(3600.0).rad_s().powi(2);
    let found = number(&outlier, "/thrust_constant_total_n_s2/value");
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} {expected}");
}

/// A log at 44 Hz, spinning up and down: hundreds of rows, most of them sound.
#[test]
fn a_log_of_a_stand_is_fitted_without_a_flood_of_warnings() {
    let Some(data) = recordings("logs") else { return };
    let log = data.join("rcbenchmark_command_steps.csv");
    let run = hovertone(&["fit", text(&log), "--json"]).ends_with(0);
    let fit = run.json_lines().remove(0);
    assert!(number(&fit, "/row_count") > 500.0);
    assert!(fit["notices"].as_array().unwrap().len() < 10, "{}", fit["notices"]);
    assert!(fit["notices"].to_string().contains("rows do not fit the others: line "), "{}", fit["notices"]);
    assert!(number(&fit, "/torque_constant_per_rotor_n_m_s2") > 0.0);
}

#[test]
fn a_row_that_fits_the_preferred_law_is_not_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("offset.csv");
    fs::write(&table, "rad/s,thrust_n\n100,0.31\n200,0.62\n300,1.12\n400,1.83\n500,2.74\n600,3.85\n").unwrap();
    let run = hovertone(&["fit", text(&table)]).ends_with(0);
    assert!(
        run.stdout.contains("6 table rows, thrust_n") && run.stdout.contains("F = F₀ + C ω² (preferred)"),
        "{}",
        run.stdout
    );
    assert!(!run.stderr.contains("left out"), "{}", run.stderr);
    // a tenth of the speed is no offset
    fs::write(&table, "rad/s,thrust_n\n20,0.62\n300,1.12\n400,1.83\n500,2.74\n600,3.85\n").unwrap();
    assert!(hovertone(&["fit", text(&table)]).stderr.contains("left out"));
}

#[test]
fn rows_that_contradict_each_other_are_no_complete_answer() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("two.csv");
    fs::write(&table, "rpm,thrust_n,thrust_std_n\n3000,0.511,0.003\n3000,0.6,0.003\n6000,2.3,0.003\n6000,2.05,0.003\n")
        .unwrap();
    let run = hovertone(&["fit", text(&table)]).ends_with(3);
    assert!(run.stderr.contains("the rows do not fit each other"), "{}", run.stderr);
}

#[test]
fn a_plan_tells_before_flying() {
    let plan = |wanted: &str, more: &[&str]| {
        let mut arguments = vec!["fit", "--plan", "--mass-kg", "0.413", "--wanted-share", wanted];
        arguments.extend(more);
        hovertone(&arguments)
    };
    let words = plan("0.025", &["--latitude-deg", "-20.3", "--added-mass-kg", "0.1"]).ends_with(0).stdout;
    for word in ["loads", "recordings of each load", "s of hover", "k = 2", "rotors not separated"] {
        assert!(words.contains(word), "{words}");
    }
    // the load that it names tests the law
    let added_kg = words.split("--added-mass-kg ").nth(1).unwrap().trim_end().trim_end_matches('.').to_owned();
    let heavier = plan("0.025", &["--latitude-deg", "-20.3", "--added-mass-kg", &added_kg]).ends_with(0).stdout;
    assert!(heavier.contains("These loads also test"), "{words}\n{heavier}");
    let unreachable = plan("0.005", &["--added-mass-kg", "0.1"]).ends_with(2).stderr;
    let nearer = "so near the vehicle that `hovertone speed` separates the rotors or hears them as a group, and plan again with --rotors-separated";
    assert!(unreachable.contains("rotors not separated") && unreachable.contains(nearer), "{unreachable}");
    let apart = plan("0.01", &["--added-mass-kg", "0.1", "--rotors-separated", "--latitude-deg", "-20.3", "--json"])
        .ends_with(0)
        .stdout;
    let plan: Value = serde_json::from_str(&apart).unwrap();
    assert!(number(&plan, "/expanded_share") <= 0.01 && number(&plan, "/load_count") >= 3.0);
    hovertone(&["fit", "--plan"]).ends_with(2);
    for (flag, value) in
        [("--mass-std-kg", "nan"), ("--mass-std-kg", "-1"), ("--diameter-m", "nan"), ("--wanted-share", "inf")]
    {
        let refused = hovertone(&["fit", "--plan", "--mass-kg", "0.413", flag, value]).ends_with(2).stderr;
        let name = flag.trim_start_matches("--").replace('-', "_");
        assert!(refused.contains(&name) && refused.contains("must be"), "{flag} {value}: {refused}");
    }
}

/// Masses are weighed by gravity, and where nobody says where, that is uncertain by 0.15 %.
#[test]
fn a_table_of_masses_counts_gravity() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv");
    fs::write(&path, "mass_g,mass_std_g,rpm\n413,0.1,3610.3438\n826,0.1,5105.797\n").unwrap();
    let share = |more: &[&str]| {
        let fit = hovertone(&[&["fit", text(&path), "--json"], more].concat()).ends_with(0).json_lines().remove(0);
        number(&fit, "/thrust_constant_total_n_s2/std_uncertainty") / number(&fit, "/thrust_constant_total_n_s2/value")
    };
    let (known, unknown) = (share(&["--gravity-m-s2", "9.8"]), share(&[]));
    assert!((unknown.powi(2) - known.powi(2)).sqrt() / (0.015 / 9.80665) - 1.0 < 0.01, "{known} {unknown}");
    assert!(unknown > 5.0 * known, "{known} {unknown}");
}

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
        assert!(said.contains("warning: only one load can be used, so the law cannot be tested"), "{said}");
    }
    assert!(exported.stdout.contains("; warning: only one load can be used"), "{}", exported.stdout);
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
