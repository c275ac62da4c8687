//! Nothing of the user's is lost: outputs that are inputs, files that exist, folders of something else, interrupts, copies.

use crate::testkit::{hovertone, refused_with, steady_hover, text, write_hover, write_noise};
use hovertone_vehicle::RotorSpeed;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const RESULTS: &str = r#"{"thrust_constant_per_rotor_n_s2":{"value":7e-6},"rotor_count":4}"#;

fn noise(folder: &Path, name: &str) -> PathBuf {
    let path = folder.join(name);
    write_noise(&path, 1.0);
    path
}

/// Refused for these words, and the file is as before.
fn keeps(file: &Path, arguments: &[&str], words: &[&str]) {
    let before = fs::read(file).unwrap();
    refused_with(arguments, words);
    assert_eq!(fs::read(file).unwrap(), before, "{arguments:?}");
}

#[test]
fn an_output_that_is_an_input_is_refused_also_by_force() {
    let folder = tempfile::tempdir().unwrap();
    let wav = noise(folder.path(), "vict.wav");
    let words = ["the same command reads it", "vict.wav"];
    keeps(&wav, &["speed", "--blades", "2", text(&wav), "--track", text(&wav)], &words);
    keeps(&wav, &["speed", "--blades", "2", text(&wav), "--track", text(&wav), "--force"], &words);
    let pattern = folder.path().join("*.wav");
    keeps(&wav, &["speed", "--blades", "2", text(&pattern), "--track", text(&wav), "--force"], &words);
    let log = folder.path().join("flight.csv");
    fs::write(
        &log,
        "time_s,motor_1_rpm,motor_2_rpm,motor_3_rpm,motor_4_rpm\n0,3600,3600,3600,3600\n1,3600,3600,3600,3600\n",
    )
    .unwrap();
    let with_log = ["speed", "--vehicle", "ardrone", text(&wav), "--log", text(&log), "--track", text(&log), "--force"];
    keeps(&log, &with_log, &["the same command reads it", "flight.csv"]);
    // a picture may be a recording by its name
    let png = noise(folder.path(), "x.png");
    keeps(&png, &["spectrogram", text(&png), "-o", text(&png), "--force"], &["the same command reads it"]);
    let results = folder.path().join("results.json");
    fs::write(&results, RESULTS).unwrap();
    keeps(
        &results,
        &["export", text(&results), "--to", "json", "-o", text(&results), "--force"],
        &["the same command reads it"],
    );
}

#[cfg(unix)]
#[test]
fn an_input_by_another_name_is_the_same_file() {
    let folder = tempfile::tempdir().unwrap();
    let wav = noise(folder.path(), "vict.wav");
    let (link, hard) = (folder.path().join("link.csv"), folder.path().join("hard.csv"));
    std::os::unix::fs::symlink(&wav, &link).unwrap();
    fs::hard_link(&wav, &hard).unwrap();
    for name in [&link, &hard] {
        keeps(
            &wav,
            &["speed", "--blades", "2", text(&wav), "--track", text(name), "--force"],
            &["the same command reads it"],
        );
    }
}

#[test]
fn a_recording_of_a_new_experiment_is_not_replaced_by_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let wav = noise(folder.path(), "vict.wav");
    for mass in [text(&wav).to_owned(), format!("{}/*.wav", text(folder.path()))] {
        let mass = format!("413g={mass}");
        keeps(
            &wav,
            &["init", "--vehicle", "ardrone", "--mass", &mass, "-o", text(&wav), "--force"],
            &["the same command reads it"],
        );
    }
}

