//! What a message advises fits the fault, and works.

use crate::testkit::{hovertone, recordings, refused_with, steady_hover, text, write_hover, write_noise};
use hovertone_vehicle::RotorSpeed;
use std::fs;
use std::path::Path;

fn written(folder: &Path, name: &str, content: &str) -> String {
    fs::write(folder.join(name), content).unwrap();
    text(&folder.join(name)).to_owned()
}

/// What a run that cannot be done says.
fn failed_with(arguments: &[&str], words: &[&str]) {
    let run = hovertone(arguments).ends_with(1);
    words.iter().for_each(|word| assert!(run.stderr.contains(word), "{word:?}:\n{}", run.stderr));
}

#[test]
fn a_recording_and_a_log_that_are_exchanged_are_said_to_be() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a.wav");
    write_noise(&sound, 0.5);
    let log = written(folder.path(), "log.csv", "time_s,command_roll,roll_deg\n0,0,0\n1,0,0\n");
    failed_with(&["greybox", &log, text(&sound), "--vehicle", "ardrone"], &["are swapped", "the recording first"]);
}

#[test]
fn a_log_of_another_clock_is_answered_with_the_flag_for_it() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a.wav");
    write_noise(&sound, 3.0);
    let row = |row: u32| format!("{}.{},{},0\n", 1000 + row / 10, row % 10, 0.3 * f64::from(row / 5 % 2));
    let rows = (0..60).map(row).collect::<String>();
    let log = written(folder.path(), "log.csv", &("time_s,command_roll,roll_deg\n".to_owned() + &rows));
    let words = ["do not follow the commands of this log", "--log-offset-s"];
    failed_with(&["greybox", text(&sound), &log, "--vehicle", "ardrone"], &words);
    // a log without doublets is not to blame
    let steady = (0..60).map(|row| format!("0.{row:02},0,0\n")).collect::<String>();
    let log = written(folder.path(), "steady.csv", &("time_s,command_roll,roll_deg\n".to_owned() + &steady));
    let words = ["no doublets were flown", "for a minute, in roll"];
    failed_with(&["greybox", text(&sound), &log, "--vehicle", "ardrone"], &words);
}

#[test]
fn the_reason_of_a_recording_has_one_advice() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a.wav");
    write_noise(&sound, 0.5);
    let run = hovertone(&["listen", "--from-file", text(&sound), "--blades", "2", "--channel", "2"]).ends_with(1);
    assert!(run.stderr.contains("leave --channel out") && !run.stderr.contains("hint:"), "{}", run.stderr);
    let load = "413g=".to_owned() + text(&sound);
    let check = ["identify", "--vehicle", "ardrone", "--mass", &load, "--check", "--audio-track", "3"];
    let run = hovertone(&check).ends_with(1);
    assert!(run.stderr.contains("leave --audio-track out") && !run.stderr.contains("leave this one"), "{}", run.stderr);
}

#[test]
fn faults_of_a_file_are_told_in_its_own_words() {
    let folder = tempfile::tempdir().unwrap();
    let load = |vehicle: &str, load: &str| {
        format!(
            "[vehicle]\npreset = \"ardrone\"\n{vehicle}\n[[load]]\nname = \"a\"\nrecordings = [\"a.wav\"]\n{load}\n"
        )
    };
    let experiment = written(folder.path(), "e.toml", &load("", ""));
    failed_with(&["vehicles", "--add", &experiment], &["this is an experiment file", "`hovertone identify`"]);
    for (vehicle, of_load, words) in [
        ("rotors = 6", "", ["leave rotors or preset out under [vehicle]", "rotors_running"]),
        ("mass_kg = 413", "", ["mass_kg = 413 (did you mean 0.413?), but", "preset weighs 0.413 kg"]),
        ("", "from_s = 5.0\nto_s = 2.0", ["load \"a\": the end of the part", "write a later to_s"]),
    ] {
        let experiment = written(folder.path(), "e.toml", &load(vehicle, of_load));
        refused_with(&["identify", &experiment], &words);
    }
    let scenario = "duration_s = 8.0\n[[maneuver]]\nkind = \"doublet\"\namount = 0.3\naxis = \"rol\"\n";
    let scenario = written(folder.path(), "s.toml", scenario);
    refused_with(&["simulate", &scenario], &["s.toml:5:9", "axis = \"rol\"", "did you mean \"roll\""]);
    let vehicle = written(folder.path(), "v.toml", "[x]\nrotors = 4\nblades = 2\nshaft_speed_rev_s = [1200, 24000]\n");
    refused_with(&["vehicles", "--add", &vehicle], &["shaft_speed_rev_s = 24000", "3600 rpm are 60"]);
    let table = written(folder.path(), "t.csv", "rpm;thrust_n\n1.000;0,11\n2.000;0,44\n3.000;0,99\n");
    refused_with(&["fit", &table], &["line 2, column \"rpm\": \"1.000\"", "thousands without a point"]);
}

