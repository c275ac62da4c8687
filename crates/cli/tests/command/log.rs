//! `hovertone log`: what a log holds, and its signals as CSV.

use crate::testkit::{hovertone, recordings, refused_with, text, write_noise};
use serde_json::Value;
use std::fs;
use std::path::Path;

const CSV: &str = "time_s,rotor1_rpm,motor1_pwm,note\n0,600,10,a\n0.5,660,11,b\n1,720,12,c\n";

fn written(folder: &Path, name: &str, content: impl AsRef<[u8]>) -> String {
    let path = folder.join(name);
    fs::write(&path, content).unwrap();
    text(&path).to_owned()
}

#[test]
fn a_log_is_listed_for_people_and_for_programs() {
    let folder = tempfile::tempdir().unwrap();
    let log = written(folder.path(), "log.csv", CSV);
    let run = hovertone(&["log", &log]).ends_with(0);
    for words in ["CSV, 1.0 s, 1 table, 3 signals", "table.rotor1_rpm", "rotor speed", "10.00", "12.00", "rev/s"] {
        assert!(run.stdout.contains(words), "{words}:\n{}", run.stdout);
    }
    assert!(run.stderr.is_empty() && !run.stdout.contains("note"), "{}", run.stdout);
    let names = hovertone(&["log", &log, "--signals"]).ends_with(0).stdout;
    for line in ["\n  table.rotor1_rpm  (rev/s)\n", "\n  table.motor1_pwm\n", "\n  table.note\n"] {
        assert!(names.contains(line), "{line}: {names}");
    }
    // each printed name can be pasted
    let (out, pasted) =
        (folder.path().join("out.csv"), names.lines().filter_map(|line| line.trim().split("  ").next()));
    let mut pasted = pasted.filter(|name| name.starts_with("table.")).peekable();
    assert!(pasted.peek().is_some(), "{names}");
    for name in pasted {
        hovertone(&["log", &log, "--signal", name, "-o", text(&out), "--force"]).ends_with(0);
    }
    let stand = written(folder.path(), "stand.csv", "throttle_percent,rpm,thrust_g\n10,3000,120\n20,4000,220\n");
    let of_stand = hovertone(&["log", &stand]).ends_with(2).stderr;
    assert!(of_stand.contains("without times is no log: give it to `hovertone fit`"), "{of_stand}");
    refused_with(
        &["log", &log, "--signal", "rotor1_rpm", "-o", text(&out), "--force"],
        &["no signal \"rotor1_rpm\"", "write --signal table.rotor1_rpm"],
    );
    let line = hovertone(&["log", "--json", &log]).ends_with(0).json_lines().remove(0);
    assert_eq!(
        (&line["format"], &line["has_rotor_speed"], &line["lost_bytes"]),
        (&"CSV".into(), &true.into(), &0.into())
    );
    let table = &line["tables"][0];
    assert_eq!((&table["rate_hz"], &table["from_s"], &table["to_s"]), (&2.0.into(), &0.0.into(), &1.0.into()));
    let speed = &table["signals"][0];
    assert_eq!(
        (&speed["unit"], &speed["about"], &speed["number"]),
        (&"rev/s".into(), &"rotor speed".into(), &1.into())
    );
    assert_eq!((&speed["low"], &speed["high"]), (&10.0.into(), &12.0.into()));
    let other = written(folder.path(), "other.csv", "time_s,x_m\n0,1\n1,2\n");
    assert!(hovertone(&["log", &other]).ends_with(0).stdout.contains("no rotor speed in this log"));
    // a time of another kind is a signal
    let settling = written(folder.path(), "settling.csv", "time_s,settling time (s)\n0,0.1\n1,0.2\n");
    let names = hovertone(&["log", &settling, "--signals"]).ends_with(0).stdout;
    assert!(names.contains("table.settling time (s)  (s)"), "{names}");
    // a line of the list can be pasted as it is
    let pasted = ["log", &settling, "--signal", "table.settling time (s)  (s)", "-o", text(&out), "--force"];
    let run = hovertone(&pasted).ends_with(0);
    assert!(run.stderr.ends_with(", 2 rows\n"), "{}", run.stderr);
    let single = written(folder.path(), "single.csv", "time_s,n\n0,1\n");
    let run = hovertone(&["log", &single, "--signal", "table.n", "-o", text(&out), "--force"]).ends_with(0);
    assert!(run.stderr.ends_with(", 1 row\n"), "{}", run.stderr);
}

