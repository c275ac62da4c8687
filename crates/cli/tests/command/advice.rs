//! Advice of a command names what this command has, so that it leads on.

use crate::testkit::{hovertone, refused_with, steady_hover, text, write_hover, write_noise};
use hovertone_vehicle::RotorSpeed;
use std::fs;

#[test]
fn identify_names_keys_of_its_file_and_flags_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a.wav");
    write_hover(&sound, steady_hover("ardrone", RotorSpeed::from_rev_s(60.0), 6.0));
    let experiment = folder.path().join("e.toml");
    let content = "[vehicle]\npreset = \"ardrone\"\n[[load]]\nname = \"a\"\nrecordings = [\"a.wav\"]\n";
    fs::write(&experiment, content).unwrap();
    let by_file = hovertone(&["identify", text(&experiment)]).ends_with(0);
    assert!(by_file.stderr.contains("give their number as rotors under [vehicle]"), "{}", by_file.stderr);
    assert!(!by_file.stderr.contains("--"), "{}", by_file.stderr);
    let load = format!("413g={}", text(&sound));
    let by_flags = hovertone(&["identify", "--vehicle", "ardrone", "--mass", &load]).ends_with(0);
    assert!(by_flags.stderr.contains("give their number with --rotors"), "{}", by_flags.stderr);

    write_noise(&sound, 3.0);
    let by_file = hovertone(&["identify", text(&experiment)]).ends_with(3);
    assert!(!by_file.stderr.contains("--"), "{}", by_file.stderr);
}

#[test]
fn a_flag_beside_an_experiment_file_is_told_its_key() {
    let keys =
        [("--order=69", "order under [tone]"), ("--from=3", "from_s under [[load]]"), ("--mass=0.4", "mass_kg in")];
    for (flag, key) in keys {
        refused_with(&["identify", "e.toml", flag], &["write it into the experiment file, as", key]);
    }
    refused_with(&["identify", "--order", "69"], &["only an experiment file has a place for it", "order under [tone]"]);
}

#[test]
fn a_folder_in_place_of_an_experiment_file_is_told_what_it_holds() {
    let folder = tempfile::tempdir().unwrap();
    let said = || hovertone(&["identify", text(folder.path())]).ends_with(1).stderr;
    assert!(said().contains("`hovertone init` writes one"), "{}", said());
    write_noise(&folder.path().join("a.wav"), 0.1);
    assert!(said().contains(&format!("--mass 413g={}", text(folder.path()))), "{}", said());
    fs::write(folder.path().join("bench.toml"), "").unwrap();
    assert!(said().contains("bench.toml)"), "{}", said());
}

#[test]
fn a_gear_in_the_spelling_of_the_flag_is_told_that_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = folder.path().join("e.toml");
    fs::write(&experiment, "[vehicle]\nrotors = 4\ngear = \"8:69\"\n").unwrap();
    refused_with(&["identify", text(&experiment)], &["gear = { pinion = 8, wheel = 69 }"]);
}

#[test]
fn a_rotor_as_steady_as_the_mains_is_not_said_to_be_hum() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a.wav");
    write_hover(&sound, steady_hover("iris", RotorSpeed::from_rev_s(60.0), 6.0));
    let said = hovertone(&["speed", text(&sound), "--blades", "2", "--rotors", "1"]).ends_with(3).stderr;
    assert!(said.contains("mains hum, or a rotor that turns as steadily"), "{said}");
    assert!(said.contains("record it at another throttle"), "{said}");
}

#[test]
fn weigh_takes_the_part_and_the_diameter_that_its_advice_asks_for() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a.wav");
    write_noise(&sound, 3.0);
    let of = ["weigh", text(&sound), "--vehicle", "ardrone", "--constant-n-s2", "2.83e-5"];
    let run = hovertone(&[&of[..], &["--from", "4"]].concat()).ends_with(3);
    assert!(run.stderr.contains("the chosen times begin later; choose others with --from and --to"), "{}", run.stderr);
    refused_with(&[&of[..], &["--from", "2", "--to", "1"]].concat(), &["hovertone weigh --help"]);
    refused_with(&[&of[..], &["--diameter-m", "4"]].concat(), &["diameter_m = 4"]);
}
