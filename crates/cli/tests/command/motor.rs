//! `hovertone motor`: time constants, dead time and static map from a log.

use crate::testkit::{hovertone, recordings, refused_with, text, write_steady_hover_and_log};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

const UP_S: f64 = 0.06;
const DOWN_S: f64 = 0.11;
const DEAD_S: f64 = 0.03;
const LEVELS: [f64; 6] = [100.0, 160.0, 120.0, 180.0, 130.0, 170.0];

/// A CSV of a motor of first order at 100 rows per second; the command steps each 1.5 s, and the speed is rounded to 1 rpm.
fn steps_csv(has_command: bool) -> String {
    let mut csv = String::from(if has_command { "time_s,motor1_pwm,rotor1_rpm\n" } else { "time_s,rotor1_rpm\n" });
    let level = |time_s: f64| LEVELS[((time_s / 1.5 + 1e-9).max(0.0) as usize).min(LEVELS.len() - 1)];
    let mut speed_rev_s = LEVELS[0];
    for row in 0..900 {
        let time_s = f64::from(row) * 0.01;
        // the dead time is three rows: the level of a row is constant since the row before it
        let target_rev_s = level(time_s - 0.01 - DEAD_S);
        let time_constant_s = if target_rev_s > speed_rev_s { UP_S } else { DOWN_S };
        speed_rev_s = target_rev_s + (speed_rev_s - target_rev_s) * (-0.01 / time_constant_s).exp();
        let command = if has_command { format!("{},", 1000.0 + 4.0 * level(time_s)) } else { String::new() };
        writeln!(csv, "{time_s:.2},{command}{:.0}", 60.0 * speed_rev_s).unwrap();
    }
    csv
}

fn written(folder: &Path, name: &str, content: impl AsRef<[u8]>) -> String {
    let path = folder.join(name);
    fs::write(&path, content).unwrap();
    text(&path).to_owned()
}

fn near(value: &Value, truth: f64, share: f64) {
    let value = value.as_f64().unwrap();
    assert!((value / truth - 1.0).abs() < share, "{value} {truth}");
}

#[test]
fn a_log_has_its_own_commands() {
    let folder = tempfile::tempdir().unwrap();
    let log = written(folder.path(), "log.csv", steps_csv(true));
    refused_with(&["motor", &log, "--commands", &log], &["--commands belongs to a recording", "leave --commands out"]);
    for flag in ["--from", "--blades", "--channel", "--rotors"] {
        refused_with(&["motor", &log, flag, "2"], &[&format!("{flag} belongs to a recording"), "hint: leave"]);
    }
    refused_with(&["motor", &log, "--vehicle", "ardrone"], &["--vehicle belongs to a recording"]);
}

#[test]
fn steps_of_a_log_tell_the_constants_of_its_motor() {
    let folder = tempfile::tempdir().unwrap();
    for has_command in [true, false] {
        let log = written(folder.path(), "log.csv", steps_csv(has_command));
        let line = hovertone(&["motor", "--json", &log]).ends_with(0).json_lines().remove(0);
        near(&line["time_constant_up_s"]["value"], UP_S, 0.01);
        near(&line["time_constant_down_s"]["value"], DOWN_S, 0.01);
        assert_eq!(line["steps"].as_array().unwrap().len(), LEVELS.len() - 1);
        assert_eq!((&line["steps"][0]["motor"], &line["steps"][0]["verdict"]), (&"motor 1".into(), &"used".into()));
        if has_command {
            near(&line["dead_time_s"]["value"], DEAD_S, 0.05);
            near(&line["motors"][0]["static_map"]["gain_rev_s"], 0.25, 0.01);
        } else {
            assert!(line["dead_time_s"].is_null() && line["motors"][0]["static_map"].is_null());
        }
        let shown = hovertone(&["motor", &log]).ends_with(0).stdout;
        for words in ["time constant", "<timeConstantUp>0.060", "<timeConstantDown>0.110", "<maxRotVelocity>1131<"] {
            assert!(shown.contains(words), "{words}\n{shown}");
        }
        assert_eq!(shown.contains("steady speed at each command: not known"), !has_command, "{shown}");
    }
}

