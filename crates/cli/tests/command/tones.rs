//! `hovertone tones`, and `speed` where nobody names the tone: on sound with a known speed, and on real recordings.

use crate::testkit::{files_in, hovertone, recordings, steady_hover, text, write_hover, write_noise, write_sine};
use hovertone_vehicle::RotorSpeed;
use serde_json::Value;
use std::path::{Path, PathBuf};

fn hover(folder: &Path, preset: &str, rev_s: f64) -> PathBuf {
    let path = folder.join(format!("{preset}.wav"));
    write_hover(&path, steady_hover(preset, RotorSpeed::from_rev_s(rev_s), 4.0));
    path
}

fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap_or_else(|| panic!("{name} is no number in {value}"))
}

/// The speed of every reading that is given: the settled one, or all alternatives.
fn speeds(line: &Value) -> Vec<f64> {
    match line["status"].as_str() {
        Some("ok") => vec![number(line, "speed_rev_s")],
        Some("ambiguous") => {
            line["alternatives"].as_array().unwrap().iter().map(|reading| number(reading, "speed_rev_s")).collect()
        }
        _ => Vec::new(),
    }
}

#[test]
fn a_geared_rotor_is_found_by_its_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let path = hover(folder.path(), "ardrone", 57.3);
    let run = hovertone(&["speed", "--json", text(&path)]).ends_with(0);
    let line = &run.json_lines()[0];
    assert_eq!((&line["status"], number(line, "order")), (&Value::from("ok"), 69.0));
    assert!((number(line, "speed_rev_s") - 57.3).abs() < 0.01, "{}", line["speed_rev_s"]);
    assert_eq!(line["found"]["meaning"], "blade_pass_and_mesh");
    assert!(
        run.stderr.contains("the number of blades is not given; hovertone uses 2 blades, gear 8:69"),
        "{}",
        run.stderr
    );
    let tones = hovertone(&["tones", text(&path)]).ends_with(0).stdout;
    assert!(tones.contains("2 blades, gear 8:69") && tones.contains("motor"), "{tones}");
}

#[test]
fn an_open_reading_is_ambiguous_shows_all_and_ends_with_3() {
    let folder = tempfile::tempdir().unwrap();
    let path = hover(folder.path(), "crazyflie", 300.0);
    let run = hovertone(&["speed", "--json", text(&path)]);
    let line = &run.json_lines()[0];
    assert!(speeds(line).iter().any(|speed| (speed - 300.0).abs() < 1.0), "{line}");
    assert_eq!(run.code, if line["status"] == "ok" { 0 } else { 3 });
    if line["status"] == "ambiguous" {
        for name in ["speed_rev_s", "speed_rpm", "speed_rad_s", "std_uncertainty_rev_s", "order"] {
            assert!(line[name].is_null(), "{name}");
        }
        assert!((number(line, "tone_hz") - 600.0).abs() < 2.0);
        for reading in line["alternatives"].as_array().unwrap() {
            let (speed, order) = (number(reading, "speed_rev_s"), number(reading, "order"));
            assert!((speed * order / number(reading, "tone_hz") - 1.0).abs() < 1e-9);
            assert!((number(reading, "speed_rpm") / speed - 60.0).abs() < 1e-6);
            assert!(
                number(reading, "plausibility") > 0.0 && reading["why"].as_str().is_some_and(|why| !why.is_empty())
            );
        }
        let table = hovertone(&["speed", text(&path)]).ends_with(3);
        assert!(table.stdout.contains("  2 blades") && table.stderr.contains("ambiguous:"), "{}", table.stdout);
    }
    // what is known of the vehicle settles it
    let known = hovertone(&["tones", "--json", "--vehicle", "crazyflie", text(&path)]).ends_with(0);
    let line = &known.json_lines()[0];
    assert!((number(line, "speed_rev_s") - 300.0).abs() < 1.0, "{}", line["speed_rev_s"]);
    let rotor = line["families"].as_array().unwrap().iter().find(|family| family["is_rotor"] == true).unwrap();
    let ruled_out =
        rotor["readings"].as_array().unwrap().iter().filter(|reading| number(reading, "plausibility") == 0.0);
    assert!(ruled_out.count() >= 3, "{rotor}");
}

