//! The start: from an empty folder to a constant, with `init`, with flags alone, and the look before it.

use crate::movie::write_movie;
use crate::testkit::{Run, hovertone_with, steady_hover, text, write_hover, write_noise};
use hovertone_sim::HoverSettings;
use hovertone_sim::prescribed::RotorSound;
use hovertone_vehicle::RotorSpeed;
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const CONSTANT_TOTAL_N_S2: f64 = 2.831e-5;
const GRAVITY_M_S2: f64 = 9.80665;

fn hover(mass_kg: f64, duration_s: f64, seed: u64) -> HoverSettings {
    let speed = RotorSpeed::from_rad_s((mass_kg * GRAVITY_M_S2 / CONSTANT_TOTAL_N_S2).sqrt());
    // their squares have the mean that carries the mass
    let rotors = [-0.02, -0.007, 0.009, 0.018f64]
        .map(|share| RotorSound::steady(RotorSpeed::from_rad_s(speed.rad_s() * (1.0 + share).sqrt())));
    HoverSettings { seed, rotors: rotors.to_vec(), ..steady_hover("ardrone", speed, duration_s) }
}

fn run_in(folder: &Path, words: &[&str]) -> Run {
    hovertone_with(words, |command| command.current_dir(folder).stdin(Stdio::null()))
}

fn results_in(folder: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join("results.json")).unwrap()).unwrap()
}

/// Three films, three masses, two commands: no file edited by hand, under a minute.
#[test]
fn three_movies_become_a_constant_in_under_a_minute() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (seed, mass_kg) in [(1, 0.413), (2, 0.444), (3, 0.472)] {
        write_movie(&at.join(format!("hover {seed}.mov")), hover(mass_kg, 6.0, seed));
    }
    let begun = Instant::now();
    let masses = ["--mass", "413g=hover 1.mov", "--mass", "0.444", "hover 2.mov", "--mass", "0.472=hover 3.mov"];
    let init = run_in(at, &[&["init", "--vehicle", "ardrone"], &masses[..]].concat()).ends_with(0);
    assert!(init.stderr.contains("written: experiment.toml") && init.stderr.contains("--check"), "{}", init.stderr);
    let check = run_in(at, &["identify", "experiment.toml", "--check"]).ends_with(0);
    let identified = run_in(at, &["identify", "experiment.toml", "-o", "results"]).ends_with(0);
    let took = begun.elapsed();
    println!("from the empty folder to the constant: {:.1} s", took.as_secs_f64());
    assert!(identified.stdout.contains("C_f = "), "{}", identified.stdout);
    let results = results_in(&at.join("results"));
    let constant = results["thrust_constant_total_n_s2"]["value"].as_f64().unwrap();
    let expanded = results["expanded_uncertainty_total_n_s2"].as_f64().unwrap();
    assert!((constant - CONSTANT_TOTAL_N_S2).abs() < expanded, "{constant:e} ± {expanded:e}");
    assert!(expanded < 0.01 * constant, "{expanded:e}");
    // one recording of each load shows no scatter from flight to flight: no load is accused, and none is said to fit
    assert!(
        identified
            .stdout
            .contains("verdict: whether the loads agree was not tested, because each load has only one recording"),
        "{}",
        identified.stdout
    );
    assert!(results["loads"].as_array().unwrap().iter().all(|load| load["fits"].is_null()), "{}", results["loads"]);
    assert!(identified.stderr.contains("so the law cannot be tested"), "{}", identified.stderr);
    // the check has said so before, in the same words
    let warnings = |run: &Run| -> Vec<String> {
        run.stderr.lines().filter(|line| line.starts_with("warning: ")).map(str::to_owned).collect()
    };
    let (before, after) = (warnings(&check), warnings(&identified));
    assert!(before.len() == 1 && before[0].contains("each load has one recording"), "{before:?}");
    assert!(before.iter().all(|warning| after.contains(warning)), "{before:?}, {after:?}");
    assert!(at.join("results/report.html").exists());
    assert!(took < Duration::from_secs(60), "{took:?}");
    // what was written is never replaced without being asked
    let again = run_in(at, &[&["init", "--vehicle", "ardrone"], &masses[..]].concat()).ends_with(2);
    assert!(again.stderr.contains("--force"), "{}", again.stderr);
}

