//! Every flag with a number, of every command, as its help lists them: what no recording, rotor or place has is refused.

use crate::contradictions::results_of_four_rotors;
use crate::testkit::{hovertone, hovertone_with, text, write_noise};
use std::fs;

/// Names of values that are numbers, in the help.
const NUMBERS: [&str; 18] = [
    "N", "X", "M", "KG", "PPM", "M/S", "S", "SHARE", "DEG", "M/S2", "C", "HPA", "PERCENT", "N_S2", "HZ", "RPM", "TIME",
    "LOW:HIGH",
];
const ABSURD: [&str; 3] = ["nan", "1000000000", "-1000000000"];
/// A clock may count its seconds from 1970.
const ABSURD_OFFSETS: [&str; 3] = ["nan", "100000000000", "-100000000000"];
/// Both limits of an offset, the wrong way round, and the whole of time.
const ABSURD_SPANS: [&str; 3] = ["nan:1", "5:-5", "0:100000000000"];
/// Any seed has a meaning; a track, a channel or a time may be in a recording, which this test does not read.
const MEANINGFUL: [&str; 5] = ["--seed", "--audio-track", "--channel", "--from", "--to"];
/// Commands that end before they hear anything: the recording or the table is not there.
const COMMANDS: [&str; 20] = [
    "speed nowhere.wav --blades 2",
    "speed nowhere.wav --vehicle ardrone",
    "tones nowhere.wav",
    "spectrogram nowhere.wav --blades 2 -o x.png",
    "identify missing.toml",
    "identify --vehicle ardrone --mass 413g=nowhere.wav",
    "init --vehicle ardrone --mass 413g=a.wav -o new.toml --force",
    "calibrate nowhere.wav --blades 2 --true-hz 400",
    "calibrate nowhere.wav --blades 2 --tachometer-rpm 3600",
    "fit nowhere.csv",
    "fit --plan --mass-kg 0.413 --diameter-m 0.2",
    "weigh nowhere.wav --constant results.json --mass-kg 0.413 --latitude-deg 50",
    "weigh nowhere.wav --vehicle ardrone --constant-n-s2 2.83e-5 --mass-kg 0.413",
    "log nowhere.csv",
    "motor nowhere.csv --commands steps.csv --blades 2",
    "motor nowhere.wav --commands steps.csv --vehicle ardrone",
    "verify nowhere.wav steps.csv --blades 2",
    "verify nowhere.wav steps.csv --vehicle ardrone",
    "greybox nowhere.csv --vehicle ardrone",
    "greybox nowhere.wav nowhere.csv --vehicle ardrone",
];

/// The flags of a command whose values are numbers.
fn flags_with_numbers(command: &str) -> Vec<String> {
    let help = hovertone(&[command, "--help"]).ends_with(0).stdout;
    let flag = |line: &str| {
        let (flag, value) = line[line.find("--")?..].split_once(" <")?;
        let is_flag = !flag.contains(' ') && line.trim_start().starts_with('-');
        let is_number = NUMBERS.contains(&value.split_once('>')?.0);
        (is_flag && is_number && !MEANINGFUL.contains(&flag)).then(|| flag.to_owned())
    };
    help.lines().filter_map(flag).collect()
}

#[test]
fn absurd_numbers_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    write_noise(&folder.path().join("a.wav"), 0.5);
    results_of_four_rotors(folder.path());
    let experiment = "[vehicle]\npreset = \"ardrone\"\n[[load]]\nname = \"a\"\nrecordings = [\"nowhere.wav\"]\n";
    fs::write(folder.path().join("missing.toml"), experiment).unwrap();
    fs::write(folder.path().join("steps.csv"), "time_s,rotor1_rpm,motor1_pwm\n0,600,1000\n1,660,1100\n").unwrap();
    let (mut wrong, mut tried) = (Vec::new(), 0);
    for command in COMMANDS {
        let words: Vec<&str> = command.split(' ').collect();
        let run = |arguments: &[&str]| hovertone_with(arguments, |command| command.current_dir(folder.path()));
        assert_ne!(run(&words).code, 2, "{command}: {}", run(&words).stderr);
        for flag in flags_with_numbers(words[0]) {
            let said = words.iter().position(|word| *word == flag);
            let others =
                words.iter().enumerate().filter(|(index, _)| said.is_none_or(|at| !(at..=at + 1).contains(index)));
            let others: Vec<&str> = others.map(|(_, word)| *word).collect();
            let absurd = match flag.as_str() {
                "--offset" => ABSURD_OFFSETS,
                "--log-offset-s" if words[0] == "greybox" => ABSURD_OFFSETS,
                "--log-offset-s" => ABSURD_SPANS,
                _ => ABSURD,
            };
            for value in absurd {
                let ended = run(&[&others[..], &[format!("{flag}={value}").as_str()]].concat());
                tried += 1;
                if ended.code != 2 || !ended.stdout.is_empty() || ended.stderr.lines().count() != 1 {
                    wrong.push(format!("{command} {flag}={value} ends with {}: {}", ended.code, ended.stderr.trim()));
                }
            }
        }
    }
    assert!(wrong.is_empty() && tried > 300, "of {tried}:\n{}", wrong.join("\n"));
}