/// Beside the sine of amplitude 0.4 is no noise, and noise 20 and 3 dB below it, with which the Cramér-Rao bound is below a thousandth of a hertz.
#[test]
fn a_sine_is_one_family_with_its_frequency_to_a_hundredth() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sine.wav");
    for (rate_hz, hz) in [(8000, 437.31), (44100, 437.31), (44100, 61.3), (48000, 1000.0), (48000, 2718.28)] {
        for noise_std in [0.0, 0.03, 0.2] {
            write_sine(&path, rate_hz, hz, noise_std);
            let run = hovertone(&["tones", "--json", text(&path)]);
            let line = &run.json_lines()[0];
            let families = line["families"].as_array().unwrap();
            assert_eq!(families.len(), 1, "{hz} Hz, noise {noise_std}: {line}");
            let found_hz = number(&families[0], "fundamental_hz");
            assert!((found_hz - hz).abs() < 0.01, "{hz} Hz, noise {noise_std}: {found_hz}");
            assert_eq!(families[0]["remark"], "single_line", "{hz} Hz, noise {noise_std}");
            if line["status"] == "ambiguous" {
                assert!((number(line, "tone_hz") - hz).abs() < 0.01, "{hz} Hz, noise {noise_std}: {}", line["tone_hz"]);
            }
        }
    }
    write_sine(&path, 44100, 437.31, 0.0);
    let words = hovertone(&["tones", text(&path)]).stdout;
    assert!(
        words.contains("single line: 437.31 Hz")
            && words.contains("as the tone of a rotor: it turns at 218.7 rev/s (2 blades)"),
        "{words}"
    );
}

#[test]
fn a_part_after_the_end_is_not_blamed_on_the_rotor() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("noise.wav");
    write_noise(&path, 3.0);
    let run = hovertone(&["tones", text(&path), "--from", "9"]).ends_with(3);
    assert!(run.stdout.contains("the chosen part lies after the end of the recording"), "{}", run.stdout);
    assert!(
        !run.stdout.contains("no rotor tone") && run.stderr.contains("the recording ends at 3.0 s"),
        "{}",
        run.stderr
    );
    let out = folder.path().join("out");
    let run = hovertone(&["batch", text(&path), "--from", "9", "-o", text(&out)]).ends_with(3);
    assert!(run.stdout.contains("0 with a speed, 1 without a speed, 0 failed"), "{}", run.stdout);
    let picture = folder.path().join("x.png");
    let run =
        hovertone(&["spectrogram", text(&path), "--blades", "2", "--from", "9", "-o", text(&picture)]).ends_with(3);
    assert!(run.stderr.contains("because the chosen part lies after the end"), "{}", run.stderr);
}

#[test]
fn noise_has_no_rotor_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("noise.wav");
    write_noise(&path, 3.0);
    for command in ["speed", "tones"] {
        let run = hovertone(&[command, text(&path)]).ends_with(3);
        assert!(run.stdout.contains("no rotor tone") && run.stderr.contains("no rotor tone:"), "{}", run.stdout);
        let line = &hovertone(&[command, "--json", text(&path)]).ends_with(3).json_lines()[0];
        assert_eq!((&line["status"], &line["speed_rev_s"]), (&Value::from("no_rotor_tone"), &Value::Null));
        assert!(line["reason"].as_str().is_some_and(|reason| !reason.is_empty()));
    }
}

#[test]
fn a_file_that_cannot_be_heard_ends_with_1() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing.wav");
    let run = hovertone(&["tones", text(&missing)]).ends_with(1);
    assert!(run.stderr.contains("error:") && run.stdout.contains("could not be read"), "{}{}", run.stdout, run.stderr);
    assert_eq!(hovertone(&["tones", "--json", text(&missing)]).ends_with(1).json_lines()[0]["status"], "error");
}