#[test]
fn a_time_constant_that_no_step_tells_is_named_below_the_lines_of_the_simulators() {
    let folder = tempfile::tempdir().unwrap();
    // up to the end of the first step
    let rising: String = steps_csv(false).lines().take(300).map(|line| format!("{line}\n")).collect();
    let log = written(folder.path(), "log.csv", rising);
    let shown = hovertone(&["motor", &log]).ends_with(0).stdout;
    assert!(shown.contains("<timeConstantUp>") && !shown.contains("<timeConstantDown>"), "{shown}");
    assert!(shown.contains("no timeConstantDown, because this file has no step to a lower speed"), "{shown}");
}

#[test]
fn the_steps_are_drawn_with_their_curves() {
    let folder = tempfile::tempdir().unwrap();
    let log = written(folder.path(), "log.csv", steps_csv(true));
    let (svg, png) = (folder.path().join("steps.svg"), folder.path().join("steps.png"));
    for figure in [&svg, &png] {
        let run = hovertone(&["motor", &log, "--figure", text(figure)]).ends_with(0);
        assert!(run.stderr.contains("written: ") && run.stdout.contains("time constant"), "{}", run.stderr);
    }
    let drawing = fs::read_to_string(&svg).unwrap();
    let drawn = roxmltree::Document::parse(&drawing).unwrap();
    let is_step = |node: &roxmltree::Node| node.attribute("class").is_some_and(|class| class.contains("step step-"));
    assert_eq!(drawn.descendants().filter(is_step).count(), LEVELS.len() - 1);
    assert!(drawing.contains("time after the start of the step (ms)"));
    assert!(fs::read(&png).unwrap().starts_with(b"\x89PNG"));
    refused_with(&["motor", &log, "--figure", text(&svg)], &["exists already"]);
    refused_with(&["motor", &log, "--figure", "steps.pdf"], &["must end with .png or .svg", "steps.svg"]);
    refused_with(&["motor", &log, &log, "--figure", "x.svg"], &["2 files are given", "one file at a time"]);
    refused_with(&["motor", &log, "--figure", &log, "--force"], &["must end with .png"]);
    let flat = written(folder.path(), "flat.csv", "time_s,rotor1_rpm\n0,600\n0.01,600\n0.02,600\n");
    let nothing = folder.path().join("nothing.svg");
    let run = hovertone(&["motor", &flat, "--figure", text(&nothing)]).ends_with(3);
    assert!(run.stderr.contains("no figure was written") && !nothing.exists(), "{}", run.stderr);
}

#[test]
fn absurd_logs_end_with_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |of: &dyn Fn(i32) -> String| {
        (0..200).map(|row| format!("{},{}\n", f64::from(row) * 0.01, of(row))).collect::<String>()
    };
    let huge = written(folder.path(), "huge.csv", "time_s,rotor1_rpm\n0,1e300\n1,1e308\n");
    refused_with(&["motor", &huge], &["1.667e306 rev/s", "check the unit"]);
    let alternating = rows(&|row| format!("{},{row}", 6000 * (row % 2)));
    let instant = rows(&|row| format!("{},{}", if row < 100 { 6000 } else { 9000 }, if row < 100 { 1 } else { 2 }));
    let negative = rows(&|row| format!("{},{}", if row < 100 { -6000 } else { -9000 }, -(row / 50)));
    for (name, rows) in [
        ("alternating", alternating.as_str()),
        ("instant", &instant),
        ("negative", &negative),
        ("one", "0,600,1\n"),
        ("two", "0,600,1\n1,700,2\n"),
        ("same time", "0,600,1\n0,700,2\n0,800,2\n"),
        ("far", "0,600,1\n1e15,700,2\n1e16,800,2\n"),
    ] {
        let log = written(folder.path(), "log.csv", format!("time_s,rotor1_rpm,motor1_pwm\n{rows}"));
        for output in [&["motor", log.as_str()][..], &["motor", "--json", &log]] {
            let run = hovertone(output);
            assert!([0, 3].contains(&run.code), "{name}: {}", run.stderr);
            let words = format!("{}{}", run.stdout, run.stderr);
            assert!(!words.contains("panicked") && !words.contains("NaN") && !words.contains("inf"), "{name}: {words}");
        }
    }
}

