//! Flags that change nothing are refused, or said to change nothing.

use crate::testkit::{hovertone, refused_with, text, write_noise};

#[test]
fn a_flag_that_changes_nothing_is_refused() {
    let speed = ["speed", "a.wav", "--blades", "2"];
    refused_with(&[&speed[..], &["--hop-share", "0.3"]].concat(), &["--hop-share changes nothing", "maximum_trace"]);
    refused_with(&[&speed[..], &["--window-s", "0.1"]].concat(), &["--window-s changes nothing", "maximum_trace"]);
    let trace = [&speed[..], &["--method", "maximum_trace", "--gaussian-threshold-share", "0.5"]].concat();
    refused_with(&trace, &["--gaussian-threshold-share changes nothing", "give --method gaussian"]);
    let plan = ["fit", "--plan", "--mass-kg", "0.413"];
    for flag in ["--temperature-c", "--pressure-hpa", "--humidity-percent"] {
        refused_with(&[&plan[..], &[flag, "20"]].concat(), &[flag, "--plan does not use the density of the air"]);
    }
    refused_with(&[&plan[..], &["--height-m", "20"]].concat(), &["--height-m 20 alone does not give the gravity"]);
}

#[test]
fn a_check_and_a_picture_refuse_what_only_a_table_shows() {
    let verify = ["verify", "a.wav", "log.csv", "--vehicle", "ardrone"];
    let picture = ["spectrogram", "a.wav", "-o", "never.svg", "--vehicle", "ardrone"];
    for flags in
        [&["--condition"][..], &["--clock-ppm", "9"], &["--drift-m-max", "2"], &["--radial-speed-m-s-max", "2"]]
    {
        for command in [&verify[..], &picture[..]] {
            refused_with(&[command, flags].concat(), &[&format!("{} changes nothing", flags[0])]);
        }
    }
    refused_with(&[&picture[..], &["--dpi", "600"]].concat(), &["--dpi 600 changes nothing", ".png"]);
}

#[test]
fn a_mass_without_what_it_needs_is_said_to_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a.wav");
    write_noise(&sound, 0.5);
    for (command, code) in [("speed", 3), ("tones", 3), ("motor", 3)] {
        let said = |flags: &[&str]| {
            let asked = [&[command, text(&sound), "--blades", "2", "--mass-kg", "0.4"], flags].concat();
            hovertone(&asked).ends_with(code).stderr
        };
        let alone = said(&[]);
        assert!(alone.contains("--mass-kg changes nothing without --diameter-m and --rotors"), "{alone}");
        assert!(said(&["--rotors", "4"]).contains("without --diameter-m:"));
        assert!(!said(&["--rotors", "4", "--diameter-m", "0.2"]).contains("changes nothing"));
    }
}

/// Commands that show no progress say so, and others take the flag.
#[test]
fn no_progress_is_refused_where_none_is_shown() {
    for asked in [
        &["listen", "--from-file", "a.wav", "--blades", "2"][..],
        &["fit", "stand.csv"],
        &["log", "flight.ulg"],
        &["export", "results.json", "--to", "gazebo"],
        &["vehicles"],
    ] {
        let what = format!("--no-progress changes nothing: `hovertone {}` shows no progress", asked[0]);
        refused_with(&[asked, &["--no-progress"]].concat(), &[&what, "leave --no-progress out"]);
    }
    let run = hovertone(&["speed", "nowhere.wav", "--no-progress"]).ends_with(1);
    assert!(run.stderr.contains("nowhere.wav"), "{}", run.stderr);
}

#[test]
fn harmonics_of_a_generator_are_refused() {
    let asked = ["calibrate", "a.wav", "--true-hz", "1000", "--harmonics", "5"];
    refused_with(&asked, &["--harmonics 5 changes nothing", "--blades 2"]);
}
