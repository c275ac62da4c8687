//! One rule for all commands: 1 where a file or folder is not there or cannot be used, 2 for wrong use, which includes an output that would be
//! lost.

use crate::testkit::{hovertone, hovertone_with, write_noise};
use std::fs;

/// Words of a command, its exit code, and a word of its message.
const CASES: [(&str, i32, &str); 65] = [
    // what is read is not there, or of another kind
    ("speed nowhere.wav --blades 2", 1, "nowhere.wav"),
    ("speed *.mov --blades 2", 1, "no file matches"),
    ("speed empty --blades 2", 1, "a folder"),
    ("tones nowhere.wav", 1, "nowhere.wav"),
    ("listen --from-file empty --blades 2", 1, "a folder, not a recording"),
    ("spectrogram nowhere.wav --blades 2 -o x.png", 1, "nowhere.wav"),
    ("calibrate nowhere.wav --true-hz 400", 1, "nowhere.wav"),
    ("weigh nowhere.wav --vehicle ardrone --constant-n-s2 2.8e-5", 1, "nowhere.wav"),
    ("weigh a.wav --constant nowhere.json", 1, "nowhere.json"),
    ("identify nowhere.toml", 1, "nowhere.toml"),
    ("identify empty", 1, "a folder"),
    ("identify missing.toml", 1, "nowhere.wav"),
    ("identify missing.toml --check", 1, "nowhere.wav"),
    ("identify good.toml --data-root nowhere", 1, "no such folder"),
    ("identify --vehicle ardrone --mass 413g=nowhere.wav", 1, "nowhere.wav"),
    ("init --vehicle ardrone --mass 413g=nowhere.wav -o new.toml", 1, "nowhere.wav"),
    ("init --vehicle ardrone --mass 413g=empty -o new.toml", 1, "empty"),
    ("fit nowhere.csv", 1, "nowhere.csv"),
    ("fit a.wav", 1, "not text"),
    ("export nowhere.json --to gazebo", 1, "nowhere.json"),
    ("compare nowhere.json model.sdf", 1, "nowhere.json"),
    ("simulate nowhere.toml", 1, "nowhere.toml"),
    ("vehicles --add nowhere.toml", 1, "nowhere.toml"),
    ("log nowhere.ulg", 1, "nowhere.ulg"),
    ("log empty", 1, "a folder"),
    ("fit empty.csv", 1, "this file is empty"),
    ("log empty.csv", 1, "this file is empty"),
    ("verify a.wav empty.csv", 1, "this file is empty"),
    ("identify empty.csv", 1, "this file is empty"),
    ("vehicles --add empty.csv", 1, "this file is empty"),
    ("fit results.json", 1, "this file is JSON"),
    ("motor results.json", 1, "this file is JSON"),
    ("identify results.json", 1, "this file is JSON"),
    ("export results.json --into good.toml", 1, "no thrust constant"),
    ("compare results.json good.toml", 1, "no thrust constant"),
    ("speed a.wav --vehicle ardrone --log a.wav", 1, "this is a recording, but a log is needed"),
    ("greybox a.wav a.wav --vehicle ardrone", 1, "this is a recording, but a log is needed"),
    ("motor a.wav --commands a.wav", 1, "this is a recording, but a log is needed"),
    ("verify a.wav still.csv", 1, "no rotor speed in this log"),
    ("motor still.csv", 1, "no rotor speed in this log"),
    // what is read has no answer
    ("speed a.wav --blades 2 --from 9", 3, "no speed: the recording ends at"),
    ("spectrogram a.wav --blades 2 --from 9 -o x.png", 3, "no picture was written"),
    ("log a.wav", 1, "this is a recording, but a log is needed"),
    ("motor nowhere.ulg", 1, "nowhere.ulg"),
    ("motor a.wav", 3, ""),
    ("verify a.wav nowhere.ulg", 1, "nowhere.ulg"),
    ("verify a.wav a.wav", 1, "this is no log"),
    // what would be written cannot be
    ("identify good.toml -o a.wav", 1, "a folder is needed"),
    ("demo -o a.wav", 1, "a folder is needed"),
    ("simulate flight.toml -o a.wav", 1, "a folder is needed"),
    ("speed a.wav --blades 2 --track nowhere/x.csv", 1, "nowhere/x.csv"),
    ("spectrogram a.wav --blades 2 -o nowhere/x.png", 1, "nowhere/x.png"),
    ("init --vehicle ardrone --mass 413g=a.wav -o nowhere/x.toml", 1, "nowhere/x.toml"),
    // what would be written would replace something
    ("identify good.toml -o full", 2, "has files that do not come from an earlier run"),
    ("demo -o full", 2, "has files that do not come from an earlier run"),
    ("simulate flight.toml -o full", 2, "has files that do not come from an earlier run"),
    ("speed a.wav --blades 2 --track full/notes.csv", 2, "exists already"),
    ("spectrogram a.wav --blades 2 -o full/notes.png", 2, "exists already"),
    ("init --vehicle ardrone --mass 413g=a.wav -o good.toml", 2, "exists already"),
    ("speed a.wav --blades 2 --track a.wav --force", 2, "same name as an input"),
    // what was typed, or stands in a file, has no meaning
    ("speed a.wav --blades 0", 2, "--blades"),
    ("identify broken.toml", 2, "mas_kg"),
    ("log a.wav --column Zeit=speed", 2, "no column name that hovertone knows"),
    ("motor a.wav --figure full/notes.png", 2, "exists already"),
    ("motor a.wav --column Zeit=speed", 2, "no column name that hovertone knows"),
];

const RESULTS: &str = "{\"thrust_constant_per_rotor_n_s2\": {\"value\": 1e-6}, \"rotor_count\": 1, \"methods\": {}}";

#[test]
fn every_command_ends_by_one_rule() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    write_noise(&at("a.wav"), 0.5);
    fs::create_dir(at("empty")).unwrap();
    fs::create_dir(at("full")).unwrap();
    let load =
        |name: &str| format!("[vehicle]\npreset = \"ardrone\"\n[[load]]\nname = \"a\"\nrecordings = [\"{name}\"]\n");
    for (name, content) in [
        ("full/notes.csv", "precious".to_owned()),
        ("full/notes.png", "precious".to_owned()),
        ("good.toml", load("a.wav")),
        ("missing.toml", load("nowhere.wav")),
        ("broken.toml", load("a.wav").replace("[[load]]", "mas_kg = 0.4\n[[load]]")),
        ("flight.toml", "duration_s = 0.2\n".to_owned()),
        ("model.sdf", String::new()),
        ("empty.csv", String::new()),
        ("still.csv", "time_s,motor1_pwm\n0,1000\n1,1100\n".to_owned()),
        ("results.json", RESULTS.to_owned()),
    ] {
        fs::write(at(name), content).unwrap();
    }
    let mut wrong = Vec::new();
    for (words, code, said) in CASES {
        let arguments: Vec<&str> = words.split(' ').collect();
        let run = hovertone_with(&arguments, |command| command.current_dir(folder.path()));
        if run.code != code || !run.stderr.contains(said) {
            wrong.push(format!("{words}: {} in place of {code}, {said:?}: {}", run.code, run.stderr));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_help_has_the_rule() {
    let help = hovertone(&["--help"]).ends_with(0).stdout;
    for words in ["0  done", "1  a file or folder is not there", "2  wrong use", "would be replaced", "3  done, but"] {
        assert!(help.contains(words), "{words}: {help}");
    }
}
