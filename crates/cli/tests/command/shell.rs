//! Completions and man pages.

use crate::testkit::{hovertone, hovertone_with, refused_with, text};
use std::fs;
use std::process::Command;

#[test]
fn every_shell_has_completions_of_every_command() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = hovertone(&["completions", shell]).ends_with(0).stdout;
        for word in ["identify", "calibrate", "spectrogram", "tachometer-rpm", "clock-correction-ppm"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    assert!(hovertone(&["completions", "csh"]).ends_with(2).stderr.contains("bash"));
}

#[test]
fn bash_reads_its_completions_and_offers_commands() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("hovertone.bash");
    fs::write(&script, hovertone(&["completions", "bash"]).ends_with(0).stdout).unwrap();
    let ask = "source \"$1\"; COMP_WORDS=(hovertone ca); COMP_CWORD=1; _hovertone hovertone ca hovertone; echo \"${COMPREPLY[@]}\"";
    let Ok(output) = Command::new("bash").args(["-c", ask, "bash", text(&script)]).output() else {
        println!("skipped: no bash");
        return;
    };
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "calibrate", "{:?}", output.stderr);
}

/// After `--vehicle`, bash offers the vehicles and no files: those of the program, and a person's own. Other names are still taken.
#[test]
fn bash_offers_vehicles() {
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().join("hovertone");
    fs::create_dir(&own).unwrap();
    fs::write(own.join("vehicles.toml"), "[artichoke]\nname = \"Mine\"\nrotors = 4\nblades = 2\nsource = \"me\"\n")
        .unwrap();
    let run = hovertone_with(&["completions", "bash"], |command| command.env("XDG_CONFIG_HOME", folder.path()));
    let script = folder.path().join("hovertone.bash");
    fs::write(&script, run.ends_with(0).stdout).unwrap();
    fs::write(folder.path().join("arbitrary.wav"), "").unwrap();
    let ask = "cd \"$2\"; source \"$1\"; COMP_WORDS=(hovertone \"$3\" --vehicle ar); COMP_CWORD=3; _hovertone hovertone ar --vehicle; echo \"${COMPREPLY[@]}\"";
    for command in ["speed", "identify", "tones", "init"] {
        let words = ["-c", ask, "bash", text(&script), text(folder.path()), command];
        let Ok(output) = Command::new("bash").args(words).output() else {
            println!("skipped: no bash");
            return;
        };
        let offered = String::from_utf8_lossy(&output.stdout).into_owned();
        let offered: Vec<&str> = offered.split_whitespace().collect();
        assert!(offered.contains(&"ardrone") && offered.contains(&"artichoke"), "{command}: {offered:?}");
        assert!(offered.iter().all(|name| !name.contains('.')), "{command}: {offered:?}");
    }
    refused_with(&["speed", "--vehicle", "no-such-drone", text(&script)], &["no-such-drone", "hovertone vehicles"]);
}

#[test]
fn man_pages_of_the_program_and_of_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let pages = folder.path().join("man1");
    hovertone(&["man", "-o", text(&pages)]).ends_with(0);
    let help = hovertone(&["--help"]).ends_with(0).stdout;
    let commands = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names: Vec<&str> = commands
        .filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' '))?.split_whitespace().next())
        .collect();
    let names: Vec<&str> = names.into_iter().filter(|name| *name != "help").collect();
    assert!(names.len() >= 15, "{names:?}");
    let page = |name: &str| fs::read_to_string(pages.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    for name in &names {
        assert!(page(&format!("hovertone-{name}.1")).contains(".SH OPTIONS"), "{name}");
    }
    // an example is a line of its own
    assert!(page("hovertone-speed.1").contains("\n  hovertone speed \\-\\-blades 2 hover.mp4\n"));
    assert!(page("hovertone.1").contains("hovertone\\-speed"), "the program's page names the pages of its commands");
    assert_eq!(hovertone(&["man", "speed"]).ends_with(0).stdout, page("hovertone-speed.1"));
    // unchanged pages are replaced, and nothing else is
    hovertone(&["man", "-o", text(&pages)]).ends_with(0);
    fs::write(pages.join("hovertone.1"), "precious").unwrap();
    refused_with(&["man", "-o", text(&pages)], &["hovertone.1", "was changed", "--force"]);
    assert_eq!(page("hovertone.1"), "precious");
    fs::write(folder.path().join("notes.txt"), "precious").unwrap();
    refused_with(
        &["man", "-o", text(folder.path())],
        &["has files that do not come from an earlier run", "same command", "--force"],
    );
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    refused_with(&["man", "spead"], &["did you mean \"speed\""]);
}
