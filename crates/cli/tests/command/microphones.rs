//! Which rotor is which: `hovertone speed --microphones`.

use crate::testkit::{hovertone, refused_with, text};
use serde_json::Value;
use std::fs;

/// Speeds 1 % apart, in any order; microphones stand about the place over which it hovers, at a height of 1 m.
const FLIGHT: &str = "duration_s = 6.0\nseed = 4\ntruth_rate_hz = 20.0\n\
    [spread]\nthrust_shares = [0.97, 1.01, 1.03, 0.99]\n[motor_wander]\n\
    [sound]\nsample_rate_hz = 44100\ntone_level_db_spl = 70.0\n\
    [[microphone]]\nposition_m = [0.9, 0.35, 0.9]\n[[microphone]]\nposition_m = [-0.7, 0.7, 1.1]\n\
    [[microphone]]\nposition_m = [-0.3, -1.0, 0.8]\n";
const STANDS: &str = "[[microphone]]\nposition_m = [0.9, 0.35, -0.1]\n[[microphone]]\nposition_m = [-0.7, 0.7, 0.1]\n\
    [[microphone]]\nposition_m = [-0.3, -1.0, -0.2]\n";

fn names(line: &Value) -> Vec<&str> {
    line["rotors"].as_array().unwrap().iter().map(|rotor| rotor["label"]["name"].as_str().unwrap_or("-")).collect()
}

#[test]
fn rotors_are_named_by_the_channels_of_a_recording() {
    let folder = tempfile::tempdir().unwrap();
    let (scenario, output) = (folder.path().join("scenario.toml"), folder.path().join("flown"));
    fs::write(&scenario, FLIGHT).unwrap();
    hovertone(&["simulate", text(&scenario), "-o", text(&output)]).ends_with(0);
    let sound = output.join("sound.wav");
    let mut table = csv::Reader::from_path(output.join("truth.csv")).unwrap();
    let head = table.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let mean = |rotor: usize| -> f64 {
        let column = head.iter().position(|known| known == format!("speed_{}_rad_s", rotor + 1)).unwrap();
        rows.iter().map(|row| row[column].parse::<f64>().unwrap()).sum()
    };
    let mut rotors = [0, 1, 2, 3];
    rotors.sort_by(|&a, &b| mean(b).total_cmp(&mean(a)));
    assert_ne!(rotors, [0, 1, 2, 3]);
    let file = folder.path().join("stands.toml");
    let run = |content: &str, code: i32| {
        fs::write(&file, content).unwrap();
        let speed = ["speed", "--vehicle", "ardrone", "--json", "--microphones", text(&file), text(&sound)];
        hovertone(&speed).ends_with(code).json_lines().remove(0)
    };
    let line = run(STANDS, 0);
    assert_eq!(names(&line), rotors.map(|rotor| ["front left", "rear left", "rear right", "front right"][rotor]));
    assert_eq!(line["labels"]["source"], "microphones");
    assert!(line["labels"]["probability"].as_f64().unwrap() > 0.99 && line["labels"]["offset_s"].is_null());
    // rotors by their own names and places; microphones said to stand in line with the vehicle
    let named = "position_std_m = 0.1\n[[microphone]]\nposition_m = [1.0, 0.0, 0.0]\n[[microphone]]\nposition_m = [-1.0, 0.0, 0.0]\n\
        [[microphone]]\nposition_m = [-2.0, 0.0, 0.0]\n[[rotor]]\nname = \"a\"\nposition_m = [0.1, 0.1, 0]\n[[rotor]]\nname = \"b\"\n\
        position_m = [-0.1, 0.1, 0]\n[[rotor]]\nname = \"c\"\nposition_m = [-0.1, -0.1, 0]\n[[rotor]]\nname = \"d\"\nposition_m = [0.1, -0.1, 0]\n";
    let line = run(named, 3);
    assert_eq!(names(&line), ["-"; 4]);
    assert!(line["warnings"].to_string().contains("no rotor could be named"), "{}", line["warnings"]);
    // one channel for each microphone
    fs::write(&file, &STANDS[..STANDS.rfind("[[").unwrap()]).unwrap();
    let refused =
        hovertone(&["speed", "--vehicle", "ardrone", "--microphones", text(&file), text(&sound)]).ends_with(2);
    for words in ["the recording has 3 channels", "microphones with a position is 2", "hint:", "sound.wav"] {
        assert!(refused.stderr.contains(words) && refused.stdout.is_empty(), "{words}:\n{}", refused.stderr);
    }
}

#[test]
fn a_file_that_cannot_be_used_is_refused_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("stands.toml");
    let refused = |content: &str, more: &[&str], words: &[&str]| {
        fs::write(&file, content).unwrap();
        refused_with(&[&["speed", "a.wav", "--microphones", text(&file)], more].concat(), words);
    };
    let vehicle = ["--vehicle", "ardrone"];
    refused(STANDS, &["--blades", "2"], &["needs the number of rotors", "--rotors 4"]);
    refused(STANDS, &["--blades", "2", "--rotors", "4"], &["places of the rotors", "[[rotor]]"]);
    refused(
        "[[microphone]]\nposition_m = [1.0, 0.0, 0.0]\n",
        &vehicle,
        &["the number of microphones is 1", "[[microphone]]"],
    );
    refused("position_std = 0.1\n", &vehicle, &["unknown key \"position_std\"", "position_std_m"]);
    refused(&format!("position_std_m = 0.0\n{STANDS}"), &vehicle, &["position_std_m", "0.001"]);
    refused("[[microphone]]\nposition_m = [1.0, 2.0]\n", &vehicle, &["stands.toml:2"]);
    refused(&format!("{STANDS}[[microphone]]\nposition_m = [nan, 0, 0]\n"), &vehicle, &["microphone 4", "metres"]);
    refused(
        STANDS,
        &["--vehicle", "ardrone", "--rotors", "3"],
        &["3 rotors turn, but the number of rotors with a position is 4"],
    );
    let both = hovertone(&["speed", "a.wav", "--microphones", "b.toml", "--log", "c.csv"]).ends_with(2);
    assert!(both.stderr.contains("cannot be used with"), "{}", both.stderr);
    let missing = hovertone(&["speed", "a.wav", "--vehicle", "ardrone", "--microphones", "missing.toml"]).ends_with(1);
    assert!(missing.stderr.contains("missing.toml"), "{}", missing.stderr);
}
