//! Which rotor is which: `hovertone speed --log` and `--spin-up`.

use crate::testkit::{hovertone, recordings, refused_with, text};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

const FLIGHT: &str = "duration_s = 6.0\nseed = 4\ntruth_rate_hz = 20.0\n[spread]\nthrust_shares = [1.05, 0.95, 1.01, 0.98]\n\
    [motor_wander]\n[sound]\nsample_rate_hz = 44100\ntone_level_db_spl = 70.0\n[[microphone]]\nposition_m = [-1.0, 0.5, 1.3]\n";

/// Flies it; the sound, and the truth as a table.
fn flown(folder: &Path) -> (PathBuf, csv::StringRecord, Vec<csv::StringRecord>) {
    let scenario = folder.join("scenario.toml");
    fs::write(&scenario, FLIGHT).unwrap();
    let output = folder.join("flown");
    hovertone(&["simulate", text(&scenario), "-o", text(&output)]).ends_with(0);
    let mut table = csv::Reader::from_path(output.join("truth.csv")).unwrap();
    let head = table.headers().unwrap().clone();
    (output.join("sound.wav"), head, table.records().map(Result::unwrap).collect())
}

/// Some columns of the truth under other names, on a clock that is 31.4 s ahead.
fn write_log(path: &Path, head: &csv::StringRecord, rows: &[csv::StringRecord], columns: &[(&str, &str, f64)]) {
    let mut log = "time_s".to_owned();
    columns.iter().for_each(|(_, name, _)| log += &format!(",{name}"));
    for row in rows {
        let number = |name: &str| row[head.iter().position(|known| known == name).unwrap()].parse::<f64>().unwrap();
        log += &format!("\n{}", number("time_s") + 31.4);
        columns.iter().for_each(|(column, _, factor)| log += &format!(",{}", factor * number(column)));
    }
    fs::write(path, log).unwrap();
}

fn names(line: &Value) -> Vec<&str> {
    line["rotors"].as_array().unwrap().iter().map(|rotor| rotor["label"]["name"].as_str().unwrap_or("-")).collect()
}

#[test]
fn rotors_are_named_by_rates_and_by_speeds_and_by_neither() {
    let folder = tempfile::tempdir().unwrap();
    let (sound, head, rows) = flown(folder.path());
    let (gyro, speeds, track) =
        (folder.path().join("gyro.csv"), folder.path().join("speeds.csv"), folder.path().join("track.csv"));
    // PX4's axes: y to the right, z down
    let rates = [
        ("roll_rate_rad_s", "gyro_x_deg_s", 57.295_779_5),
        ("pitch_rate_rad_s", "gyro_y_deg_s", -57.295_779_5),
        ("yaw_rate_rad_s", "gyro_z_deg_s", -57.295_779_5),
    ];
    write_log(&gyro, &head, &rows, &rates);
    let shafts: Vec<(String, String)> =
        (1..=4).map(|number| (format!("speed_{number}_rad_s"), format!("motor{number}_speed_rad_s"))).collect();
    let shafts: Vec<(&str, &str, f64)> = shafts.iter().map(|(from, to)| (from.as_str(), to.as_str(), 1.0)).collect();
    write_log(&speeds, &head, &rows, &shafts);
    let mean = |rotor: usize| -> f64 {
        let column = head.iter().position(|known| known == format!("speed_{}_rad_s", rotor + 1)).unwrap();
        rows.iter().map(|row| row[column].parse::<f64>().unwrap()).sum()
    };
    let mut rotors = [0, 1, 2, 3];
    rotors.sort_by(|&a, &b| mean(b).total_cmp(&mean(a)));
    assert_ne!(rotors, [0, 1, 2, 3]);
    let speed = ["speed", "--vehicle", "ardrone", "--json", text(&sound)];
    let run = |more: &[&str], code: i32| hovertone(&[&speed[..], more].concat()).ends_with(code).json_lines().remove(0);
    let line = run(&["--log", text(&gyro), "--log-axes", "frd"], 0);
    assert_eq!(names(&line), rotors.map(|rotor| ["front left", "rear left", "rear right", "front right"][rotor]));
    assert_eq!(line["labels"]["source"], "body_rates");
    let offset_s = line["labels"]["offset_s"].as_f64().unwrap();
    // a step of the log, and three standard uncertainties
    let allowed_s = 0.05 + 3.0 * line["labels"]["offset_std_uncertainty_s"].as_f64().unwrap();
    assert!((offset_s + 31.4).abs() < allowed_s, "{}", line["labels"]);
    let line = run(&["--log", text(&speeds), "--track", text(&track)], 0);
    assert_eq!(names(&line), rotors.map(|rotor| ["motor 1", "motor 2", "motor 3", "motor 4"][rotor]));
    let track = fs::read_to_string(&track).unwrap();
    assert!(
        track.starts_with("time_s,tone_hz,speed_rev_s,std_uncertainty_rev_s,level_db,rotor,label\n"),
        "{track:.200}"
    );
    assert!(track.lines().nth(1).unwrap().ends_with(&format!(",1,motor {}", rotors[0] + 1)));
    // what does not reach over the hover says nothing, and is said
    let nothing = run(&["--log", text(&speeds), "--log-offset-s=-5:5"], 3);
    assert_eq!(names(&nothing), ["-"; 4]);
    assert!(nothing["warnings"].to_string().contains("covers too little time"), "{}", nothing["warnings"]);
    let without = run(&["--condition"], 0);
    assert!(
        without["labels"]["source"].is_null()
            && without["labels"]["reason"].to_string().contains("which rotor of the vehicle")
    );
    assert!(without["rotors"][0]["label"].is_null() && without["rotors"][2]["condition"]["lines"].is_array());
    let table = hovertone(&["speed", "--vehicle", "ardrone", "--condition", text(&sound)]).ends_with(0).stdout;
    assert!(table.contains("rotor 1, the fastest") && table.contains("once per turn"), "{table}");
}

