//! Wrong use ends with 2 and says what to do.

use crate::testkit::{hovertone, hovertone_with, text};

fn refuses(arguments: &[&str], words: &[&str]) {
    let run = hovertone(arguments).ends_with(2);
    assert!(run.stdout.is_empty(), "{arguments:?} printed data: {}", run.stdout);
    for word in words {
        assert!(run.stderr.contains(word), "{arguments:?} does not say {word:?}:\n{}", run.stderr);
    }
    assert!(!run.stderr.contains('\x1b'), "colours without a terminal");
}

const COMMANDS: [&str; 23] = [
    "batch",
    "batch-compare",
    "listen",
    "init",
    "calibrate",
    "completions",
    "man",
    "speed",
    "tones",
    "spectrogram",
    "identify",
    "fit",
    "weigh",
    "export",
    "compare",
    "demo",
    "log",
    "motor",
    "verify",
    "greybox",
    "simulate",
    "vehicles",
    "serve",
];

#[test]
fn what_is_known_of_the_vehicle_must_be_possible() {
    refuses(&["tones", "a.wav", "--diameter-m", "25"], &["diameter_m = 25", "hint:"]);
    refuses(&["tones", "a.wav", "--mass-kg", "-1"], &["mass_kg = -1"]);
    refuses(&["speed", "a.wav", "--rotors", "0"], &["rotors = 0"]);
    refuses(&["tones", "a.wav", "--vehicle", "crazyfly"], &["did you mean \"crazyflie\""]);
    refuses(&["tones", "a.wav", "--from", "5", "--to", "3"], &["5 s", "3 s", "hovertone tones --help"]);
}

#[test]
fn settings_without_meaning_are_refused_by_name() {
    refuses(&["speed", "a.wav", "--blades", "2", "--band", "200:100"], &["200:100"]);
    refuses(&["speed", "a.wav", "--blades", "2", "--band", "200"], &["LOW:HIGH"]);
    refuses(&["speed", "a.wav", "--blades", "0"], &["--blades"]);
    refuses(&["speed", "a.wav", "--order", "-1"], &["order"]);
    refuses(&["speed", "a.wav", "--order", "NaN"], &["order"]);
    refuses(&["speed", "a.wav", "--gear", "8-69"], &["8:69"]);
    refuses(&["speed", "a.wav", "--blades", "2", "--harmonics", "99"], &["harmonics", "99", "20"]);
    refuses(&["speed", "a.wav", "--blades", "2", "--from", "5", "--to", "3"], &["5 s", "3 s"]);
    refuses(&["speed", "a.wav", "--blades", "2", "--channel", "0"], &["counted from 1"]);
    refuses(&["speed", "a.wav", "--blades", "2", "--method", "guess"], &["maximum_trace", "gaussian"]);
}

#[test]
fn serve_needs_an_address_of_numbers_and_a_build_with_the_page() {
    refuses(&["serve", "--address", "localhost.example"], &["0.0.0.0"]);
    refuses(&["serve", "--port", "70000"], &["--port"]);
    #[cfg(not(feature = "page"))]
    {
        let run = hovertone(&["serve"]).ends_with(1);
        assert!(run.stdout.is_empty() && run.stderr.contains("cargo xtask page"), "{}", run.stderr);
    }
}

#[test]
fn a_vehicle_that_does_not_exist_has_a_nearest_name() {
    refuses(&["speed", "a.wav", "--vehicle", "crazyfly"], &["crazyfly", "did you mean \"crazyflie\""]);
}

#[test]
fn an_unknown_key_is_underlined_and_has_a_nearest_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("experiment.toml");
    let write = |text: &str| std::fs::write(&path, text).unwrap();
    write("[vehicle]\npreset = \"ardrone\"\nmas_kg = 0.4\n");
    refuses(
        &["identify", text(&path)],
        &["mas_kg", "did you mean \"mass_kg\"", "3 | mas_kg = 0.4", "^^^^^^", "experiment.toml:3:1"],
    );
    write("[vehicle]\npreset = \"ardrne\"\n[[load]]\nname = \"a\"\nrecordings = [\"a.wav\"]\n");
    refuses(&["identify", text(&path)], &["ardrne", "did you mean \"ardrone\"", "experiment.toml"]);
    write("[vehicle]\npreset = \"ardrone\"\n[[lode]]\nname = \"a\"\n");
    refuses(&["identify", text(&path)], &["did you mean \"load\""]);
    write("[vehicle]\npreset = \"ardrone\"\nmass_kg = \"heavy\"\n");
    refuses(&["identify", text(&path)], &["has \"heavy\" where a number is needed", "3 | mass_kg"]);
    let load = "[[load]]\nname = \"a\"\nrecordings = [\"a.wav\"]\n";
    write(&format!("[vehicle]\npreset = \"ardrone\"\n{load}{load}"));
    refuses(&["identify", text(&path)], &["load number 2", "\"a\""]);
}

