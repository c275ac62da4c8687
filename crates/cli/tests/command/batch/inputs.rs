//! What a batch is of: lists, patterns and names, in any spelling.

use super::{batch, table, texts, write_archive};
use crate::testkit::{Run, hovertone_with, refused_with, text};
use std::fs::{self, File};
use std::path::Path;

#[test]
fn lists_patterns_and_names_are_inputs_and_a_missing_one_is_a_row() {
    let folder = tempfile::tempdir().unwrap();
    let archive = folder.path().join("archive");
    write_archive(&archive, 4);
    let list = folder.path().join("list.txt");
    fs::write(&list, "# my flights\narchive/flight 1/1.wav\n\narchive/gone.wav\narchive/flight 0\n").unwrap();
    let out = folder.path().join("listed");
    let said = batch(&list, &out, &[]).ends_with(3).stderr;
    assert!(said.contains("error: ") && said.contains("archive/gone.wav: "), "{said}");
    let rows = table(&out.join("recordings.parquet"));
    assert_eq!(texts(&rows, "error_class"), ["not_a_file", "", "not_found"]);
    let pattern = folder.path().join("archive/*/*.wav");
    batch(&pattern, &folder.path().join("matched"), &[]).ends_with(0);
    assert_eq!(table(&folder.path().join("matched/recordings.parquet")).num_rows(), 4);
    // a pattern of folders means their recordings
    let folders = folder.path().join("arch*");
    batch(&folders, &folder.path().join("of folders"), &[]).ends_with(0);
    assert_eq!(table(&folder.path().join("of folders/recordings.parquet")).num_rows(), 4);
    fs::create_dir_all(folder.path().join("empty")).unwrap();
    fs::create_dir_all(folder.path().join("notes")).unwrap();
    fs::write(folder.path().join("notes/a.txt"), "").unwrap();
    for (input, words) in [
        ("archive/*.flac", "no file matches"),
        ("nowhere", "no such file"),
        ("empty", "has no recordings"),
        ("not*", "the folders that match this pattern have no recordings"),
    ] {
        let run = hovertone_with(&["batch", input, "-o", "none"], |command| command.current_dir(folder.path()));
        assert!(run.code == 1 && run.stderr.contains(words), "{input}: {} {}", run.code, run.stderr);
        assert!(!folder.path().join("none").exists());
    }
    let words = ["batch", text(&archive), "-o", "none", "--shard"];
    refused_with(&[&words[..], &["3/2"]].concat(), &["--shard", "there are 2 jobs, so write 1/2 or 2/2"]);
    refused_with(&[&words[..], &["1/2", "--force"]].concat(), &["other jobs"]);
}

/// Some editors write a byte-order mark before the first name.
#[test]
fn the_first_name_of_a_list_with_a_byte_order_mark_is_found() {
    let folder = tempfile::tempdir().unwrap();
    write_archive(&folder.path().join("archive"), 2);
    let (list, out) = (folder.path().join("list.txt"), folder.path().join("out"));
    fs::write(&list, "\u{feff}archive/flight 0/0.wav\r\narchive/flight 1/1.wav\r\n").unwrap();
    batch(&list, &out, &[]).ends_with(0);
    let rows = table(&out.join("recordings.parquet"));
    assert!(rows.num_rows() == 2 && texts(&rows, "file")[0].ends_with("archive/flight 0/0.wav"));
}

/// Runs `batch` in a folder, with text as stdin.
fn batch_in(folder: &Path, inputs: &[&str], stdin: &str) -> Run {
    let place = folder.join("stdin");
    fs::write(&place, stdin).unwrap();
    let words = [&["batch"], inputs, &["-o", "out", "--blades", "2", "--rotors", "1"]].concat();
    hovertone_with(&words, |command| command.current_dir(folder).stdin(File::open(&place).unwrap()))
}

#[test]
fn a_recording_has_one_row_however_its_name_is_spelled() {
    let folder = tempfile::tempdir().unwrap();
    let (archive, out) = (folder.path().join("a"), folder.path().join("out/recordings.parquet"));
    write_archive(&archive, 4);
    batch_in(folder.path(), &["a", "./a", "a/flight 0", text(&archive)], "").ends_with(0);
    let files = texts(&table(&out), "file");
    assert_eq!(files, ["a/flight 0/0.wav", "a/flight 0/3.wav", "a/flight 1/1.wav", "a/flight 2/2.wav"]);
    fs::remove_dir_all(folder.path().join("out")).unwrap();
    batch_in(folder.path(), &["a"], "").ends_with(0);
    for same in ["a/", "./a", "a/../a", text(&archive)] {
        let run = batch_in(folder.path(), &[same], "").ends_with(0);
        assert!(run.stdout.contains("analysed in this run: 0"), "{same}: {}", run.stdout);
        assert_eq!(texts(&table(&out), "file"), files, "{same}");
    }
    let run = batch_in(folder.path(), &["a/flight 0"], "");
    assert!(run.code == 2 && run.stderr.contains("other recordings"), "{}", run.stderr);
    fs::remove_dir_all(folder.path().join("out")).unwrap();
    // names that lead nowhere are the same name, too
    batch_in(folder.path(), &["-"], "a/gone.wav\n./a/gone.wav\na/flight 1/../gone.wav\n").ends_with(3);
    assert_eq!(texts(&table(&out), "file"), ["a/gone.wav"]);
}

#[test]
fn another_list_from_stdin_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    write_archive(&folder.path().join("a"), 3);
    let out = folder.path().join("out/recordings.parquet");
    batch_in(folder.path(), &["-"], "a/flight 0/0.wav\na/flight 1/1.wav\n").ends_with(0);
    let before = fs::read(&out).unwrap();
    batch_in(folder.path(), &["-"], "a/flight 1/1.wav\na/flight 0/0.wav\n").ends_with(0);
    assert_eq!(fs::read(&out).unwrap(), before, "the order of the names is free");
    let run = batch_in(folder.path(), &["-"], "a/flight 2/2.wav\n");
    for words in
        ["other recordings or settings", "list: 2 names (SHA-256 ", " in the earlier run, 1 name (SHA-256 ", "--force"]
    {
        assert!(run.code == 2 && run.stderr.contains(words), "{words}: {} {}", run.code, run.stderr);
    }
    assert_eq!(fs::read(&out).unwrap(), before);
    batch_in(folder.path(), &["-", "--force"], "a/flight 2/2.wav\n").ends_with(0);
    assert_eq!(texts(&table(&out), "file"), ["a/flight 2/2.wav"]);
}
