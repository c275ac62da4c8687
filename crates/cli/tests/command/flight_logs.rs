//! Logs in `identify`: names of rotors, order check and constants of motors, on the page and in the results.

use crate::report::holds_to_its_schema;
use crate::testkit::{flown_hover, hovertone, text};
use crate::verify::{OFFSET_S, write_log};
use hovertone_sim::scenario::ScenarioFile;
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Time constant of the motors in the steps before the flight.
const TIME_CONSTANT_S: f64 = 0.06;

/// A flown hover with its logs.
struct Flown {
    file: ScenarioFile,
    sound: PathBuf,
}

fn flown(folder: &Path) -> Flown {
    let (file, _) = flown_hover(folder, 5, 12.0, 0.02);
    let files = fs::read_dir(folder.join("flown")).unwrap().map(|entry| entry.unwrap().path());
    let sound = files.into_iter().find(|path| path.extension().is_some_and(|ending| ending == "wav")).unwrap();
    write_log(&folder.join("flown"), &folder.join("right.csv"), 1, 1.0);
    write_log(&folder.join("flown"), &folder.join("half.csv"), 10, 0.5);
    Flown { file, sound }
}

/// Steps on the ground before the flight, 100 rows per second, in front of the rows of a log.
fn put_steps_before(log: &Path) {
    let flight = fs::read_to_string(log).unwrap();
    let (head, rows) = flight.split_once('\n').unwrap();
    let mut whole = format!("{head}\n");
    let mut speed_rpm = 3000.0;
    for row in 0..1000 {
        let wanted_rpm = if (row / 125) % 2 == 0 { 3000.0 } else { 4200.0 };
        let time_s = -12.0 + 0.01 * f64::from(row);
        write!(whole, "{time_s:.3}").unwrap();
        (0..4).for_each(|rotor| write!(whole, ",{:.1}", speed_rpm + f64::from(rotor)).unwrap());
        whole += "\n";
        speed_rpm += (wanted_rpm - speed_rpm) * (1.0 - (-0.01 / TIME_CONSTANT_S).exp());
    }
    fs::write(log, whole + rows).unwrap();
}

/// An experiment of the flight; `recording` is its entry in the list of recordings.
fn experiment(folder: &Path, flown: &Flown, recording: &str) -> String {
    let path = folder.join("experiment.toml");
    let preset = &flown.file.vehicle.preset;
    let content = format!("[vehicle]\npreset = \"{preset}\"\n[[load]]\nname = \"bare\"\nrecordings = [{recording}]\n");
    fs::write(&path, content).unwrap();
    text(&path).to_owned()
}

fn with_log(sound: &Path, log: &str) -> String {
    format!("{{ file = \"flown/{}\", log = \"{log}\" }}", sound.file_name().unwrap().to_str().unwrap())
}