/// The body rates of the truth as PX4 logs them, y to the right and z down, on a clock that is 31.4 s ahead.
fn ulog_of_rates(head: &csv::StringRecord, rows: &[csv::StringRecord]) -> Vec<u8> {
    let message = |kind: u8, content: &[u8]| [&(content.len() as u16).to_le_bytes()[..], &[kind], content].concat();
    let mut log = [&b"ULog\x01\x12\x35\x01"[..], &[0; 8]].concat();
    log.extend(message(b'F', b"sensor_combined:uint64_t timestamp;float[3] gyro_rad;"));
    log.extend(message(b'A', b"\0\0\0sensor_combined"));
    for row in rows {
        let number = |name: &str| row[head.iter().position(|known| known == name).unwrap()].parse::<f64>().unwrap();
        let mut content = vec![0; 2];
        content.extend(((1e6 * (number("time_s") + 31.4)).round() as u64).to_le_bytes());
        for (name, sign) in [("roll_rate_rad_s", 1.0), ("pitch_rate_rad_s", -1.0), ("yaw_rate_rad_s", -1.0)] {
            content.extend(((sign * number(name)) as f32).to_le_bytes());
        }
        log.extend(message(b'D', &content));
    }
    log
}

/// What is read of a damaged log names the rotors, and the exit code says that a part of it is missing.
#[test]
fn a_damaged_log_names_the_rotors_and_ends_with_3() {
    let folder = tempfile::tempdir().unwrap();
    let (sound, head, rows) = flown(folder.path());
    let (log, whole) = (folder.path().join("flight.ulg"), ulog_of_rates(&head, &rows));
    let speed = ["speed", "--vehicle", "ardrone", "--json", text(&sound), "--log", text(&log)];
    // the last message is cut
    for (bytes, code) in [(&whole[..], 0), (&whole[..whole.len() - 5], 3)] {
        fs::write(&log, bytes).unwrap();
        let line = hovertone(&speed).ends_with(code).json_lines().remove(0);
        assert!(names(&line).len() == 4 && !names(&line).contains(&"-"), "{line}");
        assert_eq!(line["warnings"].to_string().contains("the log breaks off"), code == 3, "{}", line["warnings"]);
    }
}

/// Only a CSV of body rates needs --log-axes, so only there the axes may be wrong.
#[test]
fn a_log_of_another_flight_asks_for_its_axes_only_where_a_flag_gives_them() {
    let folder = tempfile::tempdir().unwrap();
    let (sound, ..) = flown(folder.path());
    let log = folder.path().join("log.csv");
    let warned = |names: &[&str], size: f64, level: f64, more: &[&str]| {
        let row = |row: u32| {
            let value = |at: usize| level + size * (0.9 * f64::from(row) * (at + 1) as f64).sin();
            let cells: String = (0..names.len()).map(|at| format!(",{}", value(at))).collect();
            format!("\n{}{cells}", 0.05 * f64::from(row))
        };
        let rows: String = (0..120).map(row).collect();
        fs::write(&log, format!("time_s,{}{rows}", names.join(","))).unwrap();
        let run = ["speed", "--vehicle", "ardrone", text(&sound), "--log", text(&log)];
        hovertone(&[&run[..], more].concat()).ends_with(3).stderr
    };
    let speeds = ["motor1_rad_s", "motor2_rad_s", "motor3_rad_s", "motor4_rad_s"];
    let rates = ["gyro_x_rad_s", "gyro_y_rad_s", "gyro_z_rad_s"];
    let said = "the log does not fit the speeds of the rotors";
    let of_speeds = warned(&speeds, 4.0, 377.0, &[]);
    assert!(of_speeds.contains(said) && !of_speeds.contains("--log-axes"), "{of_speeds}");
    let of_rates = warned(&rates, 0.5, 0.0, &["--log-axes", "flu"]);
    assert!(of_rates.contains(said) && of_rates.contains("direction of the axes (--log-axes)"), "{of_rates}");
}

