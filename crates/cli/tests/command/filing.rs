//! Slips in filing recordings: a mass that is not the vehicle's, a recording under the wrong load, a single flight.

use crate::testkit::{hovertone, steady_hover, text, write_hover};
use hovertone_vehicle::RotorSpeed;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A hover of the AR.Drone with this mass, by its constant of 2.83e-5 N s².
fn hover(folder: &Path, name: &str, mass_kg: f64) -> PathBuf {
    let path = folder.join(name);
    let speed = RotorSpeed::from_rad_s((mass_kg * 9.807 / 2.83e-5).sqrt());
    write_hover(&path, steady_hover("ardrone", speed, 3.0));
    path
}

#[test]
fn a_mass_that_is_not_the_vehicles_is_asked_about() {
    let folder = tempfile::tempdir().unwrap();
    let wav = hover(folder.path(), "a.wav", 0.413);
    for (vehicle, mass, words) in [
        ("ardrone", "4.13", ["weighs 4130 g, 10 times", "413 g", "decimal point"]),
        ("ardrone", "0.05", ["weighs 50.0 g, 0.12 times", "413 g", "decimal point"]),
        ("ardrone", "1.5", ["weighs 1500 g, 3.6 times", "413 g", "name of the vehicle"]),
        ("mambo", "413g", ["weighs 413 g, 6.6 times", "63.0 g", "name of the vehicle"]),
    ] {
        let load = format!("{mass}={}", text(&wav));
        let check = hovertone(&["identify", "--vehicle", vehicle, "--mass", &load, "--check"]).ends_with(0);
        words.iter().for_each(|word| assert!(check.stderr.contains(word), "{word}: {}", check.stderr));
        // nothing is heard yet, so there is no constant; the place of the advice is a flag, since no file is given
        assert!(!check.stderr.contains("this constant") && !check.stderr.contains("[vehicle]"), "{}", check.stderr);
    }
    let load = format!("4.13={}", text(&wav));
    let check = hovertone(&["identify", "--vehicle", "ardrone", "--mass", &load, "--check"]).ends_with(0);
    assert!(check.stderr.contains("(hint: check the decimal point and the unit of this mass"), "{}", check.stderr);
    let load = format!("4.13={}", text(&wav));
    let run = hovertone(&["identify", "--vehicle", "ardrone", "--mass", &load]).ends_with(3);
    assert!(run.stderr.contains("weighs 4130 g, 10 times"), "{}", run.stderr);
    assert!(run.stdout.contains("do not use this constant: "), "{}", run.stdout);
    let load = format!("0.0413={}", text(&wav));
    let run = hovertone(&["identify", "--vehicle", "ardrone", "--mass", &load]).ends_with(3);
    assert!(run.stderr.contains("weighs 41.3 g, 0.10 times"), "{}", run.stderr);
    assert!(run.stdout.contains("do not use this constant: "), "{}", run.stdout);
    // a mass that only differs from the vehicle's is used, with a warning
    let load = format!("1.0={}", text(&wav));
    hovertone(&["identify", "--vehicle", "ardrone", "--mass", &load]).ends_with(0);
    let load = format!("462g={}", text(&wav));
    let usual = hovertone(&["identify", "--vehicle", "ardrone", "--mass", &load, "--check"]).ends_with(0);
    assert!(!usual.stderr.contains(" times "), "{}", usual.stderr);
}

/// The ± of one flight does not contain how flights differ: identify and weigh say so, beside the number and in a warning.
#[test]
fn one_flight_says_what_its_uncertainty_lacks() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (hover(folder.path(), "a.wav", 0.413), hover(folder.path(), "b.wav", 0.414));
    let out = folder.path().join("out");
    let identify = ["identify", "--vehicle", "ardrone", "--mass", "413g", text(&a), "-o", text(&out)];
    let (warning, beside) =
        ("from flight to flight (hint: record each", "k = 2, without the differences from flight to flight");
    let one = hovertone(&identify).ends_with(0);
    assert!(one.stderr.contains(warning) && one.stdout.contains(beside), "{}{}", one.stdout, one.stderr);
    let results = out.join("results.json");
    let weigh = ["weigh", text(&b), "--constant", text(&results)];
    let weighed = hovertone(&weigh).ends_with(0);
    assert!(
        weighed.stderr.contains(warning) && weighed.stdout.contains(beside),
        "{}{}",
        weighed.stdout,
        weighed.stderr
    );
    let json: Value =
        serde_json::from_str(&hovertone(&[&weigh[..], &["--json"]].concat()).ends_with(0).stdout).unwrap();
    assert_eq!(json["has_flight_scatter"], false);
    // the recording behind the constant has its mass by definition
    let circle = "no independent result";
    assert!(!weighed.stderr.contains(circle), "{}", weighed.stderr);
    let own = hovertone(&["weigh", text(&a), text(&b), "--constant", text(&results)]).ends_with(0);
    assert!(own.stderr.contains("a.wav, so this mass is ") && own.stderr.contains(circle), "{}", own.stderr);
    // two flights behind the constant show it
    let both = ["identify", "--vehicle", "ardrone", "--mass", "413g", text(&a), text(&b), "-o", text(&out), "--force"];
    let both = hovertone(&both).ends_with(0);
    assert!(!both.stdout.contains(beside), "{}", both.stdout);
    assert!(!hovertone(&weigh).ends_with(0).stdout.contains(beside));
}

