//! Nonsense is refused: exit code 2, no data, what is wrong, why, and what to do.

use crate::testkit::{hovertone, refused_with, steady_bench, steady_hover, text, write_hover};
use hovertone_vehicle::RotorSpeed;
use std::fs;
use std::path::{Path, PathBuf};

const CONSTANT_TOTAL_N_S2: f64 = 2.83e-5;
const GRAVITY_M_S2: f64 = 9.8;

/// A hover of the AR.Drone with this mass.
fn hover(folder: &Path, mass_kg: f64) -> PathBuf {
    let path = folder.join(format!("{:.0}g.wav", 1e3 * mass_kg));
    let speed = RotorSpeed::from_rad_s((mass_kg * GRAVITY_M_S2 / CONSTANT_TOTAL_N_S2).sqrt());
    write_hover(&path, steady_hover("ardrone", speed, 3.0));
    path
}

#[test]
fn a_mass_in_grams_is_a_slip_that_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let wav = hover(folder.path(), 0.413);
    let weigh = ["weigh", text(&wav), "--constant-n-s2", "2.83e-5", "--gear", "8:69", "--rotors", "4", "--mass-kg"];
    let heavy = ["mass_kg = 413", "alone would hover at", "rev/s", "--mass-kg 0.413"];
    refused_with(&[&weigh[..], &["413"]].concat(), &heavy);
    // before anything is heard: the recording is not there
    let absent = ["weigh", "absent.wav", "--constant-n-s2", "2.83e-5", "--gear", "8:69", "--rotors", "4"];
    refused_with(&[&absent[..], &["--mass-kg", "413"]].concat(), &heavy);
    refused_with(&[&weigh[..], &["50"]].concat(), &["payload weighs 41", "alone weighs 50000 g", "--mass-kg 0.05"]);
    refused_with(&[&weigh[..], &["0.01"]].concat(), &["more than ten times the 10 g of the vehicle", "check the mass"]);
    refused_with(&[&weigh[..], &["-0.413"]].concat(), &["mass_kg = -0.413", "above 0"]);
    hovertone(&[&weigh[..], &["0.413"]].concat()).ends_with(0);
    for command in [&["speed"][..], &["tones"], &["weigh", "--constant-n-s2", "2.83e-5"]] {
        let flown = ["a.wav", "--vehicle", "ardrone", "--mass-kg", "413"];
        refused_with(&[command, &flown].concat(), &["mass_kg = 413", "weighs 0.413 kg", "for 413 g write 0.413"]);
    }
    // grams with their unit of a far heavier vehicle are no slip of the unit
    let other = ["speed", "a.wav", "--vehicle", "crazyflie", "--mass-kg", "4130g"];
    refused_with(&other, &["mass_kg = 4.13", "check the mass (in kilograms) and the name of the vehicle"]);
    let plan = ["fit", "--plan", "--mass-kg", "0.413", "--added-mass-kg"];
    refused_with(&[&plan[..], &["31"]].concat(), &["added_mass_kg = 31", "31 g are 0.031"]);
    refused_with(&[&plan[..], &["-0.1"]].concat(), &["added_mass_kg = -0.1", "above 0"]);
    let experiment = folder.path().join("experiment.toml");
    for (vehicle, load, words) in [
        ("mass_kg = 413", "", "masses are in kg"),
        ("mass_kg = 0.413", "added_mass_kg = 31", "masses are in kg"),
        ("mass_kg = 0.413", "added_mass_kg = -0.031", "0 or more"),
        ("mass_kg = -0.413", "", "mass_kg = -0.413"),
        ("propeller_diameter_m = -0.2", "", "propeller_diameter_m = -0.2"),
        ("mass_kg = 0.413", "from_s = -1.0", "from_s of load"),
    ] {
        let loads = format!("[[load]]\nname = \"a\"\nrecordings = [\"*.wav\"]\n{load}\n");
        fs::write(&experiment, format!("[vehicle]\npreset = \"ardrone\"\n{vehicle}\n{loads}")).unwrap();
        refused_with(&["identify", text(&experiment)], &[words, "experiment.toml"]);
    }
}

