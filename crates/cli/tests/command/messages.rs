//! What the messages look like: one line each, the file first, counts that agree with their nouns, names that cannot move the cursor.

use crate::identify::write_experiment;
use crate::testkit::{Run, hovertone, hovertone_with, steady_bench, steady_hover, text, write_hover};
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
    let load = |name: &str| format!("[[load]]\nname = \"{name}\"\nrecordings = [\"{name}/*.mov\"]\n");
    let experiment = write("e.toml", &format!("[vehicle]\npreset = \"ardrone\"\n{}{}", load("big"), load("small")));
    for (arguments, file, code) in [
        (vec!["identify", text(&experiment)], Some(&experiment), 1),
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

/// The words of the parser do not reach the user: the fault, and what is needed.
#[test]
fn faults_of_a_file_are_told_in_plain_words() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("x.toml");
    let said = |command: &[&str], content: &str| {
        fs::write(&file, content).unwrap();
        let run = hovertone(&[command, &[text(&file)]].concat()).ends_with(2);
        for word in
            ["field", "struct ", "variant", "invalid", "f64", "u32", "expected", "sequence", "map", "tuple", "array"]
        {
            assert!(!run.stderr.contains(word), "{word}: {}", run.stderr);
        }
        run.stderr
    };
    let vehicle = "[vehicle]\npreset = \"ardrone\"\n";
    for (command, content, words) in [
        (
            "identify",
            "[[load]]\nname = \"a\"\n".to_owned(),
            ["the experiment file lacks \"recordings\"", "hint: add \"recordings\""],
        ),
        ("identify", format!("{vehicle}[[load]]\nrecordings = [\"a\"]\n"), ["lacks \"name\"", "identify --help"]),
        (
            "identify",
            format!("{vehicle}mass_kg = \"0.4\"\n"),
            ["has \"0.4\" where a number is needed", "write a number"],
        ),
        ("identify", format!("{vehicle}mass_kg = 0,4\n"), ["something after the value", "write decimals with a point"]),
        (
            "identify",
            format!("{vehicle}rotors = 4.5\n"),
            ["has 4.5 where a positive whole number", "write a positive whole number; "],
        ),
        ("identify", format!("{vehicle}gear = 8\n"), ["has 8 where a table", "{ key = value"]),
        ("identify", format!("{vehicle}[load]\nname = \"a\"\n"), ["one table where a list", "[[load]]"]),
        ("identify", format!("{vehicle}mas_kg = 1\n"), ["unknown key \"mas_kg\"", "did you mean \"mass_kg\""]),
        ("simulate", "[[microphone]]\n".to_owned(), ["the scenario file lacks \"position_m\"", "simulate --help"]),
        (
            "simulate",
            "[[microphone]]\nposition_m = [1, 2]\n".to_owned(),
            ["a list of 2 where a list of 3 numbers", "docs/formats.md"],
        ),
        (
            "vehicles --add",
            "[x]\nblades = 2\n".to_owned(),
            ["the file of vehicles lacks \"rotors\"", "vehicles --help"],
        ),
    ] {
        let stderr = said(&command.split(' ').collect::<Vec<_>>(), &content);
        words.iter().for_each(|word| assert!(stderr.contains(word), "{word}:\n{stderr}"));
    }
}

#[test]
fn a_warning_is_one_line_with_its_advice() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("a.csv");
    fs::write(&table, "rpm,mass_g,mass_std_g\n3600,413,1\n").unwrap();
    let run = hovertone(&["fit", text(&table)]).ends_with(0);
    let said = lines(&run);
    let [count, warnings @ ..] = said.as_slice() else { panic!("no warning") };
    assert_eq!(
        *count,
        if warnings.len() == 1 { "1 warning".to_owned() } else { format!("{} warnings", warnings.len()) }
    );
    assert!(!warnings.is_empty());
    for line in warnings {
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
    assert!(one_row.contains("\n1 table row used: "), "{one_row}");
    let only = fs::read_to_string(&experiment).unwrap().replace("load0/*.wav", "load0/trial0.wav");
    let (only, _) = only.split_once("[[load]]\nname = \"l1\"").unwrap();
    fs::write(&experiment, only).unwrap();
    let one = hovertone(&["identify", &experiment]).ends_with(0);
    assert!(one.stdout.contains("; 1 load, 1 recording, "), "{}", one.stdout);
    assert!(one.stdout.contains("verdict: whether the loads agree was not tested, because "), "{}", one.stdout);
}