/// Rows that lie on the law and have ten times their own size as uncertainty: the ± that was stated is to blame, not the scatter.
#[test]
fn stated_uncertainties_that_are_too_large_are_named_where_the_law_cannot_be_tested() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("stand.csv");
    let with = |thrust_std_n: f64, ending: i32| {
        let rows: String = [3000, 3600, 4200, 5000]
            .map(|rpm| format!("{rpm},{},{thrust_std_n}\n", 7.7e-8 * f64::from(rpm * rpm)))
            .concat();
        fs::write(&table, format!("rpm,thrust_n,thrust_std_n\n{rows}")).unwrap();
        hovertone(&["fit", text(&table)]).ends_with(ending).stderr
    };
    // the ± of the constant is larger than the constant
    let said = with(10.0, 3);
    assert!(
        said.contains("too uncertain to test F = C_f ω²")
            && said.contains("check whether the uncertainties in thrust_std_n are too large"),
        "{said}"
    );
    assert!(said.contains("the uncertainties that you stated"), "{said}");
    assert!(said.contains("the ± of C_f is larger than C_f itself"), "{said}");
    assert!(!with(0.001, 0).contains("too uncertain"), "{}", with(0.001, 0));
}

/// The weights of a fit would be lost in rounding: the row and the column are named, not a law.
#[test]
fn stated_uncertainties_beyond_all_measure_are_refused_by_their_row() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("stand.csv");
    for (thrust_std_g, how) in [("1e-200", "too small for a fit"), ("1e200", "too large for a fit")] {
        let rows = format!("3000,70,0.5\n3600,101,{thrust_std_g}\n4200,137,0.5\n5000,195,{thrust_std_g}\n");
        fs::write(&table, format!("rpm,thrust_g,thrust_std_g\n{rows}")).unwrap();
        let run = hovertone(&["fit", text(&table)]).ends_with(2);
        for words in ["line 3: the stated uncertainty is ", how, " times the force", "correct thrust_std_g in this row"]
        {
            assert!(run.stderr.contains(words), "{words}: {}", run.stderr);
        }
        let longest = run.stderr.split(|letter: char| !letter.is_ascii_digit()).map(str::len).max();
        assert!(longest.is_some_and(|longest| longest <= 12), "{}", run.stderr);
    }
    // uncertainties that are only too small are one of the causes that are named, and the rows are in their order
    let rows: String = [70, 101, 137, 200, 240, 330, 405]
        .into_iter()
        .zip([3000, 3600, 4200, 5000, 5600, 6400, 7300])
        .map(|(thrust_g, rpm)| format!("{rpm},{thrust_g},0.001\n"))
        .collect();
    fs::write(&table, format!("rpm,thrust_g,thrust_std_g\n{rows}")).unwrap();
    let said = hovertone(&["fit", text(&table)]).ends_with(3);
    assert!(said.stderr.contains("the uncertainties in column thrust_std_g may be too small"), "{}", said.stderr);
    assert!(!said.stdout.contains("too alike"), "{}", said.stdout);
    let line = said.stderr.lines().find(|line| line.contains("fits these rows")).unwrap_or_default();
    let named: Vec<u32> = line
        .split("line ")
        .skip(1)
        .filter_map(|rest| rest.split(|letter: char| !letter.is_ascii_digit()).next()?.parse().ok())
        .collect();
    assert!(named.len() > 3 && named.is_sorted(), "{line}");
}

#[test]
fn a_thrust_without_a_unit_is_told_how_to_name_it() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("stand.csv");
    fs::write(&table, "rpm,thrust\n3000,70\n3600,101\n4200,137\n").unwrap();
    let run = hovertone(&["fit", text(&table)]).ends_with(2);
    for words in ["column \"thrust\" has no unit", "write the unit into the header: thrust_g"] {
        assert!(run.stderr.contains(words), "{words}: {}", run.stderr);
    }
}
