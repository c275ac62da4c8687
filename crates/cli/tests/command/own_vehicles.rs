//! A user's own vehicles: added, listed, used by name in flags and in experiment files.

use crate::testkit::{Run, hovertone_with, steady_hover, text, write_hover};
use hovertone_vehicle::RotorSpeed;
use std::fs;
use std::path::Path;

const MINE: &str = "# my own\n[my-drone]\nname = \"My drone\"\nrotors = 4\ngear = { pinion = 8, wheel = 69 }\nblades = 2\n\
                    mass_kg = 0.42\nshaft_speed_rev_s = [20.0, 80.0]\nsource = \"my scale\"\n";

fn run(settings: &Path, words: &[&str]) -> Run {
    hovertone_with(words, |command| command.env("XDG_CONFIG_HOME", settings))
}

#[test]
fn an_own_vehicle_is_kept_listed_and_used() {
    let folder = tempfile::tempdir().unwrap();
    let (settings, file) = (folder.path().join("settings"), folder.path().join("mine.toml"));
    fs::write(&file, MINE).unwrap();
    let added = run(&settings, &["vehicles", "--add", text(&file)]).ends_with(0);
    assert!(added.stderr.contains("my-drone") && added.stderr.contains("vehicles.toml"), "{}", added.stderr);
    let kept = fs::read_to_string(settings.join("hovertone/vehicles.toml")).unwrap();
    assert!(kept.contains("# my own\n[my-drone]"), "comments are kept: {kept}");
    let list = run(&settings, &["vehicles"]).ends_with(0).stdout;
    for words in ["ardrone", "Your own, in ", "My drone", "my scale", "420 g", "69 (gear mesh)"] {
        assert!(list.contains(words), "{words}:\n{list}");
    }
    let json: serde_json::Value =
        serde_json::from_str(&run(&settings, &["vehicles", "--json"]).ends_with(0).stdout).unwrap();
    assert_eq!(json.as_array().unwrap().last().unwrap()["id"], "my-drone");

    let sound = folder.path().join("hover.wav");
    write_hover(&sound, steady_hover("ardrone", RotorSpeed::from_rpm(3600.0), 2.0));
    let heard = run(&settings, &["speed", "--vehicle", "my-drone", "--json", text(&sound)]).ends_with(0).json_lines();
    assert!((heard[0]["speed_rpm"].as_f64().unwrap() - 3600.0).abs() < 1.0, "{}", heard[0]["speed_rpm"]);
    let experiment = folder.path().join("experiment.toml");
    let load = "[[load]]\nname = \"a\"\nrecordings = [\"hover.wav\"]\n";
    fs::write(&experiment, format!("[vehicle]\npreset = \"my-drone\"\nmass_kg = 0.42\n{load}")).unwrap();
    let identified = run(&settings, &["identify", text(&experiment)]).ends_with(0);
    assert!(
        identified.stdout.starts_with("My drone: 4 rotors, tone at 69 times the rotor speed"),
        "{}",
        identified.stdout
    );
    let slip = run(&settings, &["speed", "--vehicle", "my-drne", text(&sound)]).ends_with(2);
    assert!(slip.stderr.contains("did you mean \"my-drone\""), "{}", slip.stderr);
}

#[test]
fn a_second_vehicle_is_added_and_what_is_wrong_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let (settings, file) = (folder.path().join("settings"), folder.path().join("mine.toml"));
    let kept = settings.join("hovertone/vehicles.toml");
    let add = |content: &str, code: i32| {
        fs::write(&file, content).unwrap();
        run(&settings, &["vehicles", "--add", text(&file)]).ends_with(code)
    };
    add(MINE, 0);
    add("[other]\nrotors = 6\nblades = 3\n", 0);
    let before = fs::read_to_string(&kept).unwrap();
    assert!(before.contains("[my-drone]") && before.contains("[other]"), "{before}");
    for (content, said) in [
        (MINE, "you have a vehicle \"my-drone\" already"),
        ("[ardrone]\nrotors = 4\n", "the name of a preset"),
        ("[x]\nrotors = 4\nblade = 2\n", "did you mean \"blades\""),
        ("[x]\nblades = 2\n", "rotors"),
        ("[x]\nrotors = 4\nblades = \"two\"\n", "write a positive whole number; "),
        ("[x]\nrotors = 4\nblades = 0\n", "it must be from 1 to 12 (hint: correct this number; "),
        ("[x]\nrotors = 4\npropeller_diameter_m = 254.0\n", "metres"),
        ("[\"My Drone\"]\nrotors = 4\n", "small letters"),
        ("# none\n", "no vehicle"),
    ] {
        let refused = add(content, 2);
        assert!(refused.stderr.contains(said), "{said}:\n{}", refused.stderr);
    }
    assert_eq!(fs::read_to_string(&kept).unwrap(), before);
    // a fault in the user's file stops only what needs it
    fs::write(&kept, "[my drone\n").unwrap();
    let broken = run(&settings, &["vehicles"]).ends_with(2);
    assert!(broken.stderr.contains("vehicles.toml:1"), "{}", broken.stderr);
    assert!(run(&settings, &["speed", "--vehicle", "ardrone", "none.wav"]).ends_with(1).stderr.contains("none.wav"));
}