#[cfg(unix)]
#[test]
fn names_cannot_move_the_cursor_and_lose_the_folder_that_they_share() {
    let folder = tempfile::tempdir().unwrap();
    let names = ["a\u{1b}[2Jb.wav", "two\nlines.wav", "漢字.wav"];
    let paths = names.map(|name| folder.path().join(name));
    for path in &paths {
        let settings = steady_bench("crazyflie", RotorSpeed::from_rev_s(300.0), 2.0);
        write_hover(path, settings);
    }
    let mut arguments = vec!["speed", "--blades", "2", "--rotors", "1"];
    arguments.extend(paths.iter().map(|path| text(path)));
    let run = hovertone(&arguments).ends_with(0);
    assert!(!run.stdout.contains('\u{1b}') && !run.stderr.contains('\u{1b}'), "{}{}", run.stdout, run.stderr);
    for shown in ["\na\\u{1b}[2Jb.wav ", "\ntwo\\nlines.wav ", "\n漢字.wav "] {
        assert!(run.stdout.contains(shown), "{shown:?}:\n{}", run.stdout);
    }
    assert!(run.stdout.contains(&format!("\nfiles in {}/\n", folder.path().display())), "{}", run.stdout);
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
    let run = hovertone(&["identify", &experiment, "-v"]).ends_with(3);
    assert!(!run.stdout.contains('\u{1b}') && !run.stderr.contains('\u{1b}'), "{}{}", run.stdout, run.stderr);
    assert!(run.stderr.contains("the loads do not fit each other: l0, l\\u{1b}[2J1"), "{}", run.stderr);
    let verdict = run.stdout.lines().find(|line| line.starts_with("verdict: ")).unwrap();
    assert!(verdict.contains("not fit") && verdict.contains("l\\u{1b}[2J1"), "{verdict}");
}

/// A value that no flag takes, a word too many, a negative number: one line, and our own words.
#[test]
fn wrong_use_is_one_line_with_the_reason_and_the_advice() {
    for (arguments, said) in [
        ("speed a.wav --mass-kg -1", "error: mass_kg = -1, but it must be from 0.001 to 10000 (hint: "),
        ("speed a.wav --blades 13", "error: --blades 13: must be a whole number from 1 to 12 (hint: "),
        ("speed a.wav --rotors -1", "error: --rotors -1: must be a whole number, 1 or more (hint: "),
        ("speed a.wav --harmonics -1", "error: --harmonics -1: must be a whole number, 1 or more (hint: "),
        ("speed a.wav --channel -1", "error: --channel -1: must be a whole number, counted from 1 (hint: "),
        ("fit --plan --mass-kg -1", "error: mass_kg = -1"),
        ("fit a.csv --rotors -4", "error: --rotors -4: must be a whole number from 1 to 12 (hint: "),
        ("identify --vehicle ardrone --mass -1 a.wav", "error: --mass -1: "),
        ("identify --vehicle ardrone --mass -0.4=a.wav", "error: --mass -0.4=a.wav: this value cannot be negative"),
        ("init --diameter-m -1 --vehicle ardrone --mass 1=a.wav", "error: diameter_m = -1"),
        ("speed a.wav --method guess", "error: --method guess: there is no such value (hint: give one of: "),
        (
            "speed a.wav --method maximum",
            "error: --method maximum: there is no such value (hint: did you mean maximum_trace? Give one of: ",
        ),
        (
            "identify --vehicle ardrone hover.mov",
            "error: the mass of the vehicle in the recording is missing (hint: write each recording directly after \
             its mass, as in --mass 413g hover.mov)",
        ),
        (
            "identify --mass 413g --vehicle ardrone hover.mov",
            "error: a file without a mass before it counts as the experiment file (hint: write each recording directly after its \
             mass, as in --mass 413g hover.mov, and all other flags before --mass)",
        ),
        ("speed a.wav --no-such-flag", "error: there is no flag --no-such-flag (hint: "),
        (
            "verify a.wav --log b.csv",
            "error: there is no flag --log (hint: write the log after the recording, without a flag)",
        ),
        ("sped a.wav", "error: there is no command \"sped\" (hint: did you mean speed?)"),
        ("export a.json", "error: export needs a format (--to FORMAT) or a model (--into MODEL) (hint: "),
    ] {
        let run = hovertone(&arguments.split(' ').collect::<Vec<_>>()).ends_with(2);
        let all = lines(&run);
        assert!(all.len() == 1 && all[0].starts_with(said) && all[0].ends_with(')'), "{arguments}:\n{}", run.stderr);
        assert!(run.stdout.is_empty(), "{arguments}");
    }
}