#[test]
fn a_log_that_cannot_be_used_is_refused_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("log.csv");
    let refused = |content: &str, more: &[&str], words: &[&str]| {
        fs::write(&log, content).unwrap();
        refused_with(&[&["speed", "a.wav", "--log", text(&log)], more].concat(), words);
    };
    let rates = "time_s,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s\n0,0,0,0\n1,0,0,0\n";
    refused(rates, &["--vehicle", "ardrone"], &["direction of their axes", "--log-axes"]);
    refused(rates, &["--rotors", "4", "--blades", "2", "--log-axes", "flu"], &["places of the rotors", "--layout"]);
    refused(rates, &["--blades", "2"], &["needs the number of rotors", "--rotors 4"]);
    refused(rates, &["b.wav", "--vehicle", "ardrone"], &["2 recordings", "the same flight"]);
    refused("time,motor1_pwm\n", &["--vehicle", "ardrone"], &["the time and its unit", "log.csv"]);
    refused("time_s,motor1_pwm\n0,x\n", &["--vehicle", "ardrone"], &["line 2", "\"x\""]);
    let missing = hovertone(&["speed", "a.wav", "--vehicle", "ardrone", "--log", "missing.csv"]).ends_with(1);
    assert!(missing.stderr.contains("missing.csv"), "{}", missing.stderr);
}

#[test]
fn a_ulog_is_known_by_its_first_bytes_and_says_its_axes_itself() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("log.csv");
    let speed = ["speed", "a.wav", "--vehicle", "ardrone", "--log", text(&log)];
    let no_log = |content: &[u8], words: &str| {
        fs::write(&log, content).unwrap();
        let said = hovertone(&speed).ends_with(1).stderr;
        assert!(said.contains(words) && said.contains("log.csv"), "{words}:\n{said}");
    };
    let message = |kind: u8, content: &[u8]| [&(content.len() as u16).to_le_bytes()[..], &[kind], content].concat();
    let head = [&b"ULog\x01\x12\x35\x01"[..], &[0; 8]].concat();
    let format = message(b'F', b"sensor_combined:uint64_t timestamp;float[3] gyro_rad;");
    let rates = [head.clone(), format, message(b'A', b"\0\0\0sensor_combined"), message(b'D', &[0; 22])].concat();
    no_log(&head, "before its data");
    no_log(b"\xa3\x95\x80\0FMT", "this ArduPilot DataFlash log ends");
    no_log(b"PK\x03\x04\0\0", "neither a CSV nor a log of PX4");
    fs::write(&log, &rates).unwrap();
    let with_axes = [&speed[..], &["--log-axes", "flu"]].concat();
    refused_with(&with_axes, &["x forward, y right and z down", "leave --log-axes out"]);
    // without --log-axes it is the recording that is missing
    let run = hovertone(&speed).ends_with(1);
    assert!(run.stderr.contains("a.wav"), "{}", run.stderr);
}

#[test]
fn an_order_of_starts_names_every_rotor_once() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |more: &[&str], words: &[&str]| {
        let run = hovertone(&[&["speed", "a.wav", "--vehicle", "ardrone"], more].concat()).ends_with(2);
        assert!(run.stdout.is_empty(), "{}", run.stderr);
        words.iter().for_each(|word| assert!(run.stderr.contains(word), "{word:?}:\n{}", run.stderr));
    };
    refused(&["--spin-up", "front-left,rear-left,rear-right"], &["exactly once", "front-right"]);
    refused(&["--spin-up", "front-left,rear-left,rear-right,nose"], &["\"nose\"", "hint:", "front-left,rear-left"]);
    refused(&["--spin-up", "1,2,3,4", "--log", "a.csv"], &["cannot be used with"]);
    refused(&["b.wav", "--spin-up", "1,2,3,4"], &["2 recordings", "the same flight"]);
    // a hover that is there from the first second on has no starts
    let (sound, ..) = flown(folder.path());
    let run = ["speed", "--vehicle", "ardrone", "--json", "--spin-up", "1,2,3,4", text(&sound)];
    let line = hovertone(&run).ends_with(3).json_lines().remove(0);
    assert!(line["warnings"].to_string().contains("--spin-up changes nothing"), "{}", line["warnings"]);
    assert_eq!(line["labels"]["source"], "spin_up");
    assert!(line["labels"]["reason"].is_string() && line["rotors"][0]["label"].is_null(), "{}", line["labels"]);
}

/// Where the shaft speed is ambiguous, there is nothing to name, and one line says so.
#[test]
fn without_a_settled_speed_no_rotor_is_named() {
    let Some(real) = recordings("small-multirotors") else { return };
    let folder = tempfile::tempdir().unwrap();
    let (log, sound) = (folder.path().join("log.csv"), real.join("DRONE_002.wav"));
    fs::write(&log, "time_s,motor1_pwm,motor2_pwm,motor3_pwm,motor4_pwm\n0,1,2,3,4\n9,2,3,4,1\n").unwrap();
    for more in [["--log", text(&log)], ["--spin-up", "1,2,3,4"]] {
        let run = hovertone(&[&["speed", text(&sound), "--rotors", "4"], &more[..]].concat()).ends_with(3);
        assert!(run.stdout.contains("possible speeds, each with its plausibility:"), "{}", run.stdout);
        let said = "warning: no rotor gets a name, because several shaft speeds are possible (hint: ";
        assert_eq!(run.stderr.matches(said).count(), 1, "{}", run.stderr);
    }
}
