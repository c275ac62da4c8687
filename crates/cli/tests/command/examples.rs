//! The examples of every `--help` and of the README, run as they stand in a folder with the files that they name.

use crate::testkit::{
    Run, hovertone, hovertone_with, repository, steady_bench, steady_hover, text, write_hover, write_noise,
};
use hovertone_sim::scenario::{DoubletAmounts, ScenarioFile};
use hovertone_sim::{HoverSettings, HoverSound};
use hovertone_vehicle::RotorSpeed;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

const COMMANDS: [&str; 23] = [
    "init",
    "speed",
    "listen",
    "batch",
    "batch-compare",
    "tones",
    "spectrogram",
    "identify",
    "calibrate",
    "fit",
    "weigh",
    "export",
    "compare",
    "demo",
    "log",
    "motor",
    "verify",
    "greybox",
    "simulate",
    "vehicles",
    "serve",
    "completions",
    "man",
];
const CONSTANT_TOTAL_N_S2: f64 = 2.831e-5;
const GRAVITY_M_S2: f64 = 9.8;

/// The words of a line that shows a command: up to a comment, a pipe, or the words for people beside it.
fn words_of(line: &str) -> Option<Vec<String>> {
    let command = line.trim().trim_start_matches("$ ").strip_prefix("hovertone ")?;
    let command = command.split(" | ").next()?.split("  ").next()?.split(" #").next()?;
    Some(command.split_whitespace().map(str::to_owned).collect())
}

/// The help of the program and of all its commands.
fn all_help() -> Vec<String> {
    let mut help = vec![hovertone(&["--help"]).ends_with(0).stdout];
    help.extend(COMMANDS.map(|command| hovertone(&[command, "--help"]).ends_with(0).stdout));
    help
}

/// The examples of all commands, in the order in which a reader meets them.
fn examples_of_help() -> Vec<Vec<String>> {
    let help = all_help();
    let lines = help.iter().flat_map(|help| help.lines()).filter(|line| line.starts_with("  hovertone "));
    lines.filter_map(words_of).collect()
}

fn examples_of_readme() -> Vec<Vec<String>> {
    let readme = fs::read_to_string(repository().join("README.md")).unwrap();
    readme.lines().filter(|line| line.starts_with("$ hovertone ")).filter_map(words_of).collect()
}

fn run_in(folder: &Path, words: &[String]) -> Run {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    // nothing is added to the settings of the person who runs the tests
    hovertone_with(&words, |command| command.current_dir(folder).env("XDG_CONFIG_HOME", folder.join("settings")))
}

fn hover(mass_kg: f64, duration_s: f64, seed: u64) -> HoverSettings {
    let speed = RotorSpeed::from_rad_s((mass_kg * GRAVITY_M_S2 / CONSTANT_TOTAL_N_S2).sqrt());
    HoverSettings { seed, ..steady_hover("ardrone", speed, duration_s) }
}

/// The same sound in two channels.
fn write_stereo(path: &Path, settings: HoverSettings) {
    let sample_rate = settings.sample_rate_hz;
    let (samples, _) = HoverSound::new(settings).unwrap().render_all();
    let spec =
        hound::WavSpec { channels: 2, sample_rate, bits_per_sample: 16, sample_format: hound::SampleFormat::Int };
    let mut writer = hound::WavWriter::create(path, spec).unwrap();
    for sample in samples {
        for _ in 0..2 {
            writer.write_sample((sample * 32_767.0).round() as i16).unwrap();
        }
    }
    writer.finalize().unwrap();
}