#[test]
fn a_percentage_is_no_share() {
    let plan = ["fit", "--plan", "--mass-kg", "0.413"];
    refused_with(
        &[&plan[..], &["--wanted-share", "2"]].concat(),
        &["wanted_share = 2", "2 % are 0.02", "--wanted-share 0.02"],
    );
    refused_with(
        &[&plan[..], &["--speed-spread-share", "1.23"]].concat(),
        &["speed_spread_share = 1.23", "2 % are 0.02"],
    );
}

#[test]
fn times_and_lengths_are_not_negative() {
    for command in ["speed", "tones"] {
        refused_with(&[command, "a.wav", "--from", "-5"], &["--from = -5", "begins at 0 s"]);
        refused_with(&[command, "a.wav", "--to", "-1"], &["--to = -1"]);
        refused_with(&[command, "a.wav", "--diameter-m", "-0.2"], &["diameter_m = -0.2"]);
        refused_with(&[command, "a.wav", "--mass-kg", "-0.4"], &["mass_kg = -0.4"]);
    }
    for (flag, value) in
        [("--window-s", "-1"), ("--drift-m-max", "-1"), ("--clock-ppm", "-1"), ("--radial-speed-m-s-max", "-1")]
    {
        let name = flag.trim_start_matches("--").replace('-', "_");
        let trace: &[&str] = if flag == "--window-s" { &["--method", "maximum_trace"] } else { &[] };
        refused_with(&[&["speed", "a.wav", "--blades", "2", flag, value], trace].concat(), &[&format!("{name} = -1")]);
    }
    for flag in ["--correlation-s", "--mass-std-kg", "--diameter-m"] {
        refused_with(&["fit", "--plan", "--mass-kg", "0.413", flag, "-1"], &["= -1"]);
    }
}

#[test]
fn blades_and_gear_are_those_of_the_vehicle() {
    let ardrone = |more: &[&str], words: &[&str]| {
        for command in ["speed", "spectrogram"] {
            let output: &[&str] = if command == "spectrogram" { &["-o", "never.png"] } else { &[] };
            refused_with(&[&[command, "a.wav", "--vehicle", "ardrone"], more, output].concat(), words);
        }
        refused_with(&[&["weigh", "a.wav", "--constant-n-s2", "2.8e-5", "--vehicle", "ardrone"], more].concat(), words);
    };
    ardrone(&["--blades", "3"], &["blades = 3", "\"ardrone\" have 2 blades", "leave out one"]);
    ardrone(&["--gear", "8:68"], &["gear = 8:68", "\"ardrone\" is 8:69", "leave out one"]);
    ardrone(&["--gear", "68"], &["gear = 1:68", "8:69"]);
    ardrone(&["--gear", "69:8"], &["gear = 69:8", "swapped", "write 8:69"]);
    ardrone(&["--rotors", "6"], &["rotors = 6", "\"ardrone\" has 4 rotors"]);
    refused_with(
        &["identify", "--vehicle", "ardrone", "--rotors", "6", "--mass", "413g=a.wav"],
        &["rotors = 6", "\"ardrone\" has 4 rotors"],
    );
    refused_with(&["speed", "a.wav", "--gear", "69:8"], &["gear = 69:8", "swapped", "write 8:69"]);
    refused_with(&["speed", "a.wav", "--gear", "4"], &["a wheel of 4 teeth", "if 4 is the number of blades"]);
    let folder = tempfile::tempdir().unwrap();
    let experiment = folder.path().join("experiment.toml");
    let load = "[[load]]\nname = \"a\"\nrecordings = [\"a.wav\"]\n";
    fs::write(
        &experiment,
        format!("[vehicle]\nrotors = 4\nmass_kg = 0.4\ngear = {{ pinion = 69, wheel = 8 }}\n{load}"),
    )
    .unwrap();
    refused_with(&["identify", text(&experiment)], &["gear = 69:8", "swapped", "write 8:69"]);
}

#[test]
fn the_vehicles_own_blades_and_gear_may_be_said() {
    let folder = tempfile::tempdir().unwrap();
    let wav = hover(folder.path(), 0.413);
    let speed = ["speed", "--rotors", "1", "--json", text(&wav), "--vehicle", "ardrone"];
    let heard =
        |more: &[&str]| hovertone(&[&speed[..], more].concat()).ends_with(0).json_lines()[0]["speed_rpm"].as_f64();
    let alone = heard(&[]).unwrap();
    for more in [&["--gear", "8:69"][..], &["--gear", "69"], &["--gear", "8:69", "--blades", "2"]] {
        assert!((heard(more).unwrap() / alone - 1.0).abs() < 1e-3, "{more:?}");
    }
}

