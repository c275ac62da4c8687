//! Nothing of the user's is lost: outputs that are inputs, files that exist, folders of something else, copies.

use crate::testkit::{hovertone, hovertone_with, refused_with, steady_hover, text, write_hover, write_noise};
use hovertone_vehicle::RotorSpeed;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::{Path, PathBuf};

const RESULTS: &str = r#"{"thrust_constant_per_rotor_n_s2":{"value":7e-6},"rotor_count":4}"#;

fn noise(folder: &Path, name: &str) -> PathBuf {
    let path = folder.join(name);
    write_noise(&path, 1.0);
    path
}

/// Refused for these words, and the file is as before.
pub(crate) fn keeps(file: &Path, arguments: &[&str], words: &[&str]) {
    let before = fs::read(file).unwrap();
    refused_with(arguments, words);
    assert_eq!(fs::read(file).unwrap(), before, "{arguments:?}");
}

#[test]
fn an_output_that_is_an_input_is_refused_also_by_force() {
    let folder = tempfile::tempdir().unwrap();
    let wav = noise(folder.path(), "vict.wav");
    let words = ["same name as an input", "vict.wav"];
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
    keeps(&log, &with_log, &["same name as an input", "flight.csv"]);
    for log in [text(&log), "./flight.csv"] {
        let run = |words: &[&str]| {
            let at = folder.path();
            let before = fs::read(at.join("flight.csv")).unwrap();
            let run = hovertone_with(words, |command| command.current_dir(at)).ends_with(2);
            assert!(run.stderr.contains("same name as an input"), "{words:?}: {}", run.stderr);
            assert_eq!(fs::read(at.join("flight.csv")).unwrap(), before, "{words:?}");
        };
        run(&["log", "flight.csv", "--signal", "motor_1_rpm", "-o", log, "--force"]);
    }
    // a picture may be a recording or a log by its name
    let steps = folder.path().join("steps.png");
    fs::copy(&log, &steps).unwrap();
    keeps(&steps, &["motor", text(&steps), "--figure", text(&steps), "--force"], &["same name as an input"]);
    let png = noise(folder.path(), "x.png");
    keeps(&png, &["spectrogram", text(&png), "-o", text(&png), "--force"], &["same name as an input"]);
    let results = folder.path().join("results.json");
    fs::write(&results, RESULTS).unwrap();
    keeps(
        &results,
        &["export", text(&results), "--to", "json", "-o", text(&results), "--force"],
        &["same name as an input"],
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
            &["same name as an input"],
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
            &["this file is a recording"],
        );
    }
}

/// A table that is named as a sound or a picture would be opened with the wrong program.
#[test]
fn a_name_that_promises_another_kind_of_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let wav = noise(folder.path(), "hover.wav");
    let log = folder.path().join("flight.csv");
    fs::write(&log, "time_s,motor_1_rpm\n0,3600\n1,3600\n").unwrap();
    let mass = format!("413g={}", text(&wav));
    for name in ["out.wav", "out.MP4", "out.png"] {
        let place = folder.path().join(name);
        let out = text(&place);
        refused_with(
            &["speed", "--blades", "2", text(&wav), "--track", out],
            &["a track is written as CSV", "track.csv"],
        );
        refused_with(&["log", text(&log), "--signal", "motor_1_rpm", "-o", out], &["written as CSV", "-o signals.csv"]);
        refused_with(&["init", "--vehicle", "ardrone", "--mass", &mass, "-o", out], &["as TOML", "-o experiment.toml"]);
        assert!(!place.exists(), "{name}");
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
    let words = ["same name as an input", "report.html"];
    keeps(&recording, &["identify", text(&experiment), "-o", text(&out), "--force"], &words);
    let flight = folder.path().join("flight");
    fs::create_dir(&flight).unwrap();
    let (scenario, commands) = (flight.join("scenario.toml"), flight.join("truth.csv"));
    fs::write(&scenario, "[[maneuver]]\nkind = \"csv\"\nfile = \"truth.csv\"\nduration_s = 0.4\n").unwrap();
    fs::write(&commands, "time_s,roll\n0.0,0.1\n0.2,-0.1\n").unwrap();
    keeps(&commands, &["simulate", text(&scenario), "-o", text(&flight), "--force"], &["same name as an input"]);
}