/// All files that the examples name.
fn lay_out(folder: &Path) {
    let file = |name: &str| {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        path
    };
    let bench = steady_bench("crazyflie", RotorSpeed::from_rpm(20_850.0), 3.0);
    write_hover(&file("bench.wav"), bench);
    for name in ["hover.mp4", "hover.mov", "ardrone/1.mov", "demo/no_hull/trial_1.wav"] {
        write_hover(&file(name), hover(0.413, 3.0, 1));
    }
    write_hover(&file("loaded.mov"), hover(0.444, 3.0, 2));
    write_stereo(&file("hover.wav"), hover(0.413, 3.0, 3));
    for seed in [4, 5] {
        write_hover(&file(&format!("demo/big_hull/trial_{seed}.wav")), hover(0.462, 3.0, seed));
    }
    write_hover(&file("archive/flight/1.wav"), hover(0.413, 2.0, 7));
    fs::write(file("list.txt"), "ardrone/1.mov\n").unwrap();
    for out in ["january", "february", "old-propeller", "new-propeller"] {
        run_in(folder, &["batch", "archive", "-o", out, "--vehicle", "ardrone"].map(str::to_owned)).ends_with(0);
    }
    write_noise(&file("DRONE_006.wav"), 2.0);
    write_noise(&file("tone.wav"), 2.0);
    fs::write(file("my-drone.toml"), "[my-drone]\nrotors = 4\nblades = 2\n").unwrap();
    let mut bench = hover(0.413, 18.0, 6);
    bench.sample_rate_hz = 22_050;
    write_hover(&file("bench.wav"), bench);
    for (index, command) in (0..6).map(|index| (index, 40_000 + 4_000 * index)) {
        let settings = steady_bench("crazyflie", RotorSpeed::from_rev_s(320.0 + 15.0 * f64::from(index)), 2.0);
        write_hover(&file(&format!("crazyflie-propeller/{command}.wav")), settings.clone());
        write_hover(&file(&format!("DIR/{command}.wav")), settings);
    }
    let load = |name: &str, added_mass_kg: f64, recording: &str| {
        format!("[[load]]\nname = \"{name}\"\nadded_mass_kg = {added_mass_kg}\nrecordings = [\"{recording}\"]\n")
    };
    let experiment = format!("[vehicle]\npreset = \"ardrone\"\nmass_kg = 0.413\ngravity_m_s2 = {GRAVITY_M_S2}\n")
        + &load("no hull", 0.0, "demo/no_hull/*.wav")
        + &load("big hull", 0.049, "demo/big_hull/trial_4.wav");
    fs::write(file("experiment.toml"), experiment).unwrap();
    fs::write(file("stand.csv"), "rpm,thrust_n\n3000,0.70\n3600,1.00\n4200,1.38\n5000,1.94\n").unwrap();
    fs::write(file("hovers.csv"), "rpm,mass_g\n3610,413\n3742,444\n3820,462\n").unwrap();
    fs::write(file("scenario.toml"), "duration_s = 0.5\n").unwrap();
    fs::create_dir(folder.join("examples")).unwrap();
    for entry in fs::read_dir(repository().join("examples")).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, folder.join("examples").join(path.file_name().unwrap())).unwrap();
    }
    let rows: String = (0..60).map(|row| format!("{:.2},3600,3610,3620,3630\n", 0.05 * f64::from(row))).collect();
    fs::write(file("flight.csv"), format!("time_s,motor_1_rpm,motor_2_rpm,motor_3_rpm,motor_4_rpm\n{rows}")).unwrap();
    let step = |row: i32| 6000.0 + 3000.0 * (1.0 - (-0.2 * f64::from(row - 50).max(0.0)).exp());
    let steps: String = (0..150).map(|row| format!("{:.2},{:.0}\n", 0.01 * f64::from(row), step(row))).collect();
    fs::write(file("steps.csv"), format!("time_s,rotor1_rpm\n{steps}")).unwrap();
    let commands: String = (0..150).map(|row| format!("{:.2},{}\n", 0.01 * f64::from(row), 1000 + row / 75)).collect();
    fs::write(file("commands.csv"), format!("time_s,motor1_pwm\n{commands}")).unwrap();
    fs::write(file("bench.csv"), "Zeit;Drehzahl\n0;3600\n500;3610\n").unwrap();
    let doublets = ScenarioFile::doublets("ardrone", 1, 22.0, DoubletAmounts::default());
    fs::write(file("doublets.toml"), toml::to_string(&doublets).unwrap()).unwrap();
    let fly = ["simulate", "doublets.toml", "-o", "doublets", "--no-progress"].map(str::to_owned);
    run_in(folder, &fly).ends_with(0);
    fs::copy(folder.join("doublets/truth.csv"), file("doublets.csv")).unwrap();
    let places = ["[0.9, 0.35, -0.1]", "[-0.7, 0.7, 0.1]"];
    fs::write(file("stands.toml"), places.map(|place| format!("[[microphone]]\nposition_m = {place}\n")).concat())
        .unwrap();
    let results = file("out/results.json");
    let identify = ["identify", "experiment.toml", "-o", "out"].map(str::to_owned);
    run_in(folder, &identify).ends_with(0);
    fs::copy(&results, file("demo/results.json")).unwrap();
    for (name, format) in [("iris.sdf", "gazebo"), ("hummingbird.xacro", "rotors")] {
        hovertone(&["export", text(&results), "--to", format, "-o", text(&file(name))]).ends_with(0);
    }
}

/// A folded line loses its last flags when it is copied.
#[test]
fn no_example_is_folded() {
    let mut examples = 0;
    for help in all_help() {
        let lines = help.lines().skip_while(|line| *line != "Examples:").skip(1);
        for line in lines.take_while(|line| !line.is_empty()) {
            assert!(line.starts_with("  hovertone "), "{line:?} continues the line above");
            examples += 1;
        }
    }
    assert!(examples >= 30, "{examples}");
    let named: BTreeSet<String> = examples_of_help().iter().map(|words| words[0].clone()).collect();
    assert_eq!(named, COMMANDS.map(str::to_owned).into());
}

#[test]
fn every_example_runs() {
    let folder = tempfile::tempdir().unwrap();
    lay_out(folder.path());
    let mut run = BTreeSet::new();
    for words in examples_of_help().into_iter().chain(examples_of_readme()) {
        // the demo and the page have tests of their own, init asks without flags, and nobody can write a ULog by hand
        // the low-level model from sound has tests of its own, which take a minute
        let is_heard = words[0] == "greybox" && words[1].ends_with(".wav");
        let is_skipped = is_heard
            || ["demo", "serve"].contains(&words[0].as_str())
            || words == ["init"]
            || words.iter().any(|word| word.ends_with(".ulg"));
        if is_skipped || !run.insert(words.clone()) {
            continue;
        }
        let begun = std::time::Instant::now();
        let done = run_in(folder.path(), &words);
        println!("{:5.1} s  {}", begun.elapsed().as_secs_f64(), words.join(" "));
        // 3: the sound of one speed does not tell which rotor is which, nor how many blades there are
        assert!([0, 3].contains(&done.code), "{words:?} ends with {}:\n{}", done.code, done.stderr);
    }
    assert!(run.len() >= 40, "{}", run.len());
}