#[test]
fn the_log_of_a_flight_names_rotors_checks_the_order_and_tells_the_motors() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path();
    let flown = flown(folder);
    put_steps_before(&folder.join("right.csv"));
    let file = experiment(folder, &flown, &with_log(&flown.sound, "right.csv"));
    let out = folder.join("out");
    let run = hovertone(&["identify", &file, "-v", "-o", text(&out)]).ends_with(0);
    for words in ["Speed check: sound against flight log", "passed", "motor 1", "time constant up"] {
        assert!(run.stdout.contains(words), "{words}: {}", run.stdout);
    }
    assert!(run.stdout.contains("\nthe speeds in right.csv fit the sound\n"), "{}", run.stdout);
    for words in ["do not fit the sound", "is of the same flight", "was not compared"] {
        assert!(!run.stdout.contains(words) && !run.stderr.contains(words), "{words}: {}", run.stderr);
    }
    let results: Value = serde_json::from_str(&fs::read_to_string(out.join("results.json")).unwrap()).unwrap();
    holds_to_its_schema(&results, &fs::read_to_string(out.join("results.schema.json")).unwrap());
    let log = &results["inputs"][0]["log"];
    assert_eq!((log["order_check"].as_str(), log["file"].as_str()), (Some("passed"), Some("right.csv")), "{log}");
    assert_eq!(log["sha256"].as_str().unwrap().len(), 64);
    assert!((log["offset_s"].as_f64().unwrap() - OFFSET_S).abs() < 0.05, "{log}");
    let rotors = log["rotors"].as_array().unwrap();
    assert!(rotors.len() >= 3, "{log}");
    for rotor in rotors {
        assert!(rotor["bias_rev_s"].as_f64().unwrap().abs() < 0.1, "{rotor}");
        assert!(rotor["probability"].as_f64().is_some_and(|probability| probability > 0.9), "{log}");
    }
    let motors = log["motors"].as_array().unwrap();
    assert_eq!(motors.len(), 4);
    for motor in motors {
        let up_s = motor["time_constant_up_s"]["value"].as_f64().unwrap();
        assert!((up_s / TIME_CONSTANT_S - 1.0).abs() < 0.03, "{motor}");
    }
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    for part in ["href=\"#logs\"", "<section id=\"logs\">", "data-name=\"logs-3\"", "right.csv"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(fs::read_to_string(out.join("tables.md")).unwrap().contains("Heard rotors and the motors of the log"));
}

/// The speeds of a CSV as PX4 logs them.
fn ulog_of(table: &Path) -> Vec<u8> {
    let message = |kind: u8, content: &[u8]| [&(content.len() as u16).to_le_bytes()[..], &[kind], content].concat();
    let mut log = [&b"ULog\x01\x12\x35\x01"[..], &[0; 8]].concat();
    log.extend(message(b'F', b"esc_report:int32_t esc_rpm;"));
    log.extend(message(b'F', b"esc_status:uint64_t timestamp;esc_report[4] esc;"));
    log.extend(message(b'A', b"\0\0\0esc_status"));
    for row in csv::Reader::from_path(table).unwrap().records() {
        let row = row.unwrap();
        let mut content = vec![0; 2];
        content.extend(((1e6 * row[0].parse::<f64>().unwrap()).round() as u64).to_le_bytes());
        row.iter().skip(1).for_each(|rpm| content.extend(rpm.parse::<i32>().unwrap().to_le_bytes()));
        log.extend(message(b'D', &content));
    }
    log
}

/// What is read of a damaged log is compared, and the exit code says that a part of it is missing.
#[test]
fn a_damaged_log_is_compared_and_ends_with_3() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path();
    let flown = flown(folder);
    let whole = ulog_of(&folder.join("right.csv"));
    let file = experiment(folder, &flown, &with_log(&flown.sound, "flight.ulg"));
    // the last message is cut
    for (bytes, code) in [(&whole[..], 0), (&whole[..whole.len() - 5], 3)] {
        fs::write(folder.join("flight.ulg"), bytes).unwrap();
        let run = hovertone(&["identify", &file]).ends_with(code);
        assert!(run.stdout.contains("\nthe speeds in flight.ulg fit the sound\n"), "{}", run.stdout);
        assert_eq!(run.stderr.contains("flight.ulg: the log breaks off"), code == 3, "{}", run.stderr);
    }
}