#[test]
fn a_log_without_a_time_constant_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let flat: String = (0..500).map(|row| format!("{},{}\n", f64::from(row) * 0.01, 6000 + row % 3)).collect();
    let flat = written(folder.path(), "flat.csv", format!("time_s,rotor1_rpm\n{flat}"));
    assert!(hovertone(&["motor", &flat]).ends_with(3).stdout.contains("no step: "));
    let wander =
        |row: i32| 6000.0 + 600.0 * (0.9 * (f64::from(row) * 0.02).sin()).tan() + 300.0 * (f64::from(row) * 0.05).sin();
    let wander: String = (0..3000).map(|row| format!("{},{:.0}\n", f64::from(row) * 0.01, wander(row))).collect();
    let wander = written(folder.path(), "wander.csv", format!("time_s,rotor1_rpm\n{wander}"));
    let run = hovertone(&["motor", &wander]).ends_with(3);
    assert!(run.stdout.contains("no step: ") && !run.stdout.contains("time constant up"), "{}", run.stdout);
    let slow: Vec<String> = steps_csv(true).lines().step_by(30).map(str::to_owned).collect();
    let slow = written(folder.path(), "slow.csv", slow.join("\n"));
    let run = hovertone(&["motor", &slow]).ends_with(3);
    assert!(
        run.stdout.contains("too far for a time constant")
            && run.stdout.contains("gain: how the steady speed follows the command\n"),
        "{}",
        run.stdout
    );
    let commands = written(folder.path(), "commands.csv", "time_s,motor1_pwm\n0,1000\n1,1200\n");
    assert!(hovertone(&["motor", &commands]).ends_with(1).stderr.contains("no rotor speed in this log"));
    let still = written(folder.path(), "still.csv", "time_s,rotor1_rpm\n0,0\n1,0\n2,0\n");
    assert!(hovertone(&["motor", &still]).ends_with(3).stdout.contains("no rotor turns in this log"));
}

#[test]
fn what_is_no_log_is_refused_and_the_others_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let log = written(folder.path(), "log.csv", steps_csv(true));
    let sound = written(folder.path(), "sound.wav", b"RIFF\x24\0\0\0WAVEfmt \x10\0\0\0\x01\0\x01\0");
    let run = hovertone(&["motor", &sound]).ends_with(1);
    assert!(
        run.stderr.contains("neither a log nor a recording that hovertone can hear") && run.stdout.is_empty(),
        "{}",
        run.stderr
    );
    assert_eq!(run.stderr.trim_end().lines().count(), 1, "{}", run.stderr);
    let run = hovertone(&["motor", "--json", &sound, &log]).ends_with(1);
    assert_eq!(run.json_lines().len(), 1);
    let other = written(folder.path(), "other.csv", "time_s,x_m\n0,1\n1,2\n");
    refused_with(&["motor", &other], &["no header names a motor", "x_m"]);
}

#[test]
fn a_thrust_stand_tells_time_constants_and_its_saturated_step() {
    let Some(logs) = recordings("logs") else { return };
    let log = logs.join("rcbenchmark_command_steps.csv");
    let line = hovertone(&["motor", "--json", text(&log)]).ends_with(0).json_lines().remove(0);
    let steps = line["steps"].as_array().unwrap();
    assert_eq!(steps.len(), 4);
    for (step, time_constant_s) in steps.iter().zip([0.038, 0.038, 0.043]) {
        let found_s = step["time_constant_s"].as_f64().unwrap();
        assert!((found_s - time_constant_s).abs() <= 0.002, "{step}");
        // the truth is 49 to 64 ms, and the fit has an uncertainty of 1 ms and more
        let dead_time_s = step["dead_time_s"].as_f64().unwrap();
        assert!((0.047..=0.066).contains(&dead_time_s), "{step}");
    }
    assert_eq!((&steps[3]["verdict"], &steps[3]["time_constant_s"]), (&"saturated".into(), &Value::Null));
    let points = line["motors"][0]["static_map"]["points"].as_array().unwrap();
    let saturated: Vec<bool> = points.iter().map(|point| point["is_saturated"].as_bool().unwrap()).collect();
    assert_eq!(saturated, [false, false, false, false, true]);
    // the line through the speeds is below 0 at command 0: no motor has such a speed, so there is no column for it
    assert!(line["motors"][0]["static_map"]["offset_rev_s"].as_f64().unwrap() < 0.0);
    let shown = hovertone(&["motor", text(&log)]).ends_with(0).stdout;
    let gains = shown.split("C_τ").next().unwrap_or_default();
    assert!(!shown.contains("speed at command 0") && !gains.contains('−'), "{shown}");
    // the stand shows −0.0039 N m at rest, and 0.0373 N m at 348 rev/s: (0.0373 + 0.0039)/(2π 348)² = 8.6e-9
    let [constant, std] = ["", "_std"].map(|of| line[format!("torque_constant{of}_n_m_s2")].as_f64().unwrap());
    assert!((constant - 8.7e-9).abs() < 0.2e-9 && std < 0.1e-9, "{constant} {std}");
    assert!(shown.contains("C_τ of one rotor: (8."), "{shown}");
}

