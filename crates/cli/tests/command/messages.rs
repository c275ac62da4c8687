//! What the messages look like: one line each, the file first, counts that agree with their nouns, names that cannot move the cursor.

use crate::identify::write_experiment;
use crate::testkit::{Run, hovertone, steady_hover, text, write_hover};
use hovertone_vehicle::RotorSpeed;
use std::fs;

fn lines(run: &Run) -> Vec<&str> {
    run.stderr.lines().filter(|line| !line.is_empty()).collect()
}

#[test]
fn a_refusal_is_one_line_with_the_file_first_and_the_advice_last() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, content: &str| {
        let path = folder.path().join(name);
        fs::write(&path, content).unwrap();
        path
    };
    let (missing, table, results) =
        (folder.path().join("none.csv"), write("a.csv", "rpm,volts\n1,2\n"), write("r.json", "{}"));
    for (arguments, file, code) in [
        (vec!["fit", text(&missing)], Some(&missing), 1),
        (vec!["fit", text(&table)], Some(&table), 2),
        (vec!["export", text(&results), "--to", "gazebo"], Some(&results), 1),
        (vec!["identify", text(&missing)], Some(&missing), 1),
        (vec!["speed", "--vehicle", "ardron", text(&table)], None, 2),
        (vec!["fit", "--plan", "--mass-kg", "0.4", "--wanted-share", "2"], None, 2),
    ] {
        let run = hovertone(&arguments).ends_with(code);
        let said = lines(&run);
        let [line] = said.as_slice() else { panic!("{arguments:?}:\n{}", run.stderr) };
        let begin = file.map_or("error: ".to_owned(), |file| format!("error: {}: ", file.display()));
        assert!(line.starts_with(&begin), "{line}");
        assert!(line.contains(" (hint: ") && line.ends_with(')'), "{line}");
    }
    let run = hovertone(&["speed", "--vehicle", "ardrone", text(&missing)]).ends_with(1);
    assert!(lines(&run)[0].starts_with(&format!("error: {}: ", missing.display())), "{}", run.stderr);
}

#[test]
fn a_warning_is_one_line_with_its_advice() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("a.csv");
    fs::write(&table, "rpm,mass_g,mass_std_g\n3600,413,1\n").unwrap();
    let run = hovertone(&["fit", text(&table)]).ends_with(0);
    assert!(!lines(&run).is_empty());
    for line in lines(&run) {
        assert!(line.starts_with("warning: ") && line.contains(" (hint: "), "{line}");
    }
}

/// One and several: the noun follows the number.
#[test]
fn counts_agree_with_their_nouns() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = write_experiment(folder.path());
    let several = hovertone(&["identify", &experiment]).ends_with(0);
    assert!(
        several.stdout.contains("4 rotors, ") && several.stdout.contains("2 loads, 4 recordings, "),
        "{}",
        several.stdout
    );
    let table = folder.path().join("a.csv");
    fs::write(&table, "rpm,mass_g,mass_std_g\n3600,413,1\n").unwrap();
    let one_row = hovertone(&["fit", text(&table)]).ends_with(0).stdout;
    assert!(one_row.contains("\n1 table row, "), "{one_row}");
    let only = fs::read_to_string(&experiment).unwrap().replace("load0/*.wav", "load0/trial0.wav");
    let (only, _) = only.split_once("[[load]]\nname = \"l1\"").unwrap();
    fs::write(&experiment, only).unwrap();
    let one = hovertone(&["identify", &experiment]).ends_with(0);
    assert!(one.stdout.contains("; 1 load, 1 recording, "), "{}", one.stdout);
    assert!(one.stdout.contains("verdict: not tested: "), "{}", one.stdout);
}

#[cfg(unix)]
#[test]
fn names_cannot_move_the_cursor_and_lose_the_folder_that_they_share() {
    let folder = tempfile::tempdir().unwrap();
    let names = ["a\u{1b}[2Jb.wav", "two\nlines.wav", "漢字.wav"];
    let paths = names.map(|name| folder.path().join(name));
    for path in &paths {
        let mut settings = steady_hover("crazyflie", RotorSpeed::from_rev_s(300.0), 2.0);
        settings.rotors.truncate(1);
        write_hover(path, settings);
    }
    let mut arguments = vec!["speed", "--blades", "2", "--rotors", "1"];
    arguments.extend(paths.iter().map(|path| text(path)));
    let run = hovertone(&arguments).ends_with(0);
    assert!(!run.stdout.contains('\u{1b}') && !run.stderr.contains('\u{1b}'), "{}{}", run.stdout, run.stderr);
    for shown in ["\na\\u{1b}[2Jb.wav ", "\ntwo\\nlines.wav ", "\n漢字.wav "] {
        assert!(run.stdout.contains(shown), "{shown:?}:\n{}", run.stdout);
    }
    assert!(run.stdout.ends_with(&format!("\nfiles in {}/\n", folder.path().display())), "{}", run.stdout);
    let alone = hovertone(&["speed", "--blades", "2", "--rotors", "1", text(&paths[2])]).ends_with(0).stdout;
    assert!(alone.contains(text(&paths[2])), "a single name stays as it was typed:\n{alone}");
    // the command line stands in a comment of the experiment that it means
    for path in &paths {
        let mass = format!("0.03={}", text(path));
        let run = hovertone(&["identify", "--vehicle", "crazyflie", "--mass", &mass, "--check"]).ends_with(0);
        assert!(!run.stdout.contains('\u{1b}') && !run.stderr.contains('\u{1b}'), "{}{}", run.stdout, run.stderr);
    }
}

#[test]
fn names_of_loads_cannot_move_the_cursor() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = write_experiment(folder.path());
    let hostile = fs::read_to_string(&experiment).unwrap().replace("\"l1\"", "\"l\\u001b[2J1\"");
    fs::write(&experiment, hostile.replace("added_mass_kg = 0.05", "added_mass_kg = 0.15")).unwrap();
    let run = hovertone(&["identify", &experiment, "-v"]).ends_with(0);
    assert!(!run.stdout.contains('\u{1b}') && !run.stderr.contains('\u{1b}'), "{}{}", run.stdout, run.stderr);
    assert!(run.stderr.contains("load \"l\\u{1b}[2J1\" does not fit"), "{}", run.stderr);
    let verdict = run.stdout.lines().find(|line| line.starts_with("verdict: ")).unwrap();
    assert!(verdict.contains("not fit") && verdict.contains("l\\u{1b}[2J1"), "{verdict}");
}
