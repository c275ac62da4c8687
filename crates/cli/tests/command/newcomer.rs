//! The commands of the README with films in place of the demo's recordings, from an empty folder to a constant.

use crate::demo::finished_demo;
use crate::testkit::{Run, files_in, hovertone_with, repository, text};
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Constant and masses of the paper, which the demo flies with.
const TRUTH_TOTAL_N_S2: f64 = 2.829e-5;
const LOADS: [(&str, &str); 3] = [("big_hull", "462g"), ("no_hull", "413g"), ("small_hull", "444g")];
/// What the films are: pictures with sound, or sound alone.
const KINDS: [&str; 3] = ["mov", "m4a", "mp4"];

fn run_in(folder: &Path, words: &[&str]) -> Run {
    hovertone_with(words, |command| command.current_dir(folder))
}

/// Converts a recording as a phone would have written it.
fn film(recording: &Path, film: &Path) {
    let mut command = Command::new("ffmpeg");
    command.args(["-v", "error", "-y", "-i", text(recording)]);
    if film.extension().is_some_and(|kind| kind != "m4a") {
        command.args(["-f", "lavfi", "-i", "color=black:s=64x64:r=10", "-shortest", "-c:v", "mpeg4"]);
    }
    let run = command.args(["-c:a", "aac", "-b:a", "96k"]).arg(film).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
}

/// Writes a demo with a film in place of every recording; the kinds take turns.
fn write_demo_of_films(demo: &Path) {
    let finished = &finished_demo().folder;
    for (load, _) in LOADS {
        let films = demo.join(load);
        fs::create_dir_all(&films).unwrap();
        for (number, recording) in files_in(&finished.join(load), ".wav").iter().enumerate() {
            let name = recording.with_extension(KINDS[number % KINDS.len()]);
            film(recording, &films.join(name.file_name().unwrap()));
        }
    }
    let files = finished.read_dir().unwrap().map(|file| file.unwrap().path()).filter(|path| path.is_file());
    for file in files {
        fs::copy(&file, demo.join(file.file_name().unwrap())).unwrap();
    }
}

/// The commands of the README as words, with films in place of recordings.
fn commands_of_readme() -> Vec<Vec<String>> {
    let readme = fs::read_to_string(repository().join("README.md")).unwrap();
    let lines = readme.lines().filter_map(|line| line.strip_prefix("$ hovertone "));
    let of_films = |line: &str| {
        line.replace("trial_1.wav", "trial_1.mov").replace("*.wav", "*.m*").replace("demo/results", "loads/results")
    };
    lines.map(|line| of_films(line).split_whitespace().map(str::to_owned).collect()).collect()
}

/// The constant of results, with its ±.
fn constant_of(results: &Path) -> [f64; 2] {
    let results: Value = serde_json::from_str(&fs::read_to_string(results).unwrap()).unwrap();
    let number = |pointer: &str| results.pointer(pointer).and_then(Value::as_f64).unwrap();
    [number("/thrust_constant_total_n_s2/value"), number("/expanded_uncertainty_total_n_s2")]
}

#[test]
#[ignore = "exam: a demo, and its films identified twice"]
fn a_newcomer_with_films_gets_the_constant_within_its_uncertainty() {
    if Command::new("ffmpeg").arg("-version").output().is_err() {
        println!("skipped: no ffmpeg on the search path");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write_demo_of_films(&at.join("demo"));
    let (mut done, mut weighed) = (0, None);
    for words in commands_of_readme() {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        // the demo has run, and init without flags asks, below
        if words == ["demo"] || words == ["init"] {
            continue;
        }
        let run = run_in(at, &words).ends_with(0);
        if words[0] == "weigh" {
            weighed = run.stdout.lines().find_map(|line| line.strip_prefix("mass as flown: ")).map(str::to_owned);
        }
        done += 1;
    }
    assert!(done >= 8, "{done}");
    let [found, expanded] = constant_of(&at.join("loads/results.json"));
    assert!((found - TRUTH_TOTAL_N_S2).abs() < expanded && expanded < 0.02 * found, "{found} ± {expanded}");
    // "461.9 ± 2.8 g (k = 2)"
    let weighed = weighed.unwrap();
    let numbers: Vec<f64> = weighed.split([' ', '±']).filter_map(|word| word.parse().ok()).collect();
    assert!((numbers[0] - 462.0).abs() < numbers[1] && numbers[1] < 10.0, "{weighed}");
    asked_for_three_films(at);
}

/// `init` in a terminal, with three films and their masses, and then `identify`: no file is edited by hand.
fn asked_for_three_films(at: &Path) {
    let three = at.join("three");
    fs::create_dir(&three).unwrap();
    for (load, _) in LOADS {
        fs::copy(at.join("demo").join(load).join("trial_1.mov"), three.join(format!("{load}.MOV"))).unwrap();
    }
    let program = format!("'{}' init", env!("CARGO_BIN_EXE_hovertone"));
    let mut command = Command::new("script");
    command.args(["-qec", &program, "/dev/null"]).current_dir(&three).stdin(Stdio::piped()).stdout(Stdio::piped());
    let Ok(mut child) = command.spawn() else {
        println!("skipped: no `script` of util-linux");
        return;
    };
    let masses = LOADS.map(|(_, mass)| mass).join("\n");
    child.stdin.take().unwrap().write_all(format!("ardrone\n\n{masses}\n\n").as_bytes()).unwrap();
    let asked = child.wait_with_output().unwrap();
    assert!(asked.status.success(), "{}", String::from_utf8_lossy(&asked.stdout));
    run_in(&three, &["identify", "experiment.toml", "-o", "out"]).ends_with(0);
    let [found, expanded] = constant_of(&three.join("out/results.json"));
    assert!((found - TRUTH_TOTAL_N_S2).abs() < expanded && expanded < 0.1 * found, "{found} ± {expanded}");
}