#[test]
fn flags_alone_give_the_same_and_leave_the_file_they_amount_to() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (seed, mass_kg) in [(1, 0.413), (2, 0.472)] {
        let place = at.join(format!("load [{seed}]"));
        fs::create_dir(&place).unwrap();
        write_hover(&place.join("a.wav"), hover(mass_kg, 3.0, seed));
    }
    let words =
        ["identify", "--vehicle", "ardrone", "--mass", "0.413=load [1]/*.wav", "--mass", "0.472", "load [2]/a.wav"];
    let flags = run_in(at, &[&words[..], &["-o", "out"]].concat()).ends_with(0);
    let written = fs::read_to_string(at.join("out/experiment.toml")).unwrap();
    assert!(written.contains("../load [1]/*.wav") && written.contains("added_mass_kg = 0.059"), "{written}");
    assert!(
        written.starts_with("# Written by hovertone") && written.contains("identify --vehicle ardrone"),
        "{written}"
    );
    assert_eq!(results_in(&at.join("out"))["settings"]["file"], "experiment.toml");
    let again = run_in(at, &["identify", "out/experiment.toml"]).ends_with(0);
    let quoted = |run: &Run| run.stdout.lines().find(|line| line.starts_with("C_f")).unwrap().to_owned();
    assert_eq!(quoted(&flags), quoted(&again));
}

#[test]
fn flags_that_are_no_experiment_say_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let refuses = |words: &[&str], said: &[&str]| {
        let run = run_in(folder.path(), words).ends_with(2);
        assert!(run.stdout.is_empty(), "{}", run.stdout);
        said.iter().for_each(|said| assert!(run.stderr.contains(said), "{words:?} without {said}:\n{}", run.stderr));
    };
    refuses(&["identify"], &["identify needs an experiment file"]);
    refuses(
        &["identify", "--mass", "0.4=a.wav"],
        &[
            "--vehicle NAME, or both --rotors N and --blades N (with a gear, --rotors N and --gear P:W)",
            "hovertone init",
        ],
    );
    refuses(&["identify", "--mass", "0.4=a.wav", "--blades", "2"], &["--rotors N"]);
    refuses(&["identify", "--mass", "0.4=a.wav", "--vehicle", "iris"], &["--blades N, or --gear P:W"]);
    refuses(&["identify", "--mass", "a.wav", "--vehicle", "ardrone"], &["the mass of this recording is missing"]);
    refuses(&["identify", "--mass", "413=a.wav", "--vehicle", "ardrone"], &["413g"]);
    refuses(&["identify", "x.toml", "--mass", "0.4=a.wav"], &["cannot be used with"]);
    refuses(&["identify", "--mass", "5=a.wav", "--vehicle", "ardrone"], &["--mass 5: ", "0.413 kg"]);
    let flags = |words: &str, said: &[&str]| {
        refuses(&words.split(' ').collect::<Vec<_>>(), said);
        let run = run_in(folder.path(), &words.split(' ').collect::<Vec<_>>());
        assert!(!run.stderr.contains("experiment.toml"), "no file was typed: {}", run.stderr);
    };
    flags("identify --mass 0.0005=a.wav --vehicle ardrone", &["--mass 0.0005=a.wav: ", "from 0.001"]);
    flags(
        "identify --mass 0.4=a.wav --mass 9=b.wav --vehicle ardrone",
        &["--mass 9000 g and --mass 400 g: ", "of --mass 9000 g"],
    );
    flags("identify --mass 0.4=a.wav --vehicle ardrone --height-m 40", &["--height-m 40 alone", "--latitude-deg"]);
    refuses(&["init"], &["needs a terminal", "--mass"]);
    refuses(&["init", "--vehicle", "ardron", "--mass", "0.4=a.wav"], &["did you mean \"ardrone\""]);
    refuses(&["init", "--blades", "2", "--rotors", "4", "--diameter-m", "254", "--mass", "1=a.wav"], &["in metres"]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is written");
    let run = run_in(folder.path(), &["identify", "--mass", "0.4=no/*.wav", "--vehicle", "ardrone"]).ends_with(1);
    assert!(run.stderr.contains("no/*.wav") && run.stderr.contains("current folder"), "{}", run.stderr);
}