/// A number out of its range: its name, its value, and the allowed values, in one form for all commands and files.
#[test]
fn a_number_out_of_range_is_told_in_one_form() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, content: &str| {
        fs::write(folder.path().join(name), content).unwrap();
        folder.path().join(name).display().to_string()
    };
    let results =
        write("r.json", "{\"thrust_constant_per_rotor_n_s2\": {\"value\": 7e-6}, \"rotor_count\": 4, \"methods\": {}}");
    let vehicle = "[[load]]\nname = \"a\"\nrecordings = [\"a.wav\"]\n[vehicle]\npreset = \"ardrone\"\n";
    let far = write("far.toml", &format!("{vehicle}latitude_deg = 95.0\n"));
    let light = write("light.toml", &format!("{vehicle}gravity_m_s2 = 8.0\n"));
    let large = write("large.toml", &format!("{vehicle}propeller_diameter_m = 254.0\n"));
    let scenario = write("s.toml", "duration_s = -1.0\n");
    let weigh = "weigh a.wav --vehicle ardrone --constant-n-s2";
    for (arguments, said) in [
        (format!("{weigh} -1"), "constant_n_s2 = -1, but it must be a number above 0"),
        (format!("{weigh} 2.83e-5 --constant-std-n-s2 nan"), "constant_std_n_s2 = NaN, but it must be 0 or more"),
        (format!("{weigh} 2.83e-5 --latitude-deg 95"), "latitude_deg = 95, but it must be from -90 to 90"),
        (format!("{weigh} 2.83e-5 --gravity-m-s2 8"), "gravity_m_s2 = 8, but it must be from 9.7 to 9.9, because"),
        ("fit a.csv --diameter-m 254".to_owned(), "diameter_m = 254, but it must be from 0.01 to 10"),
        ("fit --plan --mass-kg 1 --diameter-m 254".to_owned(), "diameter_m = 254, but it must be from 0.01 to 10"),
        ("speed a.wav --diameter-m 254".to_owned(), "diameter_m = 254, but it must be from 0.01 to 10"),
        ("speed a.wav --blades 2 --from nan".to_owned(), "--from = NaN, but it must be 0 or more"),
        (
            "init --vehicle ardrone --diameter-m 254 --mass 1=a.wav".to_owned(),
            "diameter_m = 254, but it must be from 0.01 to 10",
        ),
        (
            "calibrate a.wav --blades 2 --tachometer-rpm 1".to_owned(),
            "tachometer_rpm = 1, but it must be from 60 to 90000",
        ),
        (
            "calibrate a.wav --blades 2 --tachometer-rpm 3600 --clock-ppm -1".to_owned(),
            "clock_ppm = -1, but it must be from 0 to 1000000",
        ),
        (format!("export {results} --to gazebo --hover-command 2"), "hover_command = 2, but it must be from 0 to 1"),
        (format!("export {results} --to gazebo --diameter-m 254"), "diameter_m = 254, but it must be from 0.01 to 10"),
        (format!("identify {far}"), "vehicle.latitude_deg = 95, but it must be from -90 to 90"),
        (format!("identify {light}"), "vehicle.gravity_m_s2 = 8, but it must be from 9.7 to 9.9, because no place"),
        (format!("identify {large}"), "vehicle.propeller_diameter_m = 254, but it must be from 0.01 to 10"),
        (format!("simulate {scenario}"), "duration_s = -1, but it must be above 0"),
    ] {
        let run = hovertone(&arguments.split(' ').collect::<Vec<_>>()).ends_with(2);
        let all = lines(&run);
        assert!(all.len() == 1 && all[0].contains(said) && all[0].contains("(hint: "), "{arguments}:\n{}", run.stderr);
        assert!(!all[0].contains(" is -") && !all[0].contains(" is N"), "{}", run.stderr);
    }
}

