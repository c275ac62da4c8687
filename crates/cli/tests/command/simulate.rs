//! `hovertone simulate`: what it writes, and what it refuses.

use crate::testkit::{hovertone, repository, text};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

const STILL_HOVER: &str = "duration_s = 2.0\nseed = 5\n[flight]\ngravity_m_s2 = 9.8\n[sound]\nsample_rate_hz = 44100\n\
    [[microphone]]\nposition_m = [1.0, 0.0, 1.0]\n[[microphone]]\nposition_m = [0.0, -2.0, 1.5]\n";

fn scenario(folder: &Path, text: &str) -> PathBuf {
    let path = folder.join("scenario.toml");
    fs::write(&path, text).unwrap();
    path
}

fn truth_in(folder: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join("truth.json")).unwrap()).unwrap()
}

#[test]
fn sound_table_and_truth_agree_and_a_seed_repeats() {
    let folder = tempfile::tempdir().unwrap();
    let file = scenario(folder.path(), STILL_HOVER);
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    let run = hovertone(&["simulate", text(&file), "-o", text(&first)]).ends_with(0);
    for words in ["ardrone, 413.0 g", "2 microphones", "seed 5", "2.8310e-5"] {
        assert!(run.stdout.contains(words), "{words}:\n{}", run.stdout);
    }
    let wav = hound::WavReader::open(first.join("sound.wav")).unwrap();
    assert_eq!((wav.spec().channels, wav.spec().sample_rate, wav.spec().bits_per_sample), (2, 44_100, 16));
    assert_eq!(wav.duration(), 88_200);
    let mut table = csv::Reader::from_path(first.join("truth.csv")).unwrap();
    let head = table.headers().unwrap().clone();
    let column = |name: &str| head.iter().position(|known| known == name).unwrap();
    let (time, speed, height) = (column("time_s"), column("speed_3_rad_s"), column("z_m"));
    let expected = (0.413 * 9.8 / (4.0 * 7.0775e-6_f64)).sqrt();
    let mut rows = 0;
    for row in table.records() {
        let row = row.unwrap();
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        assert!((number(time) - 0.01 * f64::from(rows)).abs() < 1e-9);
        assert!((number(speed) / expected - 1.0).abs() < 1e-9 && (number(height) - 1.0).abs() < 1e-9);
        rows += 1;
    }
    assert_eq!(rows, 201);
    let truth = truth_in(&first);
    assert_eq!((&truth["seed"], &truth["version"]), (&Value::from(5), &Value::from(env!("CARGO_PKG_VERSION"))));
    let hover = &truth["hover"];
    assert!((hover["mean_sum_of_squares_rad2_s2"].as_f64().unwrap() / (4.0 * expected * expected) - 1.0).abs() < 1e-9);
    assert!((hover["thrust_constant_total_n_s2"].as_f64().unwrap() / 2.831e-5 - 1.0).abs() < 1e-9);
    assert_eq!(truth["settings"]["scenario"]["sound"]["sample_rate_hz"], 44_100);
    // over an earlier simulation; and another seed is another sound
    hovertone(&["simulate", text(&file), "-o", text(&second), "--seed", "6"]).ends_with(0);
    assert_ne!(fs::read(first.join("sound.wav")).unwrap(), fs::read(second.join("sound.wav")).unwrap());
    let again = hovertone(&["simulate", text(&file), "-o", text(&second)]).ends_with(0);
    assert_eq!(again.stdout, run.stdout);
    for name in ["sound.wav", "truth.csv", "truth.json"] {
        assert_eq!(fs::read(first.join(name)).unwrap(), fs::read(second.join(name)).unwrap(), "{name}");
    }
}

#[test]
fn samples_are_stored_as_the_scenario_says() {
    let folder = tempfile::tempdir().unwrap();
    for (format, bits, stored) in [("int24", 24, hound::SampleFormat::Int), ("float32", 32, hound::SampleFormat::Float)]
    {
        let file = scenario(folder.path(), &format!("duration_s = 0.2\n[sound]\nsample_format = \"{format}\"\n"));
        let out = folder.path().join(format);
        hovertone(&["simulate", text(&file), "-o", text(&out)]).ends_with(0);
        let spec = hound::WavReader::open(out.join("sound.wav")).unwrap().spec();
        assert_eq!((spec.bits_per_sample, spec.sample_format), (bits, stored));
    }
}

#[test]
fn commands_come_from_a_table_beside_the_scenario() {
    let folder = tempfile::tempdir().unwrap();
    let text_of = "[[maneuver]]\nkind = \"csv\"\nfile = \"thumbs.csv\"\nduration_s = 0.4\n";
    let file = scenario(folder.path(), text_of);
    let out = folder.path().join("out");
    let missing = hovertone(&["simulate", text(&file), "-o", text(&out)]).ends_with(1);
    assert!(missing.stderr.contains("thumbs.csv"), "{}", missing.stderr);
    fs::write(folder.path().join("thumbs.csv"), "time_s,roll\n0.0,0.1\n0.2,2\n").unwrap();
    let wrong = hovertone(&["simulate", text(&file), "-o", text(&out)]).ends_with(2);
    assert!(wrong.stderr.contains("thumbs.csv, line 3") && !out.exists(), "{}", wrong.stderr);
    fs::write(folder.path().join("thumbs.csv"), "time_s,roll\n0.0,0.1\n0.2,-0.1\n").unwrap();
    hovertone(&["simulate", text(&file), "-o", text(&out)]).ends_with(0);
    let table = fs::read_to_string(out.join("truth.csv")).unwrap();
    let rolls: Vec<&str> = table.lines().skip(2).map(|line| line.split(',').nth(1).unwrap()).collect();
    assert!(rolls.len() == 40 && rolls[..20].iter().all(|roll| *roll == "0.1"), "{rolls:?}");
    assert!(rolls[20..].iter().all(|roll| *roll == "-0.1"), "{rolls:?}");
}