#[test]
fn a_failed_order_check_is_a_warning_on_top_and_in_the_verdict() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path();
    let flown = flown(folder);
    let file = experiment(folder, &flown, &with_log(&flown.sound, "half.csv"));
    let out = folder.join("out");
    let run = hovertone(&["identify", &file, "-o", text(&out)]).ends_with(3);
    let failed = "the speeds in half.csv do not fit the sound: the heard speeds are 2.00 times the logged speeds";
    assert!(run.stderr.contains(failed), "{}", run.stderr);
    assert!(run.stdout.contains("\nthe speeds in half.csv do not fit the sound\n"), "{}", run.stdout);
    assert!(fs::read_to_string(out.join("report.html")).unwrap().contains(failed));

    // a log of another vehicle is said to be of no use
    let motors: String = (1..=8).map(|motor| format!(",motor{motor}_pwm")).collect();
    let rows = |time_s: i32| format!("{time_s}{}\n", format!(",{}", 1500 + 10 * time_s).repeat(8));
    fs::write(folder.join("eight.csv"), format!("time_s{motors}\n{}", (0..12).map(rows).collect::<String>())).unwrap();
    let run = hovertone(&["identify", &experiment(folder, &flown, &with_log(&flown.sound, "eight.csv"))]);
    let unused = "eight.csv is not used: it has no rotor speed, and it cannot tell which rotor is which: the log has 8 motors, but the vehicle \
                  has 4 rotors";
    assert!(run.stderr.contains(unused), "{}", run.stderr);

    // electrical speeds name the rotors, but are not compared
    let half = fs::read_to_string(folder.join("half.csv")).unwrap();
    fs::write(folder.join("erpm.csv"), half.replace("_rpm", "_erpm")).unwrap();
    let file = experiment(folder, &flown, &with_log(&flown.sound, "erpm.csv"));
    let run = hovertone(&["identify", &file, "-o", text(&folder.join("electrical"))]);
    let said =
        "the sound was not compared with erpm.csv: the columns rotor1_erpm to rotor4_erpm have electrical speeds";
    assert!(run.stderr.contains(said), "{}", run.stderr);
    assert!(run.stderr.contains("write rotor1_erpm_14_poles in place of rotor1_erpm"), "{}", run.stderr);
    let results: Value =
        serde_json::from_str(&fs::read_to_string(folder.join("electrical/results.json")).unwrap()).unwrap();
    let log = &results["inputs"][0]["log"];
    assert!(log["order_check"].is_null() && log["rotors"][0]["motor"].is_string(), "{log}");

    // without a log nothing of it is said
    let name = format!("\"flown/{}\"", flown.sound.file_name().unwrap().to_str().unwrap());
    let run = hovertone(&["identify", &experiment(folder, &flown, &name), "-v", "-o", text(&folder.join("plain"))]);
    let page = fs::read_to_string(folder.join("plain/report.html")).unwrap();
    assert!(!run.ends_with(0).stdout.contains("rder check") && !page.contains("id=\"logs\""));

    // what cannot be meant is refused before the listening
    fs::copy(&flown.sound, folder.join("flown/again.wav")).unwrap();
    let refused = |recording: &str, code: i32, words: &[&str]| {
        let run = hovertone(&["identify", &experiment(folder, &flown, recording)]).ends_with(code);
        words.iter().for_each(|words| assert!(run.stderr.contains(words), "{words}: {}", run.stderr));
    };
    refused("{ file = \"flown/*.wav\", log = \"half.csv\" }", 2, &["a log belongs to one flight", "2 recordings"]);
    refused(
        &with_log(&flown.sound, "nowhere.ulg"),
        1,
        &["the log nowhere.ulg of load \"bare\" is not there: the folder "],
    );
    let file = experiment(folder, &flown, &with_log(&flown.sound, "nowhere.ulg"));
    let run = hovertone(&["identify", &file, "--check"]).ends_with(1);
    assert!(run.stderr.contains("the log nowhere.ulg of load \"bare\" is not there: the folder "), "{}", run.stderr);
    assert!(run.stderr.contains("put the log there") && !run.stderr.contains(".wav ("), "{}", run.stderr);
    refused("{ file = \"a.wav\", lgo = \"half.csv\" }", 2, &["unknown key \"lgo\"", "did you mean \"log\""]);
    refused("{ file = \"a.wav\" }", 2, &["lacks \"log\""]);
    refused("3", 2, &["has 3 where text in quotes is needed"]);
    refused(&with_log(&flown.sound, "flown/again.wav"), 1, &["this is no log"]);
    fs::write(folder.join("rates.csv"), "time_s,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s\n0,1,1,1\n1,2,2,2\n").unwrap();
    refused(&with_log(&flown.sound, "rates.csv"), 1, &["no rotor speeds and no motor commands"]);
}
