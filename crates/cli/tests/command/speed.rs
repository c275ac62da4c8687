//! `hovertone speed` on sound with a known speed.

use crate::testkit::{hovertone, steady_bench, steady_hover, text, write_hover, write_noise};
use hovertone_sim::SpeedProfile;
use hovertone_vehicle::RotorSpeed;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Bias of an interpolated peak (Hann, two-fold zero padding), with room for noise, in bins of the frame.
const PEAK_BIAS_BINS: f64 = 0.01;

struct Folder {
    folder: tempfile::TempDir,
}

impl Folder {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A two-bladed rotor at 100 turns a second.
    fn hover(&self) -> PathBuf {
        let path = self.path("hover.wav");
        write_hover(&path, steady_hover("crazyflie", RotorSpeed::from_rev_s(100.0), 4.0));
        path
    }

    fn noise(&self) -> PathBuf {
        let path = self.path("noise.wav");
        write_noise(&path, 3.0);
        path
    }
}

fn keys(object: &Value) -> Vec<&str> {
    object.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn json_has_the_fixed_names_and_the_right_speed() {
    let folder = Folder::new();
    let path = folder.hover();
    let run = hovertone(&["speed", "--blades", "2", "--json", text(&path)]).ends_with(0);
    let lines = run.json_lines();
    let [line] = &lines[..] else { panic!("{}", run.stdout) };
    let fixed = "file status method order tone_hz speed_rev_s speed_rpm speed_rad_s std_uncertainty_rev_s spread_rev_s \
                 from_s to_s warnings reason version settings recording hover";
    for name in fixed.split_whitespace() {
        assert!(keys(line).contains(&name), "{name} is not in {:?}", keys(line));
    }
    assert!(!keys(line).contains(&"rotors"));
    assert_eq!((&line["file"], &line["status"]), (&Value::from(text(&path)), &Value::from("ok")));
    assert_eq!((&line["method"], line["order"].as_f64()), (&Value::from("harmonic"), Some(2.0)));
    assert_eq!(line["recording"]["sha256"].as_str().unwrap().len(), 64);
    let number = |name: &str| line[name].as_f64().unwrap();
    let tolerance_rev_s = PEAK_BIAS_BINS / number("window_s") / 2.0;
    assert!((number("speed_rev_s") - 100.0).abs() < tolerance_rev_s, "{} ± {tolerance_rev_s}", number("speed_rev_s"));
    assert!((number("speed_rpm") / number("speed_rev_s") - 60.0).abs() < 1e-9);
    assert!((number("speed_rad_s") / number("speed_rev_s") - std::f64::consts::TAU).abs() < 1e-9);
    assert!((number("tone_hz") / number("speed_rev_s") - 2.0).abs() < 1e-9);
    assert!((0.0..0.1).contains(&number("std_uncertainty_rev_s")));
    assert!(number("from_s") >= 0.0 && number("to_s") <= 4.0 && number("to_s") - number("from_s") > 3.0);
}

#[test]
fn all_ways_to_name_the_tone_hear_the_same_rotor() {
    let folder = Folder::new();
    let path = folder.path("geared.wav");
    write_hover(&path, steady_hover("ardrone", RotorSpeed::from_rev_s(60.0), 4.0));
    let ways: [&[&str]; 6] = [
        &["--vehicle", "ardrone"],
        &["--gear", "8:69"],
        &["--gear", "69", "--blades", "2"],
        &["--order", "69"],
        &["--order", "69", "--vehicle", "ardrone", "--method", "gaussian"],
        &["--order", "69", "--band", "4000:4300"],
    ];
    for way in ways {
        let run = hovertone(&[&["speed", "--json", text(&path)], way].concat()).ends_with(0);
        let line = &run.json_lines()[0];
        let (speed_rev_s, window_s) = (line["speed_rev_s"].as_f64().unwrap(), line["window_s"].as_f64().unwrap());
        // rotors that turn alike are a group: three of its four tracks follow noise, as its uncertainty says
        let group_rev_s = line["std_uncertainty_rev_s"].as_f64().filter(|_| line["rotors_heard"] == "group");
        let error_rev_s_max = group_rev_s.unwrap_or(PEAK_BIAS_BINS / window_s / 69.0);
        assert!((speed_rev_s - 60.0).abs() < error_rev_s_max, "{way:?}: {speed_rev_s}");
        assert_eq!(line["order"].as_f64(), Some(69.0), "{way:?}");
    }
}

#[test]
fn noise_has_no_rotor_tone_and_ends_with_3() {
    let folder = Folder::new();
    let path = folder.noise();
    let run = hovertone(&["speed", "--blades", "2", "--json", text(&path)]).ends_with(3);
    let line = &run.json_lines()[0];
    assert_eq!(line["status"], "no_rotor_tone");
    assert!(line["reason"].as_str().is_some_and(|reason| !reason.is_empty()));
    for name in ["tone_hz", "speed_rev_s", "speed_rpm", "speed_rad_s", "std_uncertainty_rev_s", "spread_rev_s"] {
        assert!(line[name].is_null(), "{name}");
    }
    let table = hovertone(&["speed", "--blades", "2", text(&path)]).ends_with(3);
    assert!(table.stdout.contains("no rotor tone"), "{}", table.stdout);
    assert!(table.stderr.contains("no rotor tone: nothing sounds like a rotor"), "{}", table.stderr);
    // where something said leaves speeds out, the answer is of the others only
    for (said, heard) in [
        (
            &["--vehicle", "ardrone"][..],
            "the tone of the gear (69 times the rotor speed) is not heard at 920 to 8280 Hz (its frequency at 13 to 120 rev/s)",
        ),
        (
            &["--vehicle", "crazyflie"],
            "no rotor is heard at 136 to 626 rev/s, where the given facts expect it; check the vehicle, or move the microphone",
        ),
        (
            &["--blades", "2", "--band", "200:300"],
            "no rotor is heard at 100 to 150 rev/s, where the given facts expect it; check the number of blades and the band, or move the",
        ),
    ] {
        let run = hovertone(&[&["speed", text(&path)], said].concat()).ends_with(3);
        assert!(run.stderr.contains(heard), "{}", run.stderr);
    }
}

#[test]
fn a_missing_file_ends_with_1_and_the_others_are_done_in_order() {
    let folder = Folder::new();
    let (hover, noise, missing) = (folder.hover(), folder.noise(), folder.path("missing.wav"));
    let pattern = folder.path("*.flac");
    let files = [text(&missing), text(&noise), text(&hover), text(&pattern), text(folder.folder.path())];
    let run = hovertone(&[&["speed", "--blades", "2", "--json"], &files[..]].concat()).ends_with(1);
    let lines = run.json_lines();
    let statuses: Vec<_> = lines.iter().map(|line| line["status"].as_str().unwrap()).collect();
    assert_eq!(statuses, ["error", "no_rotor_tone", "ok", "error", "error"]);
    let names: Vec<_> = lines.iter().map(|line| line["file"].as_str().unwrap()).collect();
    assert_eq!(names, files);
    // the path stands last, on a line of its own
    assert!(run.stderr.contains(&format!("error: {}: ", missing.display())), "{}", run.stderr);
    assert!(run.stderr.contains("no file matches") && run.stderr.contains("this is a folder"), "{}", run.stderr);
}

#[test]
fn take_off_and_landing_are_cut_away_and_said() {
    let folder = Folder::new();
    let path = folder.path("flight.wav");
    let profile = SpeedProfile { silence_before_s: 1.5, spin_up_s: 1.5, spin_down_s: 1.5, silence_after_s: 1.5 };
    let hover = steady_hover("crazyflie", RotorSpeed::from_rev_s(100.0), 14.0);
    write_hover(&path, hovertone_sim::HoverSettings { profile, ..hover });
    let said = ["speed", "--blades", "2", "--rotors", "4", "--diameter-m", "0.084", "--mass-kg", "0.027", "--json"];
    let run = hovertone(&[&said[..], &[text(&path)]].concat()).ends_with(0);
    let line = &run.json_lines()[0];
    let (from_s, to_s) = (line["from_s"].as_f64().unwrap(), line["to_s"].as_f64().unwrap());
    // the hover is 3 to 11 s, and a cut is made to two rows of half a second
    assert!((2.5..4.0).contains(&from_s) && (10.0..11.5).contains(&to_s), "{from_s} {to_s}");
    assert!(run.stderr.contains("cut 0.0–"), "{}", run.stderr);
    let all = hovertone(&[&said[..], &["--from", "4", "--to", "9.5", text(&path)]].concat()).ends_with(0);
    let line = &all.json_lines()[0];
    assert_eq!((line["from_s"].as_f64(), line["to_s"].as_f64()), (Some(4.0), Some(9.5)));
    assert!(!all.stderr.contains("cut"), "{}", all.stderr);
}

#[test]
fn several_rotors_are_found_where_their_number_is_not_said() {
    let folder = Folder::new();
    let (four, one) = (folder.path("four.wav"), folder.path("one.wav"));
    let hover = steady_hover("crazyflie", RotorSpeed::from_rev_s(100.0), 6.0);
    let rotors = [98.0, 99.5, 101.2, 103.3].map(|rev_s| {
        let rotor = hovertone_sim::RotorSound::at(RotorSpeed::from_rev_s(rev_s));
        hovertone_sim::RotorSound { wander_std_share: 0.002, ..rotor }
    });
    write_hover(&four, hovertone_sim::HoverSettings { rotors: rotors.to_vec(), ..hover.clone() });
    write_hover(&one, hovertone_sim::HoverSettings { rotors: vec![rotors[0]], ..hover });
    let speed = |flags: &[&str], path: &Path| {
        let run = hovertone(&[&["speed", "--blades", "2", "--json"], flags, &[text(path)]].concat()).ends_with(0);
        run.json_lines()[0].clone()
    };
    let number = |line: &serde_json::Value, name: &str| line[name].as_f64().unwrap();
    let found = speed(&[], &four);
    assert_eq!(found["method"], "separated");
    assert_eq!(found["rotors"].as_array().unwrap().len(), 4);
    assert!((number(&found, "speed_rev_s") - 100.5).abs() < 0.1, "{}", found["speed_rev_s"]);
    // without the separation, the ± covers that one tone stands for all
    let mean = speed(&["--mean-only"], &four);
    assert_eq!(mean["method"], "harmonic");
    assert!(mean.get("rotors").is_none_or(serde_json::Value::is_null));
    let error = number(&mean, "speed_rev_s") - 100.5;
    assert!(error.abs() < 2.0 * number(&mean, "combined_std_uncertainty_rev_s"), "{error}");
    let single = speed(&[], &one);
    assert_eq!(single["method"], "harmonic");
    assert!(single.get("rotors").is_none_or(serde_json::Value::is_null));
}

#[test]
fn the_track_is_a_table_of_frames() {
    let folder = Folder::new();
    let (hover, track) = (folder.hover(), folder.path("track.csv"));
    hovertone(&["speed", "--blades", "2", "--track", text(&track), text(&hover)]).ends_with(0);
    let mut table = csv::Reader::from_path(&track).unwrap();
    let head: Vec<String> = table.headers().unwrap().iter().map(str::to_owned).collect();
    assert_eq!(head, ["time_s", "tone_hz", "speed_rev_s", "std_uncertainty_rev_s", "level_db"]);
    let rows: Vec<Vec<f64>> =
        table.records().map(|row| row.unwrap().iter().map(|cell| cell.parse().unwrap()).collect()).collect();
    assert!(rows.len() > 10, "{} frames", rows.len());
    assert!(rows.windows(2).all(|pair| pair[0][0] < pair[1][0]), "time goes on");
    assert!(rows.iter().all(|row| (row[1] / row[2] - 2.0).abs() < 1e-9 && row[4] < 0.0));
    hovertone(&["speed", "--blades", "2", "--track", text(&track), "--force", text(&hover), text(&hover)]).ends_with(0);
    let mut table = csv::Reader::from_path(&track).unwrap();
    assert_eq!(table.headers().unwrap().get(0), Some("file"));
    assert_eq!(table.records().count(), 2 * rows.len());
}

#[test]
fn the_same_command_gives_the_same_bytes() {
    let folder = Folder::new();
    let (hover, noise) = (folder.hover(), folder.noise());
    let arguments = ["speed", "--blades", "2", "--json", text(&hover), text(&noise), text(&hover)];
    let (first, second) = (hovertone(&arguments), hovertone(&arguments));
    assert!(first.stdout.len() > 100);
    assert_eq!((first.stdout, first.stderr), (second.stdout, second.stderr));
}

#[test]
fn a_short_part_is_told_the_length_that_is_needed_and_that_length_is_enough() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("bench.wav");
    let settings = steady_bench("crazyflie", RotorSpeed::from_rev_s(95.0), 10.0);
    write_hover(&sound, settings);
    let part = |to: &str| {
        let words = ["speed", "--blades", "2", "--rotors", "1", "--band", "180:200", "--from", "3", "--to", to];
        hovertone(&[&words[..], &[text(&sound)]].concat())
    };
    let short = part("3.2").ends_with(0);
    let needed = short.stderr.split_once("only 0.2 s of the sound are used, and a reliable ± needs ").unwrap().1;
    assert!(needed.contains("choose a longer part") && !needed.contains("--window-s"), "{}", short.stderr);
    let needed_s: f64 = needed.split_once(" s or more").unwrap().0.parse().unwrap();
    let long = part(&format!("{}", 3.0 + needed_s)).ends_with(0);
    assert!(!long.stderr.contains("needs"), "{needed_s}: {}", long.stderr);
}