#[test]
fn a_recording_under_the_wrong_load_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let of = |name: &str, mass_kg: f64| text(&hover(folder.path(), name, mass_kg)).to_owned();
    let light: Vec<String> =
        (0..4).map(|n| of(&format!("light{n}.wav"), 0.413 * (1.0 + 1e-3 * f64::from(n)))).collect();
    let (heavy, other) = (of("heavy.wav", 0.462), of("other.wav", 0.4625));
    let with = |more: &[&str]| {
        let light = light.iter().map(String::as_str);
        let words =
            ["identify", "--vehicle", "ardrone", "--mass", "413g"].into_iter().chain(light).chain(more.iter().copied());
        hovertone(&words.collect::<Vec<_>>()).ends_with(0)
    };
    let wrong = with(&[&heavy, "--mass", "462g", &other]);
    assert!(wrong.stderr.contains("has 12 % more thrust than the other recordings"), "{}", wrong.stderr);
    assert!(
        wrong.stderr.contains("check that each recording is after the right --mass")
            && !wrong.stderr.contains("times the smallest"),
        "{}",
        wrong.stderr
    );
    let right = with(&["--mass", "462g", &heavy, &other]);
    assert!(!right.stderr.contains("the right --mass"), "{}", right.stderr);
}

#[test]
fn exchanged_masses_are_asked_about_and_fit_no_others() {
    let folder = tempfile::tempdir().unwrap();
    let of = |name: &str, mass_kg: f64| text(&hover(folder.path(), name, mass_kg)).to_owned();
    let (light, again) = (of("light.wav", 0.413), of("again.wav", 0.4135));
    let (heavy, twice) = (of("heavy.wav", 0.462), of("twice.wav", 0.4625));
    let identify = ["identify", "--vehicle", "ardrone", "--mass", "462g"];
    let single = hovertone(&[&identify[..], &[&light, "--mass", "413g", &heavy]].concat()).ends_with(3);
    let slower = "the rotors turned slower under the heavier load \"light\" than under the lighter \"heavy\"";
    assert!(
        single.stderr.contains(slower) && single.stderr.contains("check whether two masses are exchanged"),
        "{}",
        single.stderr
    );
    let double = hovertone(&[&identify[..], &[&light, &again, "--mass", "413g", &heavy, &twice]].concat()).ends_with(3);
    for run in [&single, &double] {
        let first = run.stderr.lines().find(|line| line.starts_with("warning: ")).unwrap();
        assert!(first.starts_with("warning: the rotors turned slower under the heavier load"), "{}", run.stderr);
        let verdict = run.stdout.lines().find(|line| line.starts_with("verdict: ")).unwrap();
        let contradicts =
            "verdict: the loads contradict each other: the rotors turned slower under the heavier load \"";
        assert!(verdict.starts_with(contradicts), "{verdict}");
        assert!(run.stdout.contains("\ndo not use this constant: C_f = "), "{}", run.stdout);
    }
    assert!(!double.stdout.contains("others") && !double.stderr.contains("fit the others"), "{}", double.stderr);
}

/// The blades tell a speed, and the mesh of the vehicle's gear is not there.
#[test]
fn a_vehicle_that_the_sound_contradicts_is_said_on_top() {
    let folder = tempfile::tempdir().unwrap();
    let of = |name: &str, rev_s: f64| {
        let path = folder.path().join(name);
        write_hover(&path, steady_hover("crazyflie", RotorSpeed::from_rev_s(rev_s), 10.0));
        text(&path).to_owned()
    };
    let one = of("one.wav", 95.0);
    let more = [of("two.wav", 95.2), of("three.wav", 94.8)];
    let identify = ["identify", "--vehicle", "ardrone", "--mass", "413g", &one];
    let all: Vec<&str> = identify.iter().copied().chain(more.iter().map(String::as_str)).collect();
    for words in [&identify[..], &all] {
        let run = hovertone(words).ends_with(3);
        let first = run.stderr.lines().find(|line| line.starts_with("warning: ")).unwrap();
        let says = "the vehicle does not fit the sound: its tone is hardly heard";
        assert!(first.starts_with(&format!("warning: {says}")), "{}", run.stderr);
        let (verdict, constant) = run.stdout.split_once("do not use this constant: C_f = ").unwrap();
        assert!(verdict.contains(&format!("\nverdict: {says}")) && !constant.contains("verdict"), "{}", run.stdout);
        assert!(run.stderr.contains("the speed may come from another sound"), "{}", run.stderr);
    }
    let weigh = ["weigh", &one, "--vehicle", "ardrone", "--constant-n-s2", "2.83e-5"];
    let run = hovertone(&weigh).ends_with(3);
    assert!(run.stdout.starts_with("do not use this mass: "), "{}", run.stdout);
}