#[test]
fn signals_become_a_csv_that_is_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let log = written(folder.path(), "log.csv", "Zeit;Drehzahl;n\n0;600;1\n500;;2\n1000;720;3\n");
    let out = folder.path().join("speeds.csv");
    let named = ["--column", "Zeit=time_ms", "--column", "Drehzahl=rotor1_rpm"];
    let written = ["log", &log, "--signal", "table.rotor1_rpm", "-o", text(&out)];
    let run = hovertone(&[&written[..], &named].concat()).ends_with(0);
    assert!(run.stderr.contains("written: ") && run.stderr.contains("3 rows"), "{}", run.stderr);
    assert_eq!(fs::read_to_string(&out).unwrap(), "time_s,rotor1_speed_rev_s\n0,10\n0.5,\n1,12\n");
    let line: Value = hovertone(&["log", "--json", text(&out)]).ends_with(0).json_lines().remove(0);
    assert_eq!(line["tables"][0]["signals"][0]["high"], 12.0);
    // nothing is replaced, and an unknown signal leaves nothing behind
    refused_with(&[&written[..], &named].concat(), &["exists already"]);
    fs::remove_file(&out).unwrap();
    let unknown = ["log", &log, "--signal", "table.speed", "-o", text(&out)];
    refused_with(&[&unknown[..], &named].concat(), &["no signal \"table.speed\""]);
    assert!(!out.exists());
}

/// As `blackbox_decode` writes a log of Betaflight: eRPM in hundreds of electrical rpm, and motors that count from 0.
const BLACKBOX: &str = "loopIteration, time (us), motor[0], motor[1], eRPM[0], eRPM[1]\n\
    0, 5000000, 1720, 1730, 420, 427\n1, 5100000, 1720, 1730, 420, 434\n2, 5200000, 1725, 1735, 427, 434\n";

/// The electrical speeds of a CSV become rotor speeds by the names that the warning proposes.
#[test]
fn electrical_speeds_ask_for_the_number_of_poles() {
    let folder = tempfile::tempdir().unwrap();
    let log = written(folder.path(), "blackbox.csv", BLACKBOX);
    let run = hovertone(&["log", &log]).ends_with(0);
    for words in ["no rotor speed in this log", "electrical speed", "electrical rpm / 100"] {
        assert!(run.stdout.contains(words), "{words}:\n{}", run.stdout);
    }
    assert!(run.stderr.contains("columns eRPM[0] to eRPM[1] have electrical speeds"), "{}", run.stderr);
    let names = ["eRPM[0]=rotor1_erpm100_14_poles", "eRPM[1]=rotor2_erpm100_14_poles"];
    let proposed = format!("--column '{}' --column '{}'", names[0], names[1]);
    let columns = ["--column", names[0], "--column", names[1]];
    for command in [&["log", &log][..], &["motor", &log], &["verify", "hover.wav", &log, "--blades", "2"]] {
        let code = if command[0] == "log" { 0 } else { 1 };
        let stderr = hovertone(command).ends_with(code).stderr;
        assert!(stderr.contains(&format!("run: hovertone {}", command[0])) && stderr.contains(&proposed), "{stderr}");
    }
    let run = hovertone(&[&["log", "--json", &log], &columns[..]].concat()).ends_with(0);
    assert!(run.stderr.is_empty(), "{}", run.stderr);
    let line = run.json_lines().remove(0);
    let signals = line["tables"][0]["signals"].as_array().unwrap();
    let speed = signals.iter().find(|signal| signal["about"] == "rotor speed" && signal["number"] == 2).unwrap();
    // 43 400 electrical rpm of 7 pole pairs are 6200 rpm
    assert!((speed["high"].as_f64().unwrap() - 6200.0 / 60.0).abs() < 1e-9, "{speed}");
    let commands = signals.iter().filter(|signal| signal["about"] == "command");
    assert_eq!(commands.map(|signal| signal["number"].as_u64().unwrap()).collect::<Vec<_>>(), [1, 2]);
    // of another program, the unit is not known
    let other = written(folder.path(), "other.csv", "time_s,erpm_1\n0,42000\n1,43000\n");
    let stderr = hovertone(&["log", &other]).ends_with(0).stderr;
    assert!(stderr.contains("erpm_1=rotor1_erpm_14_poles") && stderr.contains("hundreds of rpm"), "{stderr}");
}

