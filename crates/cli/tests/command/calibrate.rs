//! The recorder's clock and the order, against one known speed.

use crate::testkit::{Run, hovertone, refused_with, steady_hover, text, write_hover};
use hovertone_sim::HoverSettings;
use hovertone_vehicle::RotorSpeed;
use std::fs;
use std::path::Path;

/// One rotor of two blades at a true speed, in a file whose rate is off: the recorder's clock runs slow by `slow_ppm`.
fn write_bench(path: &Path, rpm: f64, slow_ppm: f64) {
    let speed = RotorSpeed::from_rpm(rpm / (1.0 + slow_ppm / 1e6));
    let mut settings = steady_hover("crazyflie", speed, 4.0);
    settings.rotors.truncate(1);
    write_hover(path, HoverSettings { seed: 3, ..settings });
}

fn calibrated(path: &Path, more: &[&str]) -> Run {
    hovertone(&[&["calibrate", text(path), "--tachometer-rpm", "21000", "--known-std-ppm", "5"], more].concat())
}

#[test]
fn a_slow_clock_fails_and_its_correction_passes_everywhere() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("bench.wav");
    write_bench(&sound, 21_000.0, 400.0);
    let failed = calibrated(&sound, &["--vehicle", "crazyflie"]).ends_with(3);
    for words in ["order: pass", "clock: fail, it runs slow by", "--clock-correction-ppm", "[recorder]"] {
        assert!(failed.stdout.contains(words), "{words}:\n{}", failed.stdout);
    }
    let json = calibrated(&sound, &["--vehicle", "crazyflie", "--json"]).ends_with(3).json_lines().remove(0);
    let ppm = json["clock_correction_ppm"].as_f64().unwrap();
    let std_ppm = json["clock_correction_std_ppm"].as_f64().unwrap();
    assert!((ppm - 400.0).abs() < 4.0 * std_ppm && std_ppm < 20.0, "{json}");
    assert_eq!((json["passes"].as_bool(), json["order_that_fits"].as_f64()), (Some(false), Some(2.0)));
    let flag = format!("{ppm:.1}");
    let passed = calibrated(&sound, &["--vehicle", "crazyflie", "--clock-correction-ppm", &flag]).ends_with(0);
    assert!(passed.stdout.ends_with("\npass\n"), "{}", passed.stdout);
    // the correction is a flag of every command that hears, and a setting of an experiment
    let rpm = |words: &[&str]| {
        let run =
            hovertone(&[&["speed", "--vehicle", "crazyflie", "--rotors", "1", "--json", text(&sound)], words].concat());
        run.ends_with(0).json_lines()[0]["speed_rpm"].as_f64().unwrap()
    };
    let ratio = rpm(&["--clock-correction-ppm", &flag]) / rpm(&[]);
    assert!((1e6 * (ratio - 1.0) - ppm).abs() < 1.0, "{ratio}");
    let experiment = folder.path().join("experiment.toml");
    let identified = |recorder: &str| {
        let load = "[[load]]\nname = \"bench\"\nthrust_n = 0.1\nrotors_running = 1\nrecordings = [\"bench.wav\"]\n";
        fs::write(&experiment, format!("[vehicle]\npreset = \"crazyflie\"\n{recorder}{load}")).unwrap();
        let run = hovertone(&["identify", "--json", text(&experiment)]).ends_with(0);
        let results: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        results["loads"][0]["speed_rpm"].as_f64().unwrap()
    };
    let ratio = identified(&format!("[recorder]\nclock_correction_ppm = {flag}\n")) / identified("");
    assert!((1e6 * (ratio - 1.0) - ppm).abs() < 1.0, "{ratio}");
}

#[test]
fn a_wrong_order_is_named_with_the_one_that_fits() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("bench.wav");
    write_bench(&sound, 21_000.0, 0.0);
    assert!(calibrated(&sound, &["--vehicle", "crazyflie"]).ends_with(0).stdout.contains("order: pass, 2 fits"));
    let wrong = calibrated(&sound, &["--order", "1", "--band", "650:750"]).ends_with(3);
    for words in ["order: fail", "order 2 fits, not 1", "--order 2", "--band 341", "fail\n"] {
        assert!(wrong.stdout.contains(words), "{words}:\n{}", wrong.stdout);
    }
    let other =
        hovertone(&["calibrate", text(&sound), "--vehicle", "crazyflie", "--tachometer-rpm", "15000"]).ends_with(3);
    assert!(other.stdout.contains("no order explains"), "{}", other.stdout);
}

#[test]
fn a_tone_of_known_frequency_checks_the_clock_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tone.wav");
    let spec = hound::WavSpec {
        channels: 1,
        sample_rate: 44_100,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut writer = hound::WavWriter::create(&path, spec).unwrap();
    for index in 0..4 * 44_100 {
        let turns = 1000.2 * f64::from(index) / 44_100.0;
        writer.write_sample((12_000.0 * (std::f64::consts::TAU * turns).sin()) as i16).unwrap();
    }
    writer.finalize().unwrap();
    let fast = hovertone(&["calibrate", "--true-hz", "1000", text(&path)]).ends_with(3);
    assert!(fast.stdout.contains("it runs fast by") && fast.stdout.contains("ppm -200.0"), "{}", fast.stdout);
    hovertone(&["calibrate", "--true-hz", "1000.2", text(&path)]).ends_with(0);
}

#[test]
fn what_is_no_known_speed_is_refused() {
    refused_with(&["calibrate", "a.wav", "--tachometer-rpm", "fast"], &["tachometer_rpm", "above 0"]);
    refused_with(&["calibrate", "a.wav", "--true-hz", "-1"], &["true_hz"]);
    refused_with(&["calibrate", "a.wav", "--true-hz", "1000", "--known-std-ppm", "-1"], &["known_std_ppm = -1"]);
    let run = hovertone(&["calibrate", "a.wav"]).ends_with(2);
    assert!(run.stderr.contains("--tachometer-rpm"), "{}", run.stderr);
    let run = hovertone(&["speed", "a.wav", "--clock-correction-ppm", "90000"]).ends_with(2);
    assert!(run.stderr.contains("-2000 to 2000"), "{}", run.stderr);
}