#[test]
fn forces_and_places_must_be_possible() {
    refuses(&["fit"], &["fit needs at least one table of speeds and thrusts"]);
    refuses(&["fit", "--plan"], &["--mass-kg"]);
    refuses(&["fit", "--plan", "--mass-kg", "-1"], &["mass_kg = -1", "above 0"]);
    refuses(&["fit", "--plan", "--mass-kg", "NaN"], &["mass_kg = NaN"]);
    refuses(&["fit", "a.csv", "--latitude-deg", "100"], &["latitude_deg = 100", "-90 to 90"]);
    refuses(&["fit", "a.csv", "--gravity-m-s2", "1.6"], &["Earth"]);
    refuses(&["fit", "a.csv", "--temperature-c", "293", "--diameter-m", "0.2"], &["temperature_c = 293"]);
    refuses(&["fit", "a.csv", "--diameter-m", "25"], &["diameter_m = 25"]);
    refuses(&["export", "a.json"], &["--to"]);
    refuses(&["export", "a.json", "--to", "unreal"], &["gazebo", "rotorpy"]);
    refuses(&["weigh", "a.wav"], &["--constant"]);
    refuses(&["weigh", "a.wav", "--constant-n-s2", "0", "--blades", "2"], &["constant_n_s2 = 0", "above 0"]);
    refuses(
        &["weigh", "a.wav", "--constant-n-s2", "2.8e-5"],
        &["how many times the tone sounds per turn", "--vehicle"],
    );
}

#[test]
fn help_and_version_are_data() {
    let version = hovertone(&["--version"]).ends_with(0);
    assert_eq!(version.stdout.trim_end(), format!("hovertone {}", env!("CARGO_PKG_VERSION")));
    let help = hovertone(&["--help"]).ends_with(0).stdout;
    for command in COMMANDS.iter().chain(&["Exit codes"]) {
        assert!(help.contains(command), "{command}");
    }
    for command in COMMANDS {
        let run = hovertone_with(&[command, "--help"], |command| command.env("COLUMNS", "100"));
        let help = run.ends_with(0).stdout;
        assert!(help.lines().all(|line| line.chars().count() <= 100), "{help}");
        // a sentence of a paragraph goes on in the next line only where it reached the width
        let lines: Vec<&str> = help.lines().collect();
        for pair in lines.windows(2) {
            let goes_on = pair[1].starts_with(|first: char| first.is_ascii_lowercase());
            let is_text = !pair[0].is_empty() && !pair[0].starts_with(' ');
            let next_word = pair[1].split(' ').next().unwrap_or_default();
            let has_room = pair[0].chars().count() + 1 + next_word.chars().count() <= 100;
            assert!(!(goes_on && is_text && has_room), "{command}: {pair:#?}");
        }
    }
}

#[test]
fn vehicles_are_listed_with_their_sources() {
    let table = hovertone(&["vehicles"]).ends_with(0).stdout;
    for words in ["ardrone", "8:69", "derived, not found in print", "crazyflie", "413 g"] {
        assert!(table.contains(words), "{words}");
    }
    let json: serde_json::Value =
        serde_json::from_str(&hovertone(&["vehicles", "--json"]).ends_with(0).stdout).unwrap();
    assert!(json.as_array().unwrap().iter().any(|vehicle| vehicle["id"] == "ardrone"));
}

#[test]
fn one_vehicle_is_shown_by_its_name() {
    let shown = hovertone(&["vehicles", "mambo", "ardrone"]).ends_with(0).stdout;
    assert!(shown.starts_with("mambo ") && shown.contains("\nardrone ") && !shown.contains("crazyflie"), "{shown}");
    let json: serde_json::Value =
        serde_json::from_str(&hovertone(&["vehicles", "mambo", "--json"]).ends_with(0).stdout).unwrap();
    assert!(json.as_array().unwrap().len() == 1 && json[0]["id"] == "mambo", "{json}");
    for (name, words) in [
        ("mamba", ["there is no vehicle \"mamba\"", "did you mean \"mambo\"?"]),
        ("mine.toml", ["mine.toml: this is a file", "write --add mine.toml"]),
    ] {
        let run = hovertone(&["vehicles", name]).ends_with(2);
        words.iter().for_each(|words| assert!(run.stderr.contains(words), "{}", run.stderr));
    }
}
