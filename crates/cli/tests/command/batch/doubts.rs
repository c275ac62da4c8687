//! Speeds of a batch that must not be used.

use super::table;
use crate::testkit::{hovertone, steady_hover, text, write_hover};
use arrow_array::cast::AsArray;
use hovertone_vehicle::RotorSpeed;
use std::fs;

/// A speed that contradicts the given vehicle is no sure one: the counts, the exit code, the table and the page say so.
#[test]
fn a_vehicle_that_the_sound_contradicts_is_not_hidden() {
    let folder = tempfile::tempdir().unwrap();
    let (archive, out) = (folder.path().join("archive"), folder.path().join("out"));
    fs::create_dir_all(&archive).unwrap();
    write_hover(&archive.join("one.wav"), steady_hover("crazyflie", RotorSpeed::from_rev_s(95.0), 10.0));
    let run = hovertone(&["batch", text(&archive), "-o", text(&out), "--vehicle", "ardrone"]).ends_with(3);
    let speed = hovertone(&["speed", text(&archive.join("one.wav")), "--vehicle", "ardrone"]).ends_with(3);
    let row = speed.stdout.lines().find(|line| line.contains("do not use th")).unwrap_or_default();
    assert!(row.ends_with("the sound contradicts the given facts"), "{}", speed.stdout);
    assert!(run.stdout.starts_with("1 recording: 1 with a speed (1 of them with warnings), "), "{}", run.stdout);
    assert!(run.stderr.contains("1 recording has a speed that contradicts the given facts: "), "{}", run.stderr);
    assert!(table(&out.join("recordings.parquet")).column_by_name("is_doubtful").unwrap().as_boolean().value(0));
    let page = fs::read_to_string(out.join("overview.html")).unwrap();
    assert!(page.contains("title=\"do not use\"") && page.contains("the speed may come from another sound"), "{page}");
}
