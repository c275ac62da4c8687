//! Advice of a command names what this command has, so that it leads on.

use crate::testkit::{hovertone, refused_with, steady_hover, text, write_hover, write_noise, write_wav};
use hovertone_vehicle::RotorSpeed;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

#[test]
fn identify_names_keys_of_its_file_and_flags_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a.wav");
    write_hover(&sound, steady_hover("ardrone", RotorSpeed::from_rev_s(60.0), 6.0));
    let experiment = folder.path().join("e.toml");
    let content = "[vehicle]\npreset = \"ardrone\"\n[[load]]\nname = \"a\"\nrecordings = [\"a.wav\"]\n";
    fs::write(&experiment, content).unwrap();
    let by_file = hovertone(&["identify", text(&experiment)]).ends_with(0);
    assert!(!by_file.stderr.contains("rotors = N"), "{}", by_file.stderr);
    // all loads hover, so all rotors turn
    assert!(!by_file.stderr.contains("bench") && by_file.stderr.contains("C_f uses the mean"), "{}", by_file.stderr);
    assert!(!by_file.stderr.contains("--"), "{}", by_file.stderr);
    let load = format!("413g={}", text(&sound));
    let by_flags = hovertone(&["identify", "--vehicle", "ardrone", "--mass", &load]).ends_with(0);
    assert!(by_flags.stderr.contains("C_f uses the mean speed of all rotors"), "{}", by_flags.stderr);
    assert!(!by_flags.stderr.contains("--rotors"), "{}", by_flags.stderr);

    write_noise(&sound, 3.0);
    let by_file = hovertone(&["identify", text(&experiment)]).ends_with(3);
    assert!(!by_file.stderr.contains("--"), "{}", by_file.stderr);
}

#[test]
fn a_flag_beside_an_experiment_file_is_told_its_key() {
    let keys =
        [("--order=69", "order under [tone]"), ("--from=3", "from_s under [[load]]"), ("--mass=0.4", "mass_kg under")];
    for (flag, key) in keys {
        refused_with(&["identify", "e.toml", flag], &["the experiment file", key]);
    }
    refused_with(&["identify", "--order", "69"], &["in an experiment file instead", "order under [tone]"]);
}

#[test]
fn a_folder_in_place_of_an_experiment_file_is_told_what_it_holds() {
    let folder = tempfile::tempdir().unwrap();
    let said = || hovertone(&["identify", text(folder.path())]).ends_with(1).stderr;
    assert!(said().contains("`hovertone init` writes one"), "{}", said());
    write_noise(&folder.path().join("a.wav"), 0.1);
    assert!(said().contains(&format!("--mass 413g={}", text(folder.path()))), "{}", said());
    // of two files, one is an experiment
    fs::write(folder.path().join("Cargo.toml"), "[package]\n").unwrap();
    fs::write(folder.path().join("bench.toml"), "[[load]]\n").unwrap();
    assert!(said().contains("bench.toml)"), "{}", said());
}

#[test]
fn a_folder_or_a_pattern_in_place_of_a_recording_is_told_what_it_holds() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.wav", "b.wav"] {
        write_noise(&folder.path().join(name), 0.1);
    }
    let (first, pattern) = (folder.path().join("a.wav"), folder.path().join("*.wav"));
    for command in [&["listen", "--from-file"][..], &["spectrogram", "-o", "x.png"]] {
        let of_folder = hovertone(&[command, &[text(folder.path())]].concat()).ends_with(1).stderr;
        let words =
            format!("this is a folder, not a recording; give a recording in the folder, such as {}", text(&first));
        assert!(of_folder.contains(&words), "{of_folder}");
        let of_pattern = hovertone(&[command, &[text(&pattern)]].concat()).ends_with(1).stderr;
        let words = format!("this command hears one recording at a time; give one recording, such as {}", text(&first));
        assert!(of_pattern.contains(&words), "{of_pattern}");
    }
}

#[test]
fn tables_of_other_languages_are_told_what_to_change() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("a.csv");
    let german = "Drehzahl (U/min);Schub (g)\n3000;112,5\n4000;201,3\n";
    fs::write(&table, german).unwrap();
    refused_with(
        &["fit", text(&table)],
        &["no column holds a speed", "rename the header of the right column, as in speed_rpm"],
    );
    refused_with(
        &["log", text(&table)],
        &["no header names the time", "rename the header of the time column", "--column"],
    );
    let wide: Vec<u8> = german.encode_utf16().flat_map(u16::to_le_bytes).collect();
    fs::write(&table, [&b"\xff\xfe"[..], &wide].concat()).unwrap();
    let said = hovertone(&["fit", text(&table)]).ends_with(1).stderr;
    assert!(said.contains("text in UTF-16") && said.contains("CSV UTF-8"), "{said}");
}

#[test]
fn numbers_and_words_of_other_programs_are_told_as_this_one_takes_them() {
    for (line, words) in [
        ("speed a.wav --diameter-m 0,2", ["the decimal sign is a point", "write 0.2"]),
        ("calibrate a.wav --tachometer-rpm 62,08", ["the decimal sign is a point", "write 62.08"]),
        ("fit --plan --mass-kg 413g --wanted-share 3%", ["without a percent sign", "write 0.03"]),
        ("speed a.wav --blades 2 --clock-correction-ppm 5%", ["without a percent sign", "1 % is 10000 ppm"]),
        (
            "weigh a.wav --constant-n-s2 2e-5 --constant-std-n-s2 0.5%",
            ["a number without a percent sign", "0.5 % of 2e-5 is 1.00e-7"],
        ),
        ("speed a.wav --diameter-m 3%", ["a number without a percent sign", "give it in m"]),
        ("speed a.wav --blades 2,0", ["must be a whole number", "--blades 2"]),
        ("speed -blades 2 a.wav", ["there is no flag -b", "two dashes: write --blades"]),
        ("speed a.wav -o x.json", ["there is no flag -o", "the results go to stdout"]),
        ("weigh out/results.json a.wav", ["needs a thrust constant", "write --constant out/results.json"]),
    ] {
        refused_with(&line.split(' ').collect::<Vec<_>>(), &words);
    }
}