#[test]
fn an_existing_file_is_replaced_only_by_force() {
    let folder = tempfile::tempdir().unwrap();
    let wav = noise(folder.path(), "hover.wav");
    let results = folder.path().join("results.json");
    fs::write(&results, RESULTS).unwrap();
    let (track, png, model) =
        (folder.path().join("thesis.csv"), folder.path().join("thesis.png"), folder.path().join("thesis.sdf"));
    let flight = folder.path().join("flight.wav");
    write_hover(&flight, steady_hover("ardrone", RotorSpeed::from_rev_s(60.0), 3.0));
    let runs: [(&Path, Vec<&str>); 3] = [
        (&track, vec!["speed", "--vehicle", "ardrone", text(&flight), "--track", text(&track)]),
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
    // what ends without a picture leaves the old file, also with --force
    let short = folder.path().join("short.wav");
    write_noise(&short, 0.02);
    fs::write(&png, "precious").unwrap();
    hovertone(&["spectrogram", "--blades", "2", text(&short), "-o", text(&png), "--force"]).ends_with(3);
    assert_eq!(fs::read(&png).unwrap(), b"precious");
    // and so does what ends without a track
    fs::write(&track, "precious").unwrap();
    let noise = hovertone(&["speed", "--blades", "2", text(&wav), "--track", text(&track), "--force"]).ends_with(3);
    assert!(noise.stderr.contains("--track wrote no file, because no recording has a speed"), "{}", noise.stderr);
    assert_eq!(fs::read(&track).unwrap(), b"precious");
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

/// Names of the files in `files.sha256`, which `sha256sum --check` would find right, each once.
fn checked_list(folder: &Path) -> Vec<String> {
    let text = fs::read_to_string(folder.join("files.sha256")).unwrap();
    let mut names = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let (sha256, name) = line.split_once("  ").unwrap();
        let digest = Sha256::digest(fs::read(folder.join(name)).unwrap());
        assert_eq!(digest.iter().map(|byte| format!("{byte:02x}")).collect::<String>(), sha256, "{name}");
        names.push(name.to_owned());
    }
    names.sort();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "a file has two lines: {text}");
    names
}

#[test]
fn results_go_into_a_new_folder_or_one_of_results() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = silent_experiment(folder.path());
    let thesis = folder.path().join("thesis");
    fs::create_dir(&thesis).unwrap();
    fs::write(thesis.join("results.json"), "precious").unwrap();
    let file = thesis.join("results.json");
    keeps(
        &file,
        &["identify", text(&experiment), "-o", text(&thesis)],
        &["has files that do not come from an earlier run", "-o DIR", "--force"],
    );
    assert_eq!(fs::read_dir(&thesis).unwrap().count(), 1);
    // the folder of the experiment itself is no place for results
    let own = ["identify", text(&experiment), "-o", text(folder.path())];
    refused_with(&own, &["this folder holds ", "this folder holds the input", "-o results"]);
    let out = folder.path().join("out");
    hovertone(&["identify", text(&experiment), "-o", text(&out)]).ends_with(3);
    let listed = checked_list(&out);
    assert!(listed.iter().any(|name| name == "results.json") && listed.iter().any(|name| name.starts_with("figures/")));
    fs::write(out.join("notes.txt"), "precious").unwrap();
    hovertone(&["identify", text(&experiment), "-o", text(&out)]).ends_with(3);
    assert_eq!(checked_list(&out), listed);
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
    keeps(
        &experiment,
        &["demo", "-o", text(folder.path())],
        &["has files that do not come from an earlier run", "--force"],
    );
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// The files of a folder and their bytes.
fn content_of(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
    let mut content: Vec<_> = files.map(|path| (path.clone(), fs::read(&path).unwrap())).collect();
    content.sort();
    content
}

/// Refused for these words, and everything in the folder is as before.
fn keeps_all(folder: &Path, arguments: &[&str], words: &[&str]) {
    let before = content_of(folder);
    refused_with(arguments, words);
    assert!(before == content_of(folder), "{arguments:?}");
}

