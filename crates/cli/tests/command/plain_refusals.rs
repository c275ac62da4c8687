//! Names, streams and places that cannot be used: each is refused with its reason, and nothing is written.

use crate::testkit::{Run, hovertone, hovertone_with, refused_with, text, write_noise};
use std::fs::{self, File};
use std::path::Path;

/// Runs with a file as stdin.
fn piped(arguments: &[&str], input: &Path, temporary: &Path) -> Run {
    let input = File::open(input).unwrap();
    hovertone_with(arguments, |command| command.stdin(input).env("TMPDIR", temporary))
}

#[test]
fn a_dash_is_no_output() {
    let folder = tempfile::tempdir().unwrap();
    write_noise(&folder.path().join("a.wav"), 0.5);
    for words in [
        &["speed", "a.wav", "--blades", "2", "--track", "-"][..],
        &["identify", "--vehicle", "ardrone", "--mass", "413g=a.wav", "-o", "-"],
        &["init", "--vehicle", "ardrone", "--mass", "413g=a.wav", "-o", "-"],
    ] {
        let run = hovertone_with(words, |command| command.current_dir(folder.path())).ends_with(2);
        assert!(run.stderr.contains("- is given as an output") && run.stderr.contains("./-"), "{}", run.stderr);
        assert!(run.stdout.is_empty() && !folder.path().join("-").exists(), "{words:?}");
    }
}

/// An endless stream of zeros would fill the disk: the first bytes show that it is no sound.
#[cfg(unix)]
#[test]
fn a_stream_without_sound_is_refused_at_its_beginning() {
    let folder = tempfile::tempdir().unwrap();
    let run = piped(&["speed", "--blades", "2", "-"], Path::new("/dev/zero"), folder.path()).ends_with(1);
    assert!(run.stderr.contains("first bytes match no known format") && run.stderr.contains("hint:"), "{}", run.stderr);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    let run = piped(&["speed", "--blades", "2", "-"], Path::new("/dev/null"), folder.path()).ends_with(1);
    assert!(run.stderr.contains("stdin: there is nothing in it (0 bytes)"), "{}", run.stderr);
    let wav = folder.path().join("a.wav");
    write_noise(&wav, 1.0);
    piped(&["speed", "--blades", "2", "-"], &wav, folder.path()).ends_with(3);
}

#[test]
fn a_folder_without_recordings_names_the_folders_that_have_some() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir_all(folder.path().join("demo/no_hull")).unwrap();
    fs::create_dir_all(folder.path().join("bare")).unwrap();
    write_noise(&folder.path().join("demo/no_hull/a.wav"), 0.5);
    for check in [&["--check"][..], &[]] {
        let identify = |name: &str| {
            let load = format!("413g={name}");
            let words = [&["identify", "--vehicle", "ardrone", "--mass", &load], check].concat();
            hovertone_with(&words, |command| command.current_dir(folder.path())).ends_with(1).stderr
        };
        let said = identify("demo");
        assert!(
            said.contains("demo: this folder holds no recording") && said.contains("demo/no_hull/*.wav (1 file)"),
            "{said}"
        );
        assert!(identify("bare").contains("bare: this folder holds no recording"));
    }
}

#[test]
fn a_place_below_a_file_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let (wav, file) = (folder.path().join("a.wav"), folder.path().join("three.toml"));
    write_noise(&wav, 0.5);
    fs::write(&file, "").unwrap();
    let track = file.join("track.csv");
    let run = hovertone(&["speed", text(&wav), "--blades", "2", "--track", text(&track)]).ends_with(1);
    assert!(
        run.stderr.contains("three.toml is a file, not a folder, so nothing can be written into it"),
        "{}",
        run.stderr
    );
}

#[test]
fn a_number_in_place_of_results_names_the_flag_for_numbers() {
    refused_with(&["weigh", "a.wav", "--constant", "2.8e-5"], &["2.8e-5 is a number", "--constant-n-s2 2.8e-5"]);
}

#[test]
fn a_mass_in_grams_is_asked_about() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = folder.path().join("experiment.toml");
    let load = "[[load]]\nname = \"a\"\nrecordings = [\"a.wav\"]\n";
    fs::write(&experiment, format!("[vehicle]\npreset = \"ardrone\"\nmass_kg = 413\n{load}")).unwrap();
    let words = ["vehicle.mass_kg = 413 (did you mean 0.413?)", "weighs 0.413 kg"];
    refused_with(&["identify", text(&experiment)], &words);
    let flags = ["identify", "--vehicle", "ardrone", "--mass", "413=a.wav"];
    refused_with(&flags, &["413 without a unit is 413 kg", "did you mean 413g?", "for example --mass 413g hover.mov"]);
}

/// A table that cannot be fitted still says what was done to its rows.
#[test]
fn rows_without_scatter_say_that_their_sign_was_turned() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("negative.csv");
    fs::write(&table, "rpm,thrust_g\n1000,-10\n2000,-40\n3000,-90\n").unwrap();
    refused_with(
        &["fit", text(&table)],
        &["lie exactly on F = C ω²", "the thrusts are negative, and are used as positive ones"],
    );
}