#[test]
fn a_gear_in_the_spelling_of_the_flag_is_told_that_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = folder.path().join("e.toml");
    for gear in ["\"8:69\"", "8:69"] {
        fs::write(&experiment, format!("[vehicle]\nrotors = 4\ngear = {gear}\n")).unwrap();
        refused_with(&["identify", text(&experiment)], &["gear = { pinion = 8, wheel = 69 }"]);
    }
    let words = "[vehicle]\n".encode_utf16().flat_map(u16::to_le_bytes);
    fs::write(&experiment, [0xff, 0xfe].into_iter().chain(words).collect::<Vec<u8>>()).unwrap();
    let utf16 = hovertone(&["identify", text(&experiment)]).ends_with(1);
    assert!(utf16.stderr.contains("text in UTF-16") && utf16.stderr.contains("as UTF-8"), "{}", utf16.stderr);
}

const RATE_HZ: u32 = 16_000;

/// One rotor with two blades at about 83 rev/s, in noise: its blade pass with harmonics, and the lines of its shaft between them.
fn write_rotor(path: &Path, duration_ms: u32) {
    let mut state = 1u32;
    let mut noise = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state) / f64::from(u32::MAX) - 0.5
    };
    let sample = |n: u32| {
        let time_s = f64::from(n) / f64::from(RATE_HZ);
        let turns = 83.0 * time_s + 0.05 * (TAU * 0.7 * time_s).sin();
        let level = |k: u32| if k.is_multiple_of(2) { 2.0 / f64::from(k) } else { 0.3 / f64::from(k) };
        let line = |k: u32| level(k) * (TAU * f64::from(k) * turns + f64::from(k * k)).sin();
        (0.1 * (1..=16).map(line).sum::<f64>() + 0.2 * noise()) as f32
    };
    write_wav(path, &(0..duration_ms * RATE_HZ / 1000).map(sample).collect::<Vec<f32>>(), RATE_HZ);
}

/// The blades that a message advises to give.
fn advised_blades(said: &str) -> Option<&str> {
    said.split("give --blades ").nth(1)?.split(' ').next()
}

#[test]
fn blades_that_are_advised_lead_to_a_speed() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    let mut advised = Vec::new();
    for (name, duration_ms) in [("long.wav", 8000), ("short.wav", 500), ("shorter.wav", 400)] {
        write_rotor(&place(name), duration_ms);
        for flags in [["--vehicle", "ardrone"], ["--blades", "5"]] {
            let sound = place(name);
            let said = hovertone(&[&["speed", text(&sound)][..], &flags].concat()).stderr;
            let Some(blades) = advised_blades(&said).filter(|blades| *blades != "N") else { continue };
            let followed = hovertone(&["speed", text(&sound), "--blades", blades]);
            assert!(!followed.stderr.contains("no rotor tone"), "{name} {flags:?}: {said}{}", followed.stderr);
            advised.push((name, flags));
        }
    }
    assert!(advised.iter().any(|(name, _)| *name == "long.wav"), "{advised:?}");
}

#[test]
fn a_rotor_without_a_gear_is_told_that_no_mesh_is_heard() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a.wav");
    write_noise(&sound, 4.0);
    let said = hovertone(&["speed", text(&sound), "--vehicle", "ardrone"]).ends_with(3).stderr;
    assert!(
        said.contains(
            "the tone of the gear (69 times the rotor speed) is not heard at 920 to 8280 Hz (its frequency at 13 to 120 rev/s)"
        ),
        "{said}"
    );
    assert!(said.contains("if the rotors have no gear, give --blades N alone"), "{said}");
}

#[test]
fn a_rotor_as_steady_as_the_mains_is_not_said_to_be_hum() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a.wav");
    write_hover(&sound, steady_hover("iris", RotorSpeed::from_rev_s(60.0), 6.0));
    let said = hovertone(&["speed", text(&sound), "--blades", "2", "--rotors", "1"]).ends_with(3).stderr;
    assert!(said.contains("mains hum (from the power supply), or a rotor at a constant speed"), "{said}");
    assert!(said.contains("record the rotor at another throttle"), "{said}");
}

#[test]
fn weigh_takes_the_part_and_the_diameter_that_its_advice_asks_for() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a.wav");
    write_noise(&sound, 3.0);
    let of = ["weigh", text(&sound), "--vehicle", "ardrone", "--constant-n-s2", "2.83e-5"];
    let run = hovertone(&[&of[..], &["--from", "4"]].concat()).ends_with(3);
    assert!(
        run.stderr.contains("before the chosen part begins; choose another part with --from and --to"),
        "{}",
        run.stderr
    );
    refused_with(&[&of[..], &["--from", "2", "--to", "1"]].concat(), &["hovertone weigh --help"]);
    refused_with(&[&of[..], &["--diameter-m", "4"]].concat(), &["diameter_m = 4"]);
}