#[test]
fn results_of_another_experiment_are_replaced_only_by_force() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = silent_experiment(folder.path());
    let out = folder.path().join("out");
    let identify = ["identify", text(&experiment), "-o", text(&out)];
    hovertone(&identify).ends_with(3);
    let other = folder.path().join("other.toml");
    fs::write(&other, fs::read_to_string(&experiment).unwrap().replace("\"a\"\n", "\"b\"\n")).unwrap();
    keeps_all(
        &out,
        &["identify", text(&other), "-o", text(&out)],
        &["has files that do not come from an earlier run", "this experiment", "--force"],
    );
    // the same recordings and masses, typed, are another experiment: they leave experiment.toml
    let mass = format!("413g={}", text(&folder.path().join("a.wav")));
    let typed = ["identify", "--vehicle", "ardrone", "--mass", &mass, "-o", text(&out)];
    keeps_all(&out, &typed, &["has files that do not come from an earlier run", "this experiment"]);
    // a table that a person changed
    let table = out.join("tables.md");
    fs::write(&table, "precious").unwrap();
    keeps_all(&out, &identify, &["tables.md", "was changed", "--force"]);
    fs::remove_file(&table).unwrap();
    hovertone(&identify).ends_with(3);
    // a file of the user's with the name of a figure, which no table of names has before the work
    let figures = out.join("figures");
    let drawn = content_of(&figures);
    assert!(!drawn.is_empty());
    fs::write(&drawn[0].0, "precious").unwrap();
    keeps_all(&figures, &identify, &["was changed"]);
    hovertone(&["identify", text(&other), "-o", text(&out), "--force"]).ends_with(3);
    keeps_all(&out, &identify, &["this experiment"]);
}

#[test]
fn an_experiment_file_that_was_changed_in_the_results_stays() {
    let folder = tempfile::tempdir().unwrap();
    write_noise(&folder.path().join("a.wav"), 1.0);
    let (out, mass) = (folder.path().join("out"), format!("413g={}", text(&folder.path().join("a.wav"))));
    let typed = |more: &'static [&'static str]| -> Vec<&str> {
        [&["identify", "--vehicle", "ardrone", "--mass", &mass, "-o", text(&out)], more].concat()
    };
    hovertone(&typed(&[])).ends_with(3);
    hovertone(&typed(&[])).ends_with(3);
    keeps_all(&out, &typed(&["--rotors", "4"]), &["this experiment"]);
    let experiment = out.join("experiment.toml");
    fs::write(&experiment, fs::read_to_string(&experiment).unwrap() + "# my notes\n").unwrap();
    keeps_all(&out, &typed(&[]), &["experiment.toml", "was changed", "--force"]);
    hovertone(&typed(&["--force"])).ends_with(3);
    assert!(checked_list(&out).contains(&"experiment.toml".to_owned()));
    assert!(!fs::read_to_string(&experiment).unwrap().contains("my notes"));
}

#[test]
fn a_simulation_of_another_scenario_is_replaced_only_by_force() {
    let folder = tempfile::tempdir().unwrap();
    let [one, other] = ["one.toml", "other.toml"].map(|name| folder.path().join(name));
    fs::write(&one, "duration_s = 0.2\n").unwrap();
    fs::write(&other, "duration_s = 0.3\n").unwrap();
    let out = folder.path().join("out");
    hovertone(&["simulate", text(&one), "-o", text(&out)]).ends_with(0);
    keeps_all(&out, &["simulate", text(&other), "-o", text(&out)], &["same scenario", "--force"]);
    fs::write(out.join("sound.wav"), "precious").unwrap();
    keeps_all(&out, &["simulate", text(&one), "-o", text(&out)], &["sound.wav", "was changed"]);
    hovertone(&["simulate", text(&other), "-o", text(&out), "--force"]).ends_with(0);
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
    // one file under one name in two loads, and twice in one
    for loads in [load("one", 0.0, "a.wav") + &load("two", 0.05, "a.wav"), load("one", 0.0, "a.wav\", \"a.wav")] {
        fs::write(&experiment, format!("{vehicle}{loads}")).unwrap();
        refused_with(
            &["identify", text(&experiment)],
            &["a.wav is given twice: a recording that counts twice makes the uncertainty (±) too small"],
        );
    }
    // a pattern may hold a file that is named as well
    fs::write(&experiment, format!("{vehicle}{}", load("one", 0.0, "a.*\", \"a.wav"))).unwrap();
    hovertone(&["identify", "--check", text(&experiment)]).ends_with(0);
    let weigh = ["weigh", text(&first), text(&second), "--constant-n-s2", "2.831e-5", "--vehicle", "ardrone"];
    refused_with(&weigh, &words[..3]);
    // the same sound in a file with more metadata
    let mut with_chunk = fs::read(&first).unwrap();
    with_chunk.extend(*b"note\x04\0\0\0copy");
    let riff_length = u32::try_from(with_chunk.len() - 8).unwrap();
    with_chunk[4..8].copy_from_slice(&riff_length.to_le_bytes());
    fs::write(&second, with_chunk).unwrap();
    fs::write(&experiment, format!("{vehicle}{}", load("one", 0.0, "*.wav"))).unwrap();
    refused_with(&["identify", text(&experiment)], &words);
    refused_with(&weigh, &words[..3]);
}