#[test]
fn a_constant_belongs_to_its_vehicle() {
    let folder = tempfile::tempdir().unwrap();
    let results = folder.path().join("results.json");
    let name = hovertone_vehicle::find_preset("ardrone").unwrap().name;
    let written = format!(
        "{{\"thrust_constant_per_rotor_n_s2\":{{\"value\":7e-6}},\
         \"settings\":{{\"experiment\":{{\"vehicle_name\":\"{name}\",\"rotor_count\":4}}}}}}"
    );
    fs::write(&results, written).unwrap();
    refused_with(
        &["weigh", "a.wav", "--constant", text(&results), "--vehicle", "crazyflie"],
        &["measured with the vehicle \"ardrone\"", "--vehicle is \"crazyflie\"", "leave --vehicle out"],
    );
    let same = hovertone(&["weigh", "nowhere.wav", "--constant", text(&results), "--vehicle", "ardrone"]).ends_with(1);
    assert!(same.stderr.contains("nowhere.wav"), "{}", same.stderr);
}

#[test]
fn tips_faster_than_mach_0_6_are_refused_also_with_blades() {
    let folder = tempfile::tempdir().unwrap();
    let wav = folder.path().join("hover.wav");
    let settings = steady_bench("crazyflie", RotorSpeed::from_rev_s(300.0), 3.0);
    write_hover(&wav, settings);
    let speed = ["speed", "--blades", "2", "--rotors", "1", text(&wav), "--diameter-m"];
    // 45 mm, and 4.5 m by a slip
    hovertone(&[&speed[..], &["0.045"]].concat()).ends_with(0);
    refused_with(&[&speed[..], &["4.5"]].concat(), &["diameter_m = 4.5", "300", "Mach 0.6", "in metres"]);
    refused_with(&["tones", "--blades", "2", text(&wav), "--diameter-m", "4.5"], &["diameter_m = 4.5", "Mach 0.6"]);
    hovertone(&["tones", "--blades", "2", text(&wav), "--diameter-m", "0.045"]).ends_with(0);
    // sound that arrives was told already
    let live = ["listen", "--blades", "2", "--speed", "1000", "--from-file", text(&wav), "--diameter-m"];
    let told = |diameter_m: &str| hovertone(&[&live[..], &[diameter_m]].concat()).ends_with(0).stderr;
    assert!(told("4.5").contains("the blade tips would move at Mach"), "{}", told("4.5"));
    assert!(!told("0.045").contains("Mach"), "{}", told("0.045"));
    let png = folder.path().join("x.png");
    let picture =
        ["spectrogram", "--blades", "2", "--rotors", "1", text(&wav), "-o", text(&png), "--diameter-m", "4.5"];
    refused_with(&picture, &["Mach 0.6"]);
    assert!(!png.exists());
    let experiment = folder.path().join("experiment.toml");
    let toml = |diameter_m: f64| {
        format!(
            "[vehicle]\nrotors = 4\nblades = 2\npropeller_diameter_m = {diameter_m}\n\
             [[load]]\nname = \"bench\"\nthrust_n = 0.1\nrotors_running = 1\nrecordings = [\"hover.wav\"]\n"
        )
    };
    fs::write(&experiment, toml(0.045)).unwrap();
    hovertone(&["identify", text(&experiment)]).ends_with(0);
    fs::write(&experiment, toml(4.5)).unwrap();
    refused_with(
        &["identify", text(&experiment)],
        &["hover.wav", "diameter_m = 4.5", "rev/s", "Mach 0.6", "in metres"],
    );
    let table = folder.path().join("stand.csv");
    fs::write(&table, "rpm,thrust_n\n3000,0.701\n4000,1.249\n5000,1.952\n").unwrap();
    hovertone(&["fit", text(&table), "--diameter-m", "0.254"]).ends_with(0);
    refused_with(&["fit", text(&table), "--diameter-m", "25.4"], &["from 0.01 to 10"]);
    refused_with(&["fit", text(&table), "--diameter-m", "2.54"], &["line 2", "diameter_m = 2.54", "Mach", "in metres"]);
}

