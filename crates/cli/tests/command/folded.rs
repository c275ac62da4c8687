//! A warning that several recordings have is one line with their names, in the terminal and in the page.

use crate::report_fixture::write_rotor;
use crate::testkit::{Run, hovertone, text, write_wav};
use std::fs;
use std::path::Path;

const SHORT: &str = "is shorter than one sample";
/// A hover that holds samples of 2 s, and one that does not.
const LONG_S: f64 = 2.8;
const SHORT_S: f64 = 1.5;

/// Seconds of the rotor in each recording; 0 is silence. Gives the run and the page.
fn identified(folder: &Path, lengths_s: &[f64]) -> (Run, String) {
    let names: Vec<String> = (1..=lengths_s.len()).map(|number| format!("trial_{number}.wav")).collect();
    for ((seed, name), &length_s) in (0..).zip(&names).zip(lengths_s) {
        match length_s {
            0.0 => write_wav(&folder.join(name), &vec![0.0; 32_000 + 1600 * seed as usize], 16_000),
            _ => write_rotor(&folder.join(name), 100.0, 0.0, length_s, seed),
        }
    }
    let listed = names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
    let experiment = format!(
        "[vehicle]\nrotors = 1\nblades = 2\nmass_kg = 0.5\n[tone]\norder = 2\n[samples]\nlength_s = 2.0\n\
         [[load]]\nname = \"bare\"\nadded_mass_kg = 0\nrecordings = [{listed}]\n"
    );
    fs::write(folder.join("experiment.toml"), experiment).unwrap();
    let out = folder.join("out");
    let run = hovertone(&["identify", text(&folder.join("experiment.toml")), "-o", text(&out)]);
    let page = fs::read_to_string(out.join("report.html")).unwrap_or_else(|_| panic!("{}", run.stderr));
    (run, page)
}

/// Number of warnings and of lines about missing speeds: both weaken the constant.
fn lines_told(stderr: &str) -> usize {
    ["warning: ", "no rotor tone: "].iter().map(|label| stderr.matches(label).count()).sum()
}

/// Asserts that terminal and page have as many lines as they count.
fn assert_counted(run: &Run, page: &str, count: usize) {
    let counted = format!("{count} {}", if count == 1 { "warning" } else { "warnings" });
    assert_eq!(run.stderr.lines().next().unwrap(), counted, "{}", run.stderr);
    assert_eq!(lines_told(&run.stderr), count, "{}", run.stderr);
    assert!(page.contains(&format!("<p class=\"status\">⚠ <b>{counted}</b></p>")), "{counted}");
    let (_, lines) = page.split_once("<div class=\"warnings\"").unwrap();
    let (lines, _) = lines.split_once("</div>").unwrap();
    assert_eq!(lines.matches("<li>").count(), count, "{lines}");
}

#[test]
fn a_warning_of_most_recordings_is_one_line_with_the_exceptions() {
    let folder = tempfile::tempdir().unwrap();
    let (run, page) =
        identified(folder.path(), &[SHORT_S, SHORT_S, LONG_S, SHORT_S, SHORT_S, SHORT_S, SHORT_S, 0.0, 0.0]);
    let run = run.ends_with(3);
    let words = [
        "used as one sample (in 6 of 9 recordings: all but trial_3.wav, trial_8.wav, trial_9.wav)",
        " (in 2 of 9 recordings: trial_8.wav, trial_9.wav)",
    ];
    for words in words {
        assert_eq!(run.stderr.matches(words).count(), 1, "{}", run.stderr);
        // with the advice at the recordings; in the answer their number alone, where the names have no room
        assert_eq!(page.matches(words).count(), 1, "{words}");
        let counted = format!("{})", words[words.find("(in").unwrap()..].split(':').next().unwrap());
        let lines = run.stderr.matches(counted.trim_end_matches(')')).count();
        assert_eq!(page.matches(&counted).count(), lines, "{counted}");
    }
    assert_eq!(run.stderr.matches(SHORT).count(), 1, "{}", run.stderr);
    let marks = |meaning: &str| page.matches(&format!("data-sort=\"{meaning}\"")).count();
    assert_eq!((marks("has warnings"), marks("without warnings"), marks("no speed")), (6, 1, 2));
    assert_counted(&run, &page, lines_told(&run.stderr));
}

/// What is cut from recordings for the same reasons is one line; of two recordings each has its own, with the times.
#[test]
fn cuts_of_several_recordings_are_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let names: Vec<String> = (0..3u32)
        .map(|number| {
            let path = folder.path().join(format!("{number}.wav"));
            write_rotor(&path, 100.0, 2.0 + 0.5 * f64::from(number), 3.0, number);
            text(&path).to_owned()
        })
        .collect();
    let speed = |names: &[String]| {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        hovertone(&[&["speed", "--blades", "2", "--rotors", "1"], &names[..]].concat()).ends_with(0).stderr
    };
    let three = speed(&names);
    assert_eq!(three.matches("cut").count(), 1, "{three}");
    assert!(three.contains("s each: silence, transition to or from the hover (in all 3 recordings)"), "{three}");
    let two = speed(&names[..2]);
    assert_eq!(two.matches("  cut 0.0–").count(), 2, "{two}");
}

/// A recording is not "without warnings" below a warning of all recordings.
#[test]
fn a_warning_of_all_recordings_is_contradicted_by_none() {
    let folder = tempfile::tempdir().unwrap();
    let (run, page) = identified(folder.path(), &[SHORT_S; 4]);
    assert!(run.stderr.contains("used as one sample (in all 4 recordings)"), "{}", run.stderr);
    assert!(!page.contains("without warnings"));
    let lines = run.stderr.matches("warning: ").count();
    assert_counted(&run, &page, lines);
    // of two recordings, what both have in the same words is told once
    let folder = tempfile::tempdir().unwrap();
    let (run, page) = identified(folder.path(), &[SHORT_S; 2]);
    assert!(run.stderr.contains("used as one sample (in both recordings)"), "{}", run.stderr);
    let lines = run.stderr.matches("warning: ").count();
    assert_counted(&run, &page, lines);
}