#[test]
fn a_check_says_what_it_would_do_and_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::create_dir(at.join("a")).unwrap();
    write_hover(&at.join("a/1.WAV"), hover(0.413, 1.0, 1));
    fs::write(at.join("broken.wav"), "no sound").unwrap();
    let words = ["identify", "--check", "--blades", "2", "--rotors", "4", "--mass", "0.413=a/*.WAV"];
    let ready = run_in(at, &words).ends_with(0);
    for said in ["4 rotors, tone at 2 times the rotor speed", "a/1.WAV", "0:01", "48.0 kHz", "0.413", "ready"] {
        assert!(ready.stdout.contains(said), "{said}:\n{}", ready.stdout);
    }
    for said in ["half and double the true speed", "gravity", "only one load", "--latitude-deg"] {
        assert!(ready.stderr.contains(said), "{said}:\n{}", ready.stderr);
    }
    // what the run would refuse, the check refuses too
    let refused = run_in(at, &[&words[..], &["-o", "broken.wav"]].concat()).ends_with(1);
    assert!(refused.stderr.contains("a folder is needed") && !refused.stdout.contains("ready"), "{}", refused.stderr);
    // a folder stands for its recordings
    let folder_ready = run_in(at, &[&words[..6], &["--mass", "0.413=a"]].concat()).ends_with(0);
    assert!(folder_ready.stdout.contains("a/1.WAV"), "{}", folder_ready.stdout);
    let more = ["--mass", "0.5=a/*.wav", "--mass", "0.6=broken.wav", "-o", "out"];
    let missing = run_in(at, &[&words[..], &more[..]].concat()).ends_with(1);
    for said in ["no file matches a/*.wav", "a/*.WAV (1 file)", "broken.wav: "] {
        assert!(missing.stderr.contains(said), "{said}:\n{}", missing.stderr);
    }
    assert!(missing.stdout.contains("not ready: 2 errors") && !at.join("out").exists(), "{}", missing.stdout);
}

/// `init` in a terminal, which `script` makes.
#[test]
fn init_asks_in_a_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::create_dir_all(at.join("no_hull")).unwrap();
    write_noise(&at.join("no_hull/1.MOV"), 0.5);
    write_noise(&at.join("small.mov"), 0.6);
    let program = format!("'{}' init", env!("CARGO_BIN_EXE_hovertone"));
    let mut command = Command::new("script");
    command.args(["-qec", &program, "/dev/null"]).current_dir(at).stdin(Stdio::piped()).stdout(Stdio::piped());
    let Ok(mut child) = command.spawn() else {
        println!("skipped: no `script` of util-linux");
        return;
    };
    let answers = "\n2\n\n\n8in\n0.444\n413g\n\n";
    child.stdin.take().unwrap().write_all(answers.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success() && said.contains("written: experiment.toml"), "{said}");
    assert!(said.contains("half and double the true speed") && said.contains("no_hull/*.MOV (1 recording)"), "{said}");
    let written = fs::read_to_string(at.join("experiment.toml")).unwrap();
    for line in ["blades = 2", "rotors = 4", "propeller_diameter_m = 0.2032", "mass_kg = 0.413", "no_hull/*.MOV"] {
        assert!(written.contains(line), "{line}:\n{written}");
    }
    let path = at.join("experiment.toml");
    assert!(run_in(at, &["identify", "--check", text(&path)]).stdout.contains("2 loads"));
}