#[test]
fn the_files_that_experiments_and_scenarios_read_are_inputs() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    fs::create_dir(&out).unwrap();
    let (experiment, recording) = (folder.path().join("experiment.toml"), noise(&out, "report.html"));
    fs::write(
        &experiment,
        "[vehicle]\npreset = \"ardrone\"\n[[load]]\nname = \"a\"\nrecordings = [\"out/report.html\"]\n",
    )
    .unwrap();
    let words = ["the same command reads it", "report.html"];
    keeps(&recording, &["identify", text(&experiment), "-o", text(&out), "--force"], &words);
    let flight = folder.path().join("flight");
    fs::create_dir(&flight).unwrap();
    let (scenario, commands) = (flight.join("scenario.toml"), flight.join("truth.csv"));
    fs::write(&scenario, "[[maneuver]]\nkind = \"csv\"\nfile = \"truth.csv\"\nduration_s = 0.4\n").unwrap();
    fs::write(&commands, "time_s,roll\n0.0,0.1\n0.2,-0.1\n").unwrap();
    keeps(&commands, &["simulate", text(&scenario), "-o", text(&flight), "--force"], &["the same command reads it"]);
}

#[test]
fn an_existing_file_is_replaced_only_by_force() {
    let folder = tempfile::tempdir().unwrap();
    let wav = noise(folder.path(), "hover.wav");
    let results = folder.path().join("results.json");
    fs::write(&results, RESULTS).unwrap();
    let (track, png, model) =
        (folder.path().join("thesis.csv"), folder.path().join("thesis.png"), folder.path().join("thesis.sdf"));
    let runs: [(&Path, Vec<&str>); 3] = [
        (&track, vec!["speed", "--blades", "2", text(&wav), "--track", text(&track)]),
        (&png, vec!["spectrogram", "--blades", "2", text(&wav), "-o", text(&png)]),
        (&model, vec!["export", text(&results), "--to", "gazebo", "-o", text(&model)]),
    ];
    for (file, arguments) in runs {
        fs::write(file, "precious").unwrap();
        keeps(file, &arguments, &["exists already", "--force"]);
        let forced = hovertone(&[arguments.as_slice(), &["--force"]].concat());
        assert!([0, 3].contains(&forced.code), "{}", forced.stderr);
        assert_ne!(fs::read(file).unwrap(), b"precious");
    }
    // what ends in an error later leaves the old file, also with --force
    let short = folder.path().join("short.wav");
    write_noise(&short, 0.02);
    fs::write(&png, "precious").unwrap();
    hovertone(&["spectrogram", "--blades", "2", text(&short), "-o", text(&png), "--force"]).ends_with(1);
    assert_eq!(fs::read(&png).unwrap(), b"precious");
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(left.iter().all(|name| !name.to_string_lossy().contains("unfinished")), "{left:?}");
}

/// Two loads of noise: an experiment in which nothing is heard, and which is quickly done.
fn silent_experiment(folder: &Path) -> PathBuf {
    write_noise(&folder.join("a.wav"), 1.0);
    let path = folder.join("experiment.toml");
    fs::write(&path, "[vehicle]\npreset = \"ardrone\"\n[[load]]\nname = \"a\"\nrecordings = [\"a.wav\"]\n").unwrap();
    path
}

#[test]
fn results_go_into_a_new_folder_or_one_of_results() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = silent_experiment(folder.path());
    let thesis = folder.path().join("thesis");
    fs::create_dir(&thesis).unwrap();
    fs::write(thesis.join("results.json"), "precious").unwrap();
    let file = thesis.join("results.json");
    keeps(&file, &["identify", text(&experiment), "-o", text(&thesis)], &["not empty", "-o DIR", "--force"]);
    assert_eq!(fs::read_dir(&thesis).unwrap().count(), 1);
    // the folder of the experiment itself is not empty either
    refused_with(&["identify", text(&experiment), "-o", text(folder.path())], &["not empty"]);
    let out = folder.path().join("out");
    hovertone(&["identify", text(&experiment), "-o", text(&out)]).ends_with(3);
    fs::write(out.join("notes.txt"), "precious").unwrap();
    hovertone(&["identify", text(&experiment), "-o", text(&out)]).ends_with(3);
    assert_eq!(fs::read_to_string(out.join("notes.txt")).unwrap(), "precious");
    hovertone(&["identify", text(&experiment), "-o", text(&thesis), "--force"]).ends_with(3);
    assert!(fs::read_to_string(thesis.join("results.json")).unwrap().starts_with('{'));
}