#[test]
fn a_file_of_another_kind_is_named_without_the_words_of_a_parser() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, content: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, content).unwrap();
        path.display().to_string()
    };
    let (json, empty) = (write("a.json", b"{\"thrust_constant_per_rotor_n_s2\": 1}"), write("e.csv", b""));
    let results = write(
        "r.json",
        b"{\"thrust_constant_per_rotor_n_s2\": {\"value\": 1e-6}, \"rotor_count\": 1, \"methods\": {}}",
    );
    let model = write("m.sdf", b"<motorConstant>7.07e-06</motorConstant>");
    let (broken, sound) = (write("b.json", b"{\"a\": "), write("r.wav", &[255, 250, 0, 1]));
    let experiment = write("e.toml", b"# mine\n[vehicle]\npreset = \"ardrone\"\n\n[[load]]\nname = \"no hull\"\n");
    let scenario = write("s.toml", b"duration_s = 20.0\n\n[[maneuver]]\nkind = \"hover\"\n");
    for (arguments, code, said) in [
        (vec!["fit", &json], 1, "this file is JSON and no table"),
        (vec!["fit", &empty], 1, "this file is empty (hint: copy or download"),
        (vec!["fit", &experiment], 1, "this file is TOML and no table (hint: give a CSV file"),
        (vec!["log", &scenario], 1, "this file is TOML and no table (hint: give a CSV file"),
        (vec!["identify", &json], 1, "this file is JSON, so it cannot be the experiment file"),
        (vec!["export", &results, "--into", &results], 1, "this JSON is no model of a simulator"),
        (vec!["compare", &results, &results], 1, "this JSON is no model of a simulator"),
        (
            vec!["compare", &model, &results],
            2,
            "this is a model of a simulator, but results.json of `hovertone identify` is needed here",
        ),
        (vec!["export", &json, "--to", "gazebo", "--group", "x"], 2, "these results have no groups"),
        (vec!["export", &empty, "--to", "gazebo"], 1, "the file is empty"),
        (vec!["export", &broken, "--to", "gazebo"], 1, "the file ends too early, in line 1"),
        (vec!["export", &sound, "--to", "gazebo"], 1, "this file is not text, so it cannot be the results"),
    ] {
        let run = hovertone(&arguments).ends_with(code);
        assert_eq!(lines(&run).len(), 1, "{}", run.stderr);
        assert!(run.stderr.contains(said), "{said}:\n{}", run.stderr);
        for word in ["EOF", "column 0", "missing field", "?)", ": ?"] {
            assert!(!run.stderr.contains(word), "{word}:\n{}", run.stderr);
        }
    }
}