/// Two columns with one meaning, where --column made them so.
#[test]
fn a_name_that_another_column_has_leads_to_names_for_all() {
    let folder = tempfile::tempdir().unwrap();
    let log = written(folder.path(), "log.csv", "time_s,rpm[0],rpm[1]\n0,600,600\n1,600,600\n");
    let named = ["log", &log, "--column", "rpm[0]=rotor1_rpm"];
    refused_with(&named, &["with the name rotor1_rpm from --column", "--column 'rpm[1]=rotor2_rpm'"]);
    hovertone(&[&named[..], &["--column", "rpm[1]=rotor2_rpm"]].concat()).ends_with(0);
    let twice = written(folder.path(), "twice.csv", "time_s,motor1_rpm,rotor1_rpm\n0,600,600\n1,600,600\n");
    refused_with(&["log", &twice], &["remove one of the columns"]);
}

#[test]
fn what_has_no_meaning_is_refused_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let log = written(folder.path(), "log.csv", CSV);
    let archive = written(folder.path(), "log.zip", b"PK\x03\x04\0\0");
    let columns = ["log", &log, "--column"];
    for (more, words) in [
        ("Zeit=time_s", ["there is no column \"Zeit\"", "time_s, rotor1_rpm"]),
        ("time_s=speed", ["\"speed\" is no column name that hovertone knows", "rotor1_rpm"]),
        ("time_s", ["--column", "Drehzahl=rotor1_rpm"]),
    ] {
        refused_with(&[&columns[..], &[more]].concat(), &words);
    }
    let other = hovertone(&["log", &archive]).ends_with(1).stderr;
    assert!(other.contains("neither a CSV nor a log of PX4") && other.contains("log.zip"), "{other}");
    let sound = folder.path().join("hover.wav");
    write_noise(&sound, 1.0);
    let recording = hovertone(&["log", text(&sound)]).ends_with(1).stderr;
    assert!(recording.contains("this is a recording, but a log is needed"), "{recording}");
    refused_with(&["log", &log, &log, "--signal", "table", "-o", "x.csv"], &["2 logs are given", "one log at a time"]);
    refused_with(&["log", &log, "--signal", "table"], &["--signal needs a file for the signal too (-o FILE.csv)"]);
}

#[test]
fn real_logs_say_whether_a_rotor_turns() {
    let Some(logs) = recordings("logs") else { return };
    let listed = |name: &str| hovertone(&["log", text(&logs.join(name))]).ends_with(0).stdout;
    assert!(listed("px4_sample_small.ulg").contains("no rotor speed in this log"));
    let with_escs = listed("px4_esc_status.ulg");
    assert!(with_escs.contains("esc_status.esc[0–3].esc_rpm") && with_escs.contains("3.24"), "{with_escs}");
    assert!(listed("rcbenchmark_command_steps.csv").contains("RCbenchmark CSV, 14.2 s"));
}

#[test]
fn a_damaged_log_gives_what_it_holds_and_says_what_is_lost() {
    let Some(logs) = recordings("logs") else { return };
    let mut bytes = fs::read(logs.join("px4_esc_status.ulg")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let cut = written(folder.path(), "cut.ulg", &bytes[..400_000]);
    let run = hovertone(&["log", &cut]).ends_with(3);
    assert!(run.stdout.contains("esc_status") && run.stderr.contains("the log breaks off"), "{}", run.stderr);
    bytes[300_000..302_000].fill(0xff);
    let damaged = written(folder.path(), "damaged.ulg", &bytes);
    let run = hovertone(&["log", "--json", &damaged]).ends_with(3);
    let line = &run.json_lines()[0];
    let (lost, place) = (line["lost_bytes"].as_u64().unwrap(), &line["lost_places"][0]);
    assert!((2000..4000).contains(&lost) && line["lost_place_count"] == 1, "{lost}");
    assert!(place["from_byte"].as_u64().unwrap() <= 300_000 && place["after_s"].as_f64().unwrap() > 5080.0);
    assert!(
        run.stderr.contains("the log is damaged: ") && run.stderr.contains("hint: hovertone used"),
        "{}",
        run.stderr
    );
    // a second download can be the same
    assert!(run.stderr.contains("If the new copy has the same fault, log another flight"), "{}", run.stderr);
}