#[test]
fn faults_are_named_with_the_nearest_name() {
    let folder = tempfile::tempdir().unwrap();
    for (text_of, words) in [
        ("[vehicle]\nmas_kg = 0.4\n", ["unknown key \"mas_kg\"", "mass_kg"]),
        ("[[maneuver]]\nkind = \"hoover\"\nduration_s = 1\n", ["unknown value \"hoover\"", "did you mean \"hover\""]),
        ("[vehicle]\npreset = \"crazyfly\"\n", ["crazyfly", "did you mean \"crazyflie\""]),
        ("[vehicle]\npreset = \"bebop2\"\n", ["bebop2", "has no flight model of the vehicle"]),
        (
            "[vehicle]\nmass_kg = 9.0\n",
            ["mass_kg = 9: the vehicle is too heavy to hover", "give a smaller mass (in kilograms)"],
        ),
        ("[vehicle]\nmass_kg = 413.0\n", ["mass_kg = 413: ", "for 413 g write 0.413"]),
        ("[gusts]\nwind_at_6_m_m_s = 1.0\nlength_m = [1, 1, 1]\n", ["wind_at_6_m_m_s", "hint"]),
        ("truth_rate_hz = 333.0\n", ["truth_rate_hz", "500"]),
    ] {
        let out = folder.path().join("out");
        let file = scenario(folder.path(), text_of);
        let run = hovertone(&["simulate", text(&file), "-o", text(&out)]).ends_with(2);
        let stderr = &run.stderr;
        for word in words {
            assert!(stderr.contains(word), "{text_of}: no {word:?} in\n{stderr}");
        }
        assert!(run.stdout.is_empty() && !out.exists());
    }
}

/// Files of other kinds are often given in place of the scenario.
#[test]
fn a_model_and_a_table_are_no_scenario() {
    let folder = tempfile::tempdir().unwrap();
    for (name, content, words) in [
        (
            "model.sdf",
            "<?xml version=\"1.0\"?>\n<sdf version=\"1.9\"></sdf>\n",
            "a simulator's model (SDF), so it cannot be the scenario",
        ),
        ("page.html", "<p>hover</p>\n", "XML, so it cannot be the scenario file"),
        ("log.csv", "# a log\ntime_s,roll\n0.0,0.1\n", "a table (CSV), so it cannot be the scenario file"),
    ] {
        let file = folder.path().join(name);
        fs::write(&file, content).unwrap();
        let run = hovertone(&["simulate", text(&file), "-o", text(&folder.path().join("out"))]).ends_with(1);
        assert!(run.stderr.contains(words) && run.stderr.contains("give the TOML file"), "{}", run.stderr);
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    }
}

#[test]
fn a_flight_through_the_wall_ends_with_its_time() {
    let folder = tempfile::tempdir().unwrap();
    let away = "[room]\n[sound]\nsample_rate_hz = 8000\n[[maneuver]]\nkind = \"fly_to\"\nposition_m = [9.0, 0.0, 1.0]\nduration_s = 5.0\n";
    let file = scenario(folder.path(), away);
    let run = hovertone(&["simulate", text(&file), "-o", text(&folder.path().join("out"))]).ends_with(1);
    assert!(
        run.stderr.contains("the simulated flight stopped after") && run.stderr.contains("position_m"),
        "{}",
        run.stderr
    );
}

#[test]
fn a_folder_of_something_else_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let file = scenario(folder.path(), STILL_HOVER);
    let run = hovertone(&["simulate", text(&file), "-o", text(folder.path())]).ends_with(2);
    // the folder of the scenario is no place for its results
    assert!(run.stderr.contains("this folder holds the input") && run.stderr.contains("-o results"), "{}", run.stderr);
    fs::write(folder.path().join("truth.json"), "{}").unwrap();
    hovertone(&["simulate", text(&file), "-o", text(folder.path())]).ends_with(2);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn the_examples_fly() {
    let folder = tempfile::tempdir().unwrap();
    let mut flown = 0;
    for name in ["ardrone-hover", "ardrone-doublets", "crazyflie-square"] {
        let file = repository().join("examples").join(name).with_extension("toml");
        let out = folder.path().join(name);
        hovertone(&["simulate", text(&file), "-o", text(&out)]).ends_with(0);
        let truth = truth_in(&out);
        assert!(truth["hover"]["duration_s"].as_f64().unwrap() >= 3.0, "{name}");
        flown += 1;
    }
    assert_eq!(flown, 3);
}