#[test]
fn slow_telemetry_of_a_flight_tells_the_static_map_alone() {
    let Some(logs) = recordings("logs") else { return };
    let run = hovertone(&["motor", text(&logs.join("px4_esc_status.ulg"))]).ends_with(3);
    for words in [
        "4 motors",
        "too far for a time constant",
        "gain: how the steady speed follows the command\n",
        "output 4",
        "no motor was held at two different commands for long enough, so the gains come from all log rows",
        "speed at command 0: where the fitted straight line reaches command 0; the real motor may stand still there",
        "use `hovertone greybox` (for the vehicles ardrone, ",
    ] {
        assert!(run.stdout.contains(words), "{words}\n{}", run.stdout);
    }
    assert!(!run.stdout.contains("timeConstant"));
    let run = hovertone(&["motor", text(&logs.join("px4_sample_small.ulg"))]).ends_with(1);
    assert!(run.stderr.contains("no rotor speed in this log"), "{}", run.stderr);
}

#[test]
fn a_recording_of_a_bench_tells_time_constants_and_its_beeps_are_no_rotor() {
    let Some(folder) = recordings("motor-step") else { return };
    let wav = text(&folder.join("motor_step.wav")).to_owned();
    let scratch = tempfile::tempdir().unwrap();
    let rows: String = (0..200)
        .map(|row| format!("{:.1},{}\n", f64::from(row) * 0.1, if (129..179).contains(&row) { 1400 } else { 1200 }))
        .collect();
    let commands = written(scratch.path(), "commands.csv", format!("time_s,motor1_pwm\n{rows}"));
    let said = hovertone(&["motor", "--json", &wav, "--blades", "2", "--commands", &commands]).ends_with(0);
    assert!(!said.stderr.contains("suggests"));
    let line = &said.json_lines()[0];
    assert_eq!((&line["source"], line["steps"].as_array().unwrap().len()), (&"sound".into(), 2));
    for (step, time_s, time_constant_s) in [(0, 12.935, 0.057), (1, 17.945, 0.154)] {
        let step = &line["steps"][step];
        assert!((step["time_s"].as_f64().unwrap() - time_s).abs() < 0.02, "{step}");
        assert!((step["time_constant_s"].as_f64().unwrap() - time_constant_s).abs() < 0.005, "{step}");
        assert!(step["dead_time_s"].is_null());
    }
    near(&line["motors"][0]["static_map"]["gain_rev_s"], 0.195, 0.01);
    // a guess is said, and what was said is no guess
    let guess = hovertone(&["motor", &wav]).ends_with(0).stderr;
    assert!(guess.contains("the speeds are for propellers with 2 blades, because the sound suggests"));
    let on_clock = ["motor", "--json", &wav, "--blades", "2", "--commands", &commands, "--offset", "0"];
    let dead_time_s = &hovertone(&on_clock).ends_with(0).json_lines()[0]["dead_time_s"]["value"];
    assert!((dead_time_s.as_f64().unwrap() - 0.035).abs() < 0.02, "{dead_time_s}");
    let shifted = ["motor", &wav, "--blades", "2", "--commands", &commands, "--offset", "2"];
    // what was given and is not used is missing
    let shifted = hovertone(&shifted).ends_with(3);
    assert!(!shifted.stdout.contains("saturated"), "{}", shifted.stdout);
    assert!(shifted.stderr.contains("check the offset; without --offset, hovertone uses 0.0"), "{}", shifted.stderr);
    let other =
        written(scratch.path(), "other.csv", "time_s,motor1_pwm\n0,1200\n1,1200\n2,1300\n3,1300\n4,1200\n5,1250\n");
    let other = hovertone(&["motor", &wav, "--blades", "2", "--commands", &other]).ends_with(3);
    assert!(
        other.stderr.contains("other.csv are not used: they and the heard speeds do not change"),
        "{}",
        other.stderr
    );
}