#[test]
fn names_of_groups_are_told_from_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |name: &str| [1, 2, 3].map(|n| format!("\"{name}\",{n}000,{}.{n}\n", n * n)).concat();
    let table = written(folder.path(), "t.csv", &("motor,rpm,thrust_n\n".to_owned() + &rows("a, big") + &rows("b")));
    let results = written(folder.path(), "r.json", &hovertone(&["fit", &table, "--json"]).ends_with(0).stdout);
    refused_with(&["export", &results, "--to", "gazebo"], &["several groups: \"a, big\", \"b\""]);
    hovertone(&["export", &results, "--to", "gazebo", "--group", "a, big"]).ends_with(0);
    let airsim = hovertone(&["export", &results, "--group", "b", "--to", "airsim", "--diameter-m", "0.2"]).ends_with(2);
    assert!(
        airsim.stderr.contains("--air-density-kg-m3") && !airsim.stderr.contains("--diameter"),
        "{}",
        airsim.stderr
    );
}

#[test]
fn a_bench_is_asked_for_a_band_and_for_no_mass_first() {
    let Some(bench) = recordings("crazyflie-propeller") else { return };
    let sound = bench.join("64000.wav");
    let said = hovertone(&["speed", "--blades", "2", "--rotors", "1", text(&sound)]).ends_with(3).stderr;
    let asked = "check the number of blades (--blades); on a bench, give the band around the tone of the blades with --band LOW:HIGH";
    assert!(said.contains(asked), "{said}");
    let band = ["speed", "--blades", "2", "--rotors", "1", "--band", "780:840", text(&sound)];
    hovertone(&band).ends_with(0);
}

#[test]
fn the_signal_that_was_meant_is_named() {
    let Some(logs) = recordings("logs") else { return };
    let log = logs.join("px4_esc_status.ulg");
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("x.csv");
    let words = ["log", text(&log), "--signal", "esc_statu", "-o", text(&output)];
    refused_with(&words, &["did you mean esc_status?"]);
}

#[test]
fn a_recording_that_cannot_be_read_is_no_warning() {
    let folder = tempfile::tempdir().unwrap();
    let load = "413g=".to_owned() + &written(folder.path(), "x.wav", "no sound");
    let run = hovertone(&["identify", "--vehicle", "ardrone", "--mass", &load]).ends_with(1);
    assert!(!run.stderr.contains("0 warnings"), "{}", run.stderr);
}

#[test]
fn what_cannot_be_heard_is_told_in_plain_words() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("a.wav");
    write_hover(&sound, steady_hover("ardrone", RotorSpeed::from_rev_s(61.3), 5.0));
    let part = hovertone(&["speed", text(&sound), "--blades", "2", "--to", "0.3"]).ends_with(3).stderr;
    assert!(part.contains("too short to hear a rotor") && !part.contains("hover for ten seconds"), "{part}");
    refused_with(
        &["speed", text(&sound), "--blades", "2", "--band", "200:100"],
        &["write the lower edge first: 100:200"],
    );
    let table = written(folder.path(), "t.csv", "speed_rpm,thrust_n\n1,2\n");
    failed_with(&["speed", &table, "--blades", "2"], &["(it is text)"]);
    // no step, and no speed that is held: what to do
    let motor = hovertone(&["motor", text(&sound), "--from", "4", "--to", "5"]).ends_with(3).stdout;
    assert!(!motor.contains("no speed stays the same") || motor.contains("choose a longer part"), "{motor}");
}