#[test]
fn one_weighing_is_of_one_load() {
    let folder = tempfile::tempdir().unwrap();
    let [light, heavy] = [0.413, 0.462].map(|mass_kg| hover(folder.path(), mass_kg));
    let weigh = ["weigh", text(&heavy), text(&light), "--constant-n-s2", "2.83e-5", "--vehicle", "ardrone"];
    refused_with(&weigh, &["are of different loads", "weighs 41", " g in ", "413g.wav and 46", "of each load"]);
}

#[test]
fn rows_have_the_cells_of_the_header() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("stand.csv");
    let fit = |rows: &str| {
        fs::write(&table, format!("rpm,thrust_n\n3000,1.00\n{rows}\n4000,1.80\n5000,2.75\n")).unwrap();
        vec!["fit".to_owned(), text(&table).to_owned()]
    };
    for (row, words) in [
        ("3500", ["line 3: the row has 1 cell, but the header has 2", "complete or remove the row"]),
        ("3500,1.36,7", ["line 3: the row has 3 cells, but the header has 2", "the decimal sign is a comma"]),
        ("3500,1,36", ["line 3: the row has 3 cells", "the decimal sign is a comma"]),
    ] {
        let arguments = fit(row);
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        refused_with(&arguments, &[words[0], words[1], "stand.csv"]);
    }
    let arguments = fit("3500,1.36,");
    hovertone(&arguments.iter().map(String::as_str).collect::<Vec<_>>()).ends_with(0);
}

#[test]
fn rows_whose_scatter_tells_no_uncertainty_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("stand.csv");
    let fit = ["fit", text(&table)];
    for (rows, words) in [
        ("rpm,thrust_n\n3600,1.0\n5000,2.0\n", ["at least 3 usable rows", "has 2"]),
        ("rpm,thrust_n\n3600,1.0\n", ["at least 3 usable rows", "has 1"]),
        // the third row is off by a factor, and left out
        ("rpm,thrust_n\n3600,1.0\n5000,1.95\n4200,13.6\n", ["at least 3 usable rows", "has 2"]),
        ("motor,rpm,thrust_n\nx,3600,1.0\nx,5000,2.0\n", ["group \"x\"", "has 2"]),
    ] {
        fs::write(&table, rows).unwrap();
        refused_with(&fit, &[&words[..], &["measure more rows", "thrust_std_n", "stand.csv"]].concat());
        refused_with(&[&fit[..], &["--json"]].concat(), &words);
    }
    // with stated uncertainties two rows have a ±: u(C)/C² = 1 / Σ (F/u)²
    fs::write(&table, "rpm,thrust_n,thrust_std_n\n3600,1.0,0.01\n5000,1.93,0.01\n").unwrap();
    let stated = &hovertone(&[&fit[..], &["--json"]].concat()).ends_with(0).json_lines()[0];
    let constant = &stated["thrust_constant_total_n_s2"];
    let share = constant["std_uncertainty"].as_f64().unwrap() / constant["value"].as_f64().unwrap();
    assert!((share * 1.0f64.hypot(1.93) / 0.01 - 1.0).abs() < 0.01, "{constant}");
}

#[test]
fn rows_that_were_computed_are_no_measurement() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("stand.csv");
    let rows = |digits: usize, std: &str| -> String {
        [3000.0, 3600.0, 4200.0, 5000.0]
            .map(|rpm| format!("{rpm},{:.digits$}{std}\n", 7e-6 * RotorSpeed::from_rpm(rpm).rad_s().powi(2)))
            .concat()
    };
    for digits in [17, 6, 4] {
        fs::write(&table, format!("rpm,thrust_n\n{}", rows(digits, ""))).unwrap();
        refused_with(
            &["fit", text(&table)],
            &["exactly on F = C ω²", "scatter of measured rows", "thrust_std_n", "stand.csv"],
        );
    }
    // with a stated uncertainty they have one, and nothing is said not to fit
    fs::write(&table, format!("rpm,thrust_n,thrust_std_n\n{}", rows(17, ",0.001"))).unwrap();
    let stated = hovertone(&["fit", text(&table)]).ends_with(0);
    assert!(!stated.stderr.contains("does not fit"), "{}", stated.stderr);
    // rounded to three digits, two rows may agree by chance: that is no reason to blame the third
    fs::write(&table, "rpm,thrust_n\n3000,1\n6000,4.001\n4500,2.25\n").unwrap();
    let rounded = hovertone(&["fit", text(&table)]).ends_with(0);
    assert!(!rounded.stderr.contains("not fit"), "{}", rounded.stderr);
}