/// What to record where no step is heard stands in one place: below the text, or in the warning beside the JSON.
#[test]
fn advice_about_missing_steps_is_given_once() {
    let folder = tempfile::tempdir().unwrap();
    let (sound, _) = write_steady_hover_and_log(folder.path());
    let commands =
        written(folder.path(), "commands.csv", "time_s,motor1_pwm\n0,1200\n1,1200\n2,1300\n3,1300\n5,1200\n");
    let asked = ["motor", text(&sound), "--vehicle", "ardrone", "--commands", &commands];
    let run = hovertone(&asked).ends_with(3);
    let all = format!("{}{}", run.stderr, run.stdout);
    assert_eq!(all.matches("record a bench run in which the command changes in steps").count(), 1, "{all}");
    assert!(run.stderr.contains("commands.csv are not used: no step of the speed is heard"), "{}", run.stderr);
    let run = hovertone(&[&asked[..], &["--json"]].concat()).ends_with(3);
    assert_eq!(
        run.stderr.matches("record a bench run in which the command changes in steps").count(),
        1,
        "{}",
        run.stderr
    );
}

#[test]
fn a_log_with_few_rows_says_how_far_apart_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let log = written(folder.path(), "slow.csv", "time_s,rotor1_rpm\n0,6000\n0.2,6000\n0.4,7000\n0.6,7000\n");
    let run = hovertone(&["motor", &log]).ends_with(3);
    assert!(run.stdout.contains("the rows of this log are more than 100 ms apart: "), "{}", run.stdout);
}

#[test]
fn what_is_neither_log_nor_recording_ends_with_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let other = written(folder.path(), "other.bin", b"\0\x01\xfe\xd5\x13\x41");
    let run = hovertone(&["motor", &other]).ends_with(1);
    assert!(run.stderr.contains("neither a log nor a recording"), "{}", run.stderr);
    let noise = folder.path().join("noise.wav");
    crate::testkit::write_noise(&noise, 6.0);
    let run = hovertone(&["motor", text(&noise), "--blades", "2"]).ends_with(3);
    assert!(run.stdout.contains("no time constant: "), "{}", run.stdout);
    let flat = written(folder.path(), "flat.csv", "time_s,rotor1_rpm\n0,600\n0.01,600\n");
    let run = hovertone(&["motor", text(&noise), "--commands", &flat]).ends_with(1);
    assert!(run.stderr.contains("has no motor commands") && run.stderr.contains("motor1_pwm"), "{}", run.stderr);
    // a minus sign in front of minutes and seconds begins no flag
    for offset in ["1", "-1", "-0:05"] {
        refused_with(&["motor", text(&noise), "--offset", offset], &["--commands"]);
    }
}

#[test]
fn a_recording_heard_with_the_wrong_blades_asks_to_check_them() {
    let Some(folder) = recordings("motor-step") else { return };
    let wav = text(&folder.join("motor_step.wav")).to_owned();
    let told = |flags: &[&str]| hovertone(&[&["motor", &wav], flags].concat());
    let run = told(&["--blades", "4"]).ends_with(3);
    assert!(
        run.stdout.contains("left out: the change is too fast for pieces of sound of this length"),
        "{}",
        run.stdout
    );
    assert!(!run.stdout.contains("the log has"), "{}", run.stdout);
    assert!(run.stdout.contains("if a step is missing, check --blades 4,"), "{}", run.stdout);
    let run = told(&["--blades", "3", "--rotors", "1"]).ends_with(3);
    for words in
        ["no step is heard: check --blades 3, because with a wrong number", "if it is right, record a bench run"]
    {
        assert!(run.stdout.contains(words), "{words}\n{}", run.stdout);
    }
    let run = told(&["--order", "1"]).ends_with(3);
    assert!(run.stdout.contains("check --order 1,"), "{}", run.stdout);
    let run = told(&["--blades", "2", "--rotors", "1"]).ends_with(0);
    assert!(!run.stdout.contains("with a wrong number"), "{}", run.stdout);
}
