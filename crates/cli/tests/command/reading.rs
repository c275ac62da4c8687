//! What a person types in place of plain names and seconds: `-`, `1:02.5`, brackets, `~`.

use crate::testkit::{hovertone, hovertone_with, refused_with, steady_hover, text, write_hover};
use hovertone_vehicle::RotorSpeed;
use std::fs::{self, File};
use std::process::Stdio;

fn write_ardrone(path: &std::path::Path, duration_s: f64) {
    write_hover(path, steady_hover("ardrone", RotorSpeed::from_rpm(3600.0), duration_s));
}

#[test]
fn a_recording_and_a_table_come_from_stdin() {
    let folder = tempfile::tempdir().unwrap();
    let (sound, table) = (folder.path().join("hover.wav"), folder.path().join("stand.csv"));
    write_ardrone(&sound, 2.0);
    fs::write(&table, "rpm,thrust_n\n3000,0.70\n3600,1.00\n4200,1.38\n5000,1.94\n").unwrap();
    let kept = folder.path().join("tmp");
    fs::create_dir(&kept).unwrap();
    let piped = |words: &[&str], input: &std::path::Path| {
        let input = Stdio::from(File::open(input).unwrap());
        hovertone_with(words, |command| command.stdin(input).env("TMPDIR", &kept))
    };
    let named = hovertone(&["speed", "--vehicle", "ardrone", "--json", text(&sound)]).ends_with(0).json_lines();
    let heard = piped(&["speed", "--vehicle", "ardrone", "--json", "-"], &sound).ends_with(0).json_lines();
    assert_eq!(heard[0]["file"], "stdin");
    for field in ["speed_rpm", "recording", "std_uncertainty_rev_s"] {
        assert_eq!(heard[0][field], named[0][field], "{field}");
    }
    piped(&["tones", "--vehicle", "ardrone", "-"], &sound).ends_with(0);
    let picture = folder.path().join("x.png");
    piped(&["spectrogram", "--vehicle", "ardrone", "-", "-o", text(&picture)], &sound).ends_with(0);
    assert!(picture.exists());
    let fitted = piped(&["fit", "--json", "-"], &table).ends_with(0).stdout;
    let json: serde_json::Value = serde_json::from_str(&fitted).unwrap();
    assert!(json["thrust_constant_per_rotor_n_s2"]["value"].as_f64().is_some(), "{fitted}");
    assert_eq!(json["file"], "stdin");
    assert_eq!(fs::read_dir(&kept).unwrap().count(), 0, "nothing is left of stdin");
    let twice = piped(&["speed", "--vehicle", "ardrone", "-", "-"], &sound).ends_with(2);
    assert!(twice.stderr.contains("given twice"), "{}", twice.stderr);
}

#[test]
fn times_are_minutes_and_seconds_too() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    write_ardrone(&sound, 4.0);
    let heard = |from: &str, to: &str| {
        let words = ["speed", "--vehicle", "ardrone", "--json", "--from", from, "--to", to, text(&sound)];
        let line = hovertone(&words).ends_with(0).json_lines().remove(0);
        (line["from_s"].clone(), line["to_s"].clone(), line["speed_rpm"].clone())
    };
    assert_eq!(heard("0:00.5", "0:03"), heard("0.5", "3"));
    refused_with(&["speed", text(&sound), "--vehicle", "ardrone", "--from", "-0:01"], &["--from = -1"]);
    let run = hovertone(&["tones", text(&sound), "--from", "1:75"]).ends_with(2);
    assert!(run.stderr.contains("1:02.5"), "{}", run.stderr);
    let experiment = folder.path().join("experiment.toml");
    let write = |from: &str| {
        let load = format!("[[load]]\nname = \"a\"\nrecordings = [\"hover.wav\"]\nfrom_s = {from}\nto_s = 3\n");
        fs::write(&experiment, format!("[vehicle]\npreset = \"ardrone\"\nmass_kg = 0.413\n{load}")).unwrap();
    };
    write("\"0:00.5\"");
    let results: serde_json::Value =
        serde_json::from_str(&hovertone(&["identify", "--json", text(&experiment)]).ends_with(0).stdout).unwrap();
    assert_eq!(results["settings"]["experiment"]["loads"][0]["span"]["from_s"], 0.5);
    write("\"half\"");
    refused_with(&["identify", text(&experiment)], &["\"half\" is no time", "1:02.5", "from_s"]);
}

#[test]
fn brackets_and_a_tilde_stand_for_themselves_and_for_the_home_folder() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("flights [2026]");
    fs::create_dir(&folder).unwrap();
    write_ardrone(&folder.join("a.wav"), 1.0);
    let run = |word: &str| {
        hovertone_with(&["speed", "--vehicle", "ardrone", "--json", word], |command| command.env("HOME", home.path()))
    };
    for word in [text(&folder.join("*.wav")), "~/flights [2026]/*.wav", "~/flights*/a.wav"] {
        let lines = run(word).ends_with(0).json_lines();
        assert_eq!(lines.len(), 1, "{word}");
        assert!(lines[0]["file"].as_str().unwrap().ends_with("flights [2026]/a.wav"), "{}", lines[0]["file"]);
    }
}