#[test]
fn an_experiment_and_a_scenario_are_told_from_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let (experiment, scenario) = (folder.path().join("e.toml"), folder.path().join("s.toml"));
    fs::write(&experiment, "[vehicle]\npreset = \"ardrone\"\n\n[[load]]\nname = \"no hull\"\n").unwrap();
    fs::write(&scenario, "duration_s = 20.0\n\n[[maneuver]]\nkind = \"hover\"\n").unwrap();
    let flown = hovertone(&["simulate", text(&experiment), "-o", text(&folder.path().join("out"))]).ends_with(1);
    assert!(
        flown
            .stderr
            .contains("this is an experiment file, and no scenario file (hint: `hovertone identify` takes this file"),
        "{}",
        flown.stderr
    );
    let heard = hovertone(&["identify", text(&scenario)]).ends_with(1);
    assert!(
        heard
            .stderr
            .contains("this is a scenario file, and no experiment file (hint: `hovertone simulate` takes this file"),
        "{}",
        heard.stderr
    );
}

/// Both streams as a terminal shows them.
#[cfg(unix)]
#[test]
fn what_weakens_an_answer_stands_on_top_counted() {
    let folder = tempfile::tempdir().unwrap();
    let (table, sound) = (folder.path().join("a.csv"), folder.path().join("a.wav"));
    fs::write(&table, "rpm,mass_g,mass_std_g\n3600,413,1\n").unwrap();
    write_hover(&sound, steady_hover("ardrone", RotorSpeed::from_rev_s(60.0), 3.0));
    for (arguments, answer) in [
        (vec!["fit", text(&table)], "C_f, one rotor"),
        (vec!["speed", "--vehicle", "ardrone", text(&sound)], "rev/s  "),
        (vec!["weigh", text(&sound), "--vehicle", "ardrone", "--constant-n-s2", "2.831e-5"], "mass as flown: "),
    ] {
        let both = std::process::Command::new("sh")
            .args(["-c", "\"$0\" \"$@\" 2>&1", env!("CARGO_BIN_EXE_hovertone")])
            .args(&arguments)
            .output()
            .unwrap();
        let said = String::from_utf8(both.stdout).unwrap();
        let count = said.lines().next().unwrap();
        let number: usize = count.split(' ').next().unwrap().parse().unwrap_or_else(|_| panic!("{said}"));
        assert!(count == "1 warning" || count.ends_with(" warnings"), "{said}");
        let (above, _) = said.split_once(answer).unwrap_or_else(|| panic!("{said}"));
        assert_eq!(above.matches("warning: ").count(), number, "{said}");
        assert_eq!(said.matches("warning: ").count(), number, "below the answer: {said}");
    }
}

/// The square law is kept, since no other is ten times as probable; but it has little of the probability itself.
#[test]
fn a_law_without_most_of_the_probability_is_not_preferred() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("a.csv");
    fs::write(&table, "rpm,thrust_g\n1000,5\n2000,21\n3000,52\n4000,90\n5000,140\n").unwrap();
    let said = hovertone(&["fit", text(&table)]).ends_with(0).stdout;
    assert!(!said.contains("(preferred)"), "{said}");
    assert!(
        said.contains(
            "no law is clearly the most probable, so none is preferred; C_f is the constant of the law F = C ω²"
        ),
        "{said}"
    );
}

/// A name that is no text is shown as well as it can be.
#[cfg(unix)]
#[test]
fn a_name_that_is_no_text_is_shown() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let odd = OsStr::from_bytes(b"bad\xff.wav");
    let run = hovertone_with(&["init", "--mass", "413g"], |command| command.arg(odd)).ends_with(2);
    for words in ["bad\u{fffd}.wav", "this word is not valid UTF-8 text", "rename the file"] {
        assert!(run.stderr.contains(words), "{words}: {}", run.stderr);
    }
}