#[test]
fn bench_recordings_are_never_read_wrong() {
    let Some(folder) = recordings("crazyflie-propeller") else { return };
    let known_rev_s = [325.6, 347.3, 360.1, 376.6, 388.3, 405.2, 405.1];
    let files = files_in(&folder, ".wav");
    let files: Vec<&str> = files.iter().map(|file| text(file)).collect();
    let lines = hovertone(&[&["speed", "--json"], &files[..]].concat()).json_lines();
    assert_eq!(lines.len(), known_rev_s.len());
    for (line, known) in lines.iter().zip(known_rev_s) {
        assert!(speeds(line).iter().any(|speed| (speed / known - 1.0).abs() < 0.005), "{known}: {line}");
    }
    // the true speed is first in all of them, with more than three quarters of the plausibility
    let first = |line: &Value| line["alternatives"][0].clone();
    let are_near = lines.iter().zip(known_rev_s).all(|(line, known)| {
        (number(&first(line), "speed_rev_s") / known - 1.0).abs() < 0.005 && number(&first(line), "plausibility") > 0.75
    });
    assert!(are_near, "{lines:?}");
}

#[test]
fn the_motor_step_has_two_blades_and_its_beeps_are_another_family() {
    let Some(folder) = recordings("motor-step") else { return };
    let path = folder.join("motor_step.wav");
    let line = &hovertone(&["tones", "--json", text(&path)]).ends_with(3).json_lines()[0];
    let families = line["families"].as_array().unwrap();
    let rotor = families.iter().find(|family| family["is_rotor"] == true).unwrap();
    let first = &rotor["readings"][0];
    assert!((number(first, "speed_rev_s") - 91.8).abs() < 0.3 && number(first, "plausibility") > 0.75, "{first}");
    assert_eq!((&first["blades"], &first["meaning"]), (&2.into(), &"blade_pass".into()));
    let beeps = families.iter().find(|family| (number(family, "fundamental_hz") - 1043.0).abs() < 5.0).unwrap();
    assert_eq!(beeps["remark"], "brief");
    assert!(
        number(beeps, "time_share") < 0.2 && number(beeps, "from_s") > 3.5 && number(beeps, "to_s") < 7.5,
        "{beeps}"
    );
}

#[test]
fn flights_are_found_with_their_truth_among_the_readings_and_the_rest_is_nothing() {
    let Some(folder) = recordings("small-multirotors") else { return };
    for file in ["DRONE_006.wav", "BACKGROUND_001.wav"] {
        for command in ["speed", "tones"] {
            let line = &hovertone(&[command, "--json", text(&folder.join(file))]).ends_with(3).json_lines()[0];
            assert_eq!((&line["status"], &line["speed_rev_s"]), (&"no_rotor_tone".into(), &Value::Null), "{file}");
        }
    }
    let flights =
        [("small-multirotors/DRONE_001.wav", 83.0..101.0), ("m300-hover/hover_no_payload_mic1.wav", 40.0..46.5)];
    for (file, range_rev_s) in flights {
        let path = folder.join("..").join(file);
        let line = &hovertone(&["speed", "--json", text(&path)]).json_lines()[0];
        assert!(speeds(line).iter().any(|speed| range_rev_s.contains(speed)), "{file}: {line}");
    }
}

/// Lines of the other rotors are no machines of their own: their speeds are near that of the loudest rotor.
#[test]
fn lines_of_other_rotors_are_called_that() {
    let Some(folder) = recordings("small-multirotors") else { return };
    let run = hovertone(&["tones", "--blades", "2", text(&folder.join("DRONE_001.wav"))]).ends_with(0);
    // the rotors turn at 81.5 to 86.6 rev/s
    let speeds: Vec<f64> = run
        .stdout
        .lines()
        .filter_map(|line| {
            line.split_once(" of another rotor of this vehicle, which turns at ")?.1.split(' ').next()?.parse().ok()
        })
        .collect();
    assert!(speeds.len() >= 3 && speeds.iter().all(|speed| (81.0..87.0).contains(speed)), "{}", run.stdout);
}