#[test]
fn a_weighed_mass_is_that_of_a_vehicle() {
    let folder = tempfile::tempdir().unwrap();
    let wav = hover(folder.path(), 0.413);
    let weigh = |constant: &str, more: &[&str]| {
        let arguments = [&["weigh", text(&wav), "--constant-n-s2", constant], more].concat();
        arguments.into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    let refused = |arguments: Vec<String>, words: &[&str]| {
        refused_with(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), words);
    };
    let ardrone = ["--vehicle", "ardrone"];
    refused(weigh("2.8", &ardrone), &["ten times the 413 g of the vehicle", "of the whole vehicle"]);
    // the constant of one rotor in place of four
    refused(
        weigh("7.07e-6", &ardrone),
        &[
            "payload weighs 10",
            "alone weighs 413 g",
            "--constant-n-s2 needs the constant of the whole vehicle: if",
            "is the constant of one of 4 rotors, give --constant-n-s2 0.00002828;",
        ],
    );
    // without a ± of the constant the mass has none, and says so
    let arguments = weigh("2.83e-5", &ardrone);
    let words = hovertone(&arguments.iter().map(String::as_str).collect::<Vec<_>>()).ends_with(0).stdout;
    assert!(words.contains("mass as flown: 413 g (its ± is not known"), "{words}");
}

#[test]
fn files_of_another_kind_are_named_for_what_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let wav = hover(folder.path(), 0.413);
    let (wav, place) = (text(&wav), text(folder.path()));
    for (arguments, words) in [
        (vec!["fit", wav], ["413g.wav", "not text"]),
        (vec!["export", wav, "--to", "gazebo"], ["413g.wav", "not text"]),
        (vec!["fit", place], ["this is a folder", "the table must be a file"]),
        (vec!["identify", place], ["this is a folder", "an experiment file is needed"]),
        (vec!["identify", "nowhere.toml"], ["nowhere.toml: there is no such file", "folder of the experiment file"]),
        (vec!["fit", "nowhere.csv"], ["nowhere.csv: there is no such file", "folder of the table"]),
    ] {
        let run = hovertone(&arguments).ends_with(1);
        assert!(run.stdout.is_empty() && !run.stderr.contains("os error"), "{}", run.stderr);
        words.iter().for_each(|word| assert!(run.stderr.contains(word), "{word:?}: {}", run.stderr));
    }
}

/// The tables of `identify` have speeds and constants, and a constant is no thrust.
#[test]
fn a_constant_is_no_thrust() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("samples.csv");
    let rows = "speed_rpm,thrust_constant_total_n_s2\n3600,2.8e-5\n3700,2.9e-5\n3800,2.8e-5\n";
    fs::write(&table, rows).unwrap();
    refused_with(&["fit", text(&table)], &["no column holds a thrust", "thrust_constant_total_n_s2"]);
}

#[test]
fn a_thrust_that_no_propeller_has_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let run = |rows: &str, code: i32| {
        let table = folder.path().join("table.csv");
        fs::write(&table, rows).unwrap();
        hovertone(&["fit", text(&table)]).ends_with(code).stderr
    };
    // 5 N at 8000 rpm, and the same in gram-force under the name of newtons
    let words = "no propeller has this thrust at this speed";
    assert!(!run("rpm,thrust_n\n4000,1.26\n6000,2.81\n8000,5.01\n", 0).contains(words));
    let gram_force = run("rpm,thrust_n\n4000,128\n6000,287\n8000,511\n", 3);
    assert!(gram_force.contains(words) && gram_force.contains("check the units"), "{gram_force}");
    let table = folder.path().join("rev_s.csv");
    fs::write(&table, "rpm,thrust_n\n67,1.26\n100,2.81\n133,5.01\n").unwrap();
    let fitted = hovertone(&["fit", text(&table), "--diameter-m", "0.254"]).ends_with(3).stderr;
    assert!(fitted.contains("C_T would be") && fitted.contains("rev/s or rad/s"), "{fitted}");
}
