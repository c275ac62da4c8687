//! Files and folders that the user has no right to read or to write: the message names the right one of them, and what to do.
#![cfg(unix)]

use crate::testkit::{Run, hovertone_with, text, write_noise};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::Path;

/// The user "nobody", where the tests run as one who may do all.
const NOBODY: u32 = 65_534;

fn allow(path: &Path, mode: u32) {
    fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
}

#[test]
fn a_missing_right_names_what_it_is_missing_for() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir_all(at("closed")).unwrap();
    for name in ["mine.wav", "secret.wav", "closed/a.wav"] {
        write_noise(&at(name), 0.5);
    }
    fs::write(at("secret.csv"), "rpm,thrust_n\n").unwrap();
    fs::create_dir(at("read_only")).unwrap();
    allow(folder.path(), 0o777);
    allow(&at("read_only"), 0o555);
    allow(&at("secret.wav"), 0);
    allow(&at("secret.csv"), 0);
    allow(&at("closed"), 0);
    let is_root = fs::read(at("secret.csv")).is_ok();
    let run = |arguments: &str| -> Run {
        let arguments: Vec<&str> = arguments.split(' ').collect();
        hovertone_with(&arguments, |command| {
            command.current_dir(folder.path());
            if is_root { command.uid(NOBODY).gid(NOBODY) } else { command }
        })
    };
    let (file, open) = ("you have no right to read", "you have no right to open this folder (hint: ask the owner");
    for (arguments, words) in [
        (
            "speed secret.wav --blades 2",
            ["secret.wav: the file cannot be opened: you have no right to read it", "owner"],
        ),
        ("calibrate closed/a.wav --blades 2 --tachometer-rpm 3600", ["closed/a.wav: ", "or to open its folder"]),
        ("fit secret.csv", ["secret.csv: ", file]),
        ("log secret.csv", ["secret.csv: ", file]),
        ("motor closed/a.csv", ["closed: ", open]),
        ("fit closed/a.csv", ["closed: ", open]),
        ("identify closed/e.toml", ["closed: ", open]),
        ("identify --vehicle ardrone --mass 0.4=closed/*.wav", ["closed: ", open]),
        ("identify --vehicle ardrone --mass 0.4=closed", ["closed: ", open]),
        ("identify --vehicle ardrone --mass 0.4=closed --check", ["closed: you have no right to open", "owner"]),
        ("init --vehicle ardrone --mass 0.4=closed/a.wav", ["closed: ", open]),
        (
            "spectrogram mine.wav -o read_only/out.png",
            ["read_only/out.png: you have no right to write into the folder", "of your own"],
        ),
        ("demo -o closed", ["closed: you have no right to open this folder", "-o DIR"]),
        ("demo -o mine.wav", ["mine.wav: this is a file, but a folder is needed", "-o DIR"]),
    ] {
        let run = run(arguments).ends_with(1);
        words.iter().for_each(|word| assert!(run.stderr.contains(word), "{arguments}: no {word:?}:\n{}", run.stderr));
    }
    allow(folder.path(), 0o755);
    allow(&at("closed"), 0o755);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 5, "{}", text(folder.path()));
}