/// A gear mesh can be heard up to the speed that the sample rate allows: a rate that no phone has is no advice.
#[test]
fn a_mesh_above_the_sample_rate_is_told_what_else_tells_the_speed() {
    let folder = tempfile::tempdir().unwrap();
    let noise = folder.path().join("noise.wav");
    write_noise(&noise, 4.0);
    let run = hovertone(&["speed", "--gear", "69", text(&noise)]).ends_with(3);
    for words in [
        "the tone at 69 times the rotor speed is not heard",
        " rev/s; count the blades and give --blades N too",
        "--band LOW:HIGH",
    ] {
        assert!(run.stderr.contains(words), "{words}: {}", run.stderr);
    }
    assert!(!run.stderr.contains("higher sample rate"), "{}", run.stderr);
}

/// The ± of one tone assumes how far a rotor is from their mean, also where nobody asked to separate them.
#[test]
fn the_mean_alone_says_what_its_uncertainty_assumes() {
    let folder = Folder::new();
    let path = folder.path("hover.wav");
    write_hover(&path, steady_hover("ardrone", RotorSpeed::from_rev_s(61.3), 5.0));
    let heard =
        |more: &[&str]| hovertone(&[&["speed", text(&path), "--blades", "2"], more].concat()).ends_with(0).stderr;
    for (more, hint) in [
        (&["--rotors", "4", "--mean-only"][..], "leave --mean-only or --method harmonic out"),
        (&["--rotors", "4", "--method", "maximum_trace"], "leave --method out"),
    ] {
        let said = heard(more);
        assert!(said.contains("one tone is used for all 4 rotors") && said.contains(hint), "{said}");
    }
    assert!(!heard(&["--rotors", "1"]).contains("one tone is used"));
}
