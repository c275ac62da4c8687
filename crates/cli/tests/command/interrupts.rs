//! Interrupts: what a killed run leaves is whole, and the run can simply be repeated.

use crate::identify::write_experiment;
use crate::outputs::keeps;
use crate::testkit::{files_in, hovertone, text, write_noise};
use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A demo that is stopped while it writes its recordings leaves whole files only, and the next one takes its folder and clears up.
#[cfg(unix)]
#[test]
fn an_interrupted_demo_leaves_no_half_file_and_runs_again() {
    let folder = tempfile::tempdir().unwrap();
    let demo = folder.path().join("demo");
    let names = || -> Vec<String> {
        let files = demo.join("no_hull").read_dir().into_iter().flatten();
        files.map(|file| file.unwrap().file_name().into_string().unwrap()).collect()
    };
    // begins a demo, kills it while it writes and, if wanted, has finished a recording; returns the ending of the names of what it left
    let old = demo.join("no_hull/trial_1.wav");
    let interrupted_once = |seed: &str, waits_for_recording: bool| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hovertone"));
        command.args(["demo", "-o", text(&demo), "--seed", seed]).stdout(Stdio::null()).stderr(Stdio::null());
        let mut run = command.spawn().unwrap();
        let unfinished = format!(".{}.hovertone-unfinished", run.id());
        let is_writing = || names().iter().any(|name| name.ends_with(&unfinished));
        let is_far_enough = || is_writing() && (!waits_for_recording || old.exists());
        let begun = Instant::now();
        while !is_far_enough() && begun.elapsed() < Duration::from_secs(60) {
            assert!(run.try_wait().unwrap().is_none(), "the folder was refused");
            std::thread::sleep(Duration::from_millis(2));
        }
        run.kill().unwrap();
        run.wait().unwrap();
        is_far_enough().then_some(unfinished)
    };
    // between the look and the kill, a busy machine may end the file
    let interrupted = |seed: &str, waits_for_recording: bool| {
        let of_tries = (0..10).find_map(|_| interrupted_once(seed, waits_for_recording));
        of_tries.expect("it was stopped while it wrote")
    };
    let first = interrupted("1", false);
    assert!(demo.join("experiment.toml").exists() && !old.exists());
    interrupted("1", true);
    // a recording of an earlier demo stays whole
    let before = fs::read(&old).unwrap();
    interrupted("2", false);
    assert_eq!(fs::read(&old).unwrap(), before);
    assert!(names().iter().all(|name| !name.ends_with(&first)), "{:?}", names());
    // a recording of the user's in place of the demo's, or beside its others, is not replaced
    for name in ["no_hull/trial_1.wav", "big_hull/trial_5.wav"] {
        let own = demo.join(name);
        let of_demo = fs::read(&own).ok();
        fs::create_dir_all(own.parent().unwrap()).unwrap();
        write_noise(&own, 1.0);
        keeps(&own, &["demo", "-o", text(&demo), "--seed", "2"], &["trial_", "was changed", "-o DIR", "--force"]);
        of_demo.map_or_else(|| fs::remove_file(&own), |of_demo| fs::write(&own, of_demo)).unwrap();
    }
    let experiment = demo.join("experiment.toml");
    fs::write(&experiment, fs::read_to_string(&experiment).unwrap() + "# my notes\n").unwrap();
    keeps(&experiment, &["demo", "-o", text(&demo)], &["experiment.toml", "was changed", "--force"]);
}

/// Killed at any time, an analysis leaves whole files, and can simply be run again.
#[test]
fn an_interrupted_identify_leaves_whole_files_and_runs_again() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = write_experiment(folder.path());
    let out = folder.path().join("out");
    let arguments = ["identify", &experiment, "-o", text(&out)];
    let begun = Instant::now();
    hovertone(&arguments).ends_with(0);
    let length = begun.elapsed();
    let (mut killed, mut rewritten) = (0, 0);
    for part in 1..=8 {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hovertone"));
        let mut run = command.args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(length.mul_f64(0.3 + 0.08 * f64::from(part)));
        killed += u32::from(run.try_wait().unwrap().is_none());
        rewritten += u32::from(
            fs::read_dir(&out)
                .unwrap()
                .any(|entry| entry.unwrap().metadata().unwrap().modified().unwrap().elapsed().unwrap() < length),
        );
        run.kill().unwrap();
        run.wait().unwrap();
        let content = |name: &str| fs::read_to_string(out.join(name)).unwrap();
        serde_json::from_str::<serde_json::Value>(&content("results.json")).unwrap();
        assert!(content("report.html").trim_end().ends_with("</html>"));
        for picture in files_in(&out.join("figures"), ".svg") {
            assert!(fs::read_to_string(&picture).unwrap().trim_end().ends_with("</svg>"), "{}", picture.display());
        }
    }
    assert!(killed > 0 && rewritten > 0, "killed {killed} times, after something was written {rewritten} times");
    hovertone(&arguments).ends_with(0);
    let left = fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let unfinished: Vec<String> = left.filter(|name| name.contains("unfinished")).collect();
    assert!(unfinished.is_empty(), "{unfinished:?}");
}
