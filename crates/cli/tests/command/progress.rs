//! The progress bar in a terminal: no wider than it, and gone at the end.

use crate::report_fixture::write_rotor;
use crate::testkit::text;
use std::process::{Command, Stdio};

/// What a terminal of this width shows while a recording is analysed; `None` without `script`.
fn shown(columns: usize, recording: &str) -> Option<String> {
    let speed = format!(
        "stty cols {columns} rows 24; '{}' speed --blades 2 --rotors 1 '{recording}'",
        env!("CARGO_BIN_EXE_hovertone")
    );
    let run = Command::new("script").args(["-qec", &speed, "/dev/null"]).stdin(Stdio::null()).output();
    let Ok(output) = run else {
        println!("skipped: no `script` of util-linux");
        return None;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    Some(String::from_utf8(output.stdout).unwrap())
}

/// Text without the sequences that colour it or move the cursor.
fn plain(text: &str) -> String {
    let mut parts = text.split("\u{1b}[");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |plain, part| {
        plain
            + part
                .trim_start_matches(|letter: char| letter.is_ascii_digit() || ";?".contains(letter))
                .get(1..)
                .unwrap_or_default()
    })
}

#[test]
fn the_progress_bar_is_no_wider_than_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("hover.wav");
    write_rotor(&recording, 100.0, 0.0, 6.0, 1);
    for columns in [50, 71, 72, 80, 120] {
        let Some(shown) = shown(columns, text(&recording)) else { return };
        let bars: Vec<String> =
            shown.split(['\r', '\n']).map(plain).filter(|line| line.contains("listening to 1 recording")).collect();
        assert!(bars.iter().any(|bar| bar.contains(" %")), "no bar at {columns} columns:\n{shown}");
        for bar in bars {
            assert!(bar.chars().count() <= columns, "{columns} columns: {bar:?}");
            // before something is done, nobody knows the time that is left
            assert!(!bar.contains(" left") || columns >= 72 && !bar.contains("  0 %"), "{bar:?}");
        }
    }
}