#[test]
fn a_folder_is_checked_before_the_analysis() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = silent_experiment(folder.path());
    // a recording that no analysis can read: its message would come first
    fs::write(folder.path().join("a.wav"), "broken").unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "precious").unwrap();
    for run in [
        hovertone(&["identify", text(&experiment), "-o", text(&file)]).ends_with(1),
        hovertone(&["demo", "-o", text(&file)]).ends_with(1),
        hovertone(&["speed", "--blades", "2", "a.wav", "--track", text(&folder.path().join("no/such/folder.csv"))])
            .ends_with(1),
    ] {
        assert!(run.stdout.is_empty() && !run.stderr.contains("a.wav"), "{}{}", run.stdout, run.stderr);
    }
    assert_eq!(fs::read(&file).unwrap(), b"precious");
}

#[test]
fn an_experiment_file_that_was_changed_is_no_demos() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = folder.path().join("experiment.toml");
    fs::write(&experiment, "# Written by `hovertone demo` (hovertone 0.1.0, seed 1).\n[vehicle]\nmass_kg = 0.42\n")
        .unwrap();
    keeps(&experiment, &["demo", "-o", text(folder.path())], &["was changed", "--force"]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

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
    // begins a demo, kills it while it writes, and returns the ending of the names of what it left
    let interrupted = |seed: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hovertone"));
        command.args(["demo", "-o", text(&demo), "--seed", seed]).stdout(Stdio::null()).stderr(Stdio::null());
        let mut run = command.spawn().unwrap();
        let unfinished = format!(".{}.hovertone-unfinished", run.id());
        let is_writing = || names().iter().any(|name| name.ends_with(&unfinished));
        let begun = Instant::now();
        while !is_writing() && begun.elapsed() < Duration::from_secs(60) {
            assert!(run.try_wait().unwrap().is_none(), "the folder was refused");
            std::thread::sleep(Duration::from_millis(2));
        }
        run.kill().unwrap();
        run.wait().unwrap();
        assert!(is_writing(), "it was not stopped while it wrote");
        unfinished
    };
    let first = interrupted("1");
    assert!(demo.join("experiment.toml").exists() && !demo.join("no_hull/trial_1.wav").exists());
    // a recording of an earlier demo stays whole
    let old = demo.join("no_hull/trial_1.wav");
    write_noise(&old, 1.0);
    let before = fs::read(&old).unwrap();
    interrupted("2");
    assert_eq!(fs::read(&old).unwrap(), before);
    assert!(names().iter().all(|name| !name.ends_with(&first)), "{:?}", names());
}

#[test]
fn a_recording_counts_once() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (folder.path().join("a.wav"), folder.path().join("b.wav"));
    write_hover(&first, steady_hover("ardrone", RotorSpeed::from_rev_s(60.0), 1.0));
    fs::copy(&first, &second).unwrap();
    let experiment = folder.path().join("experiment.toml");
    let load = |name: &str, added_mass_kg: f64, file: &str| {
        format!("[[load]]\nname = \"{name}\"\nadded_mass_kg = {added_mass_kg}\nrecordings = [\"{file}\"]\n")
    };
    let vehicle = "[vehicle]\npreset = \"ardrone\"\nmass_kg = 0.413\n";
    let words = ["a.wav and", "b.wav are the same recording", "±", "experiment.toml"];
    for loads in [load("one", 0.0, "*.wav"), load("one", 0.0, "a.wav") + &load("two", 0.05, "b.wav")] {
        fs::write(&experiment, format!("{vehicle}{loads}")).unwrap();
        refused_with(&["identify", text(&experiment)], &words);
    }
    // one file under one name in two loads
    let loads = load("one", 0.0, "a.wav") + &load("two", 0.05, "a.wav");
    fs::write(&experiment, format!("{vehicle}{loads}")).unwrap();
    refused_with(&["identify", text(&experiment)], &["a.wav and a.wav are the same recording"]);
    let weigh = ["weigh", text(&first), text(&second), "--constant-n-s2", "2.831e-5", "--vehicle", "ardrone"];
    refused_with(&weigh, &words[..3]);
}
