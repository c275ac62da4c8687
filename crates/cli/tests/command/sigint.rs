//! Ctrl-C while a command works: the old files or the new ones stand, never half of one, and nothing temporary beside them.
#![cfg(unix)]

use crate::identify::write_experiment;
use crate::testkit::{files_in, hovertone, steady_hover, text, write_hover, write_noise};
use hovertone_vehicle::RotorSpeed;
use std::fs;
use std::io::{Read, Write};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const SIGINT: i32 = 2;
const UNFINISHED: &str = ".hovertone-unfinished";
/// Last part of the name of an empty file by which the jobs of one archive know each other.
const LOCK: &str = ".hovertone-lock";
/// What an interrupt says while results are written.
const INCOMPLETE: &str = "interrupted: the results in this folder are incomplete (hint: run the same command again)";
/// The user "nobody".
const NOBODY: u32 = 65_534;

/// Begins a command.
pub(crate) fn begun(arguments: &[&str], set_up: impl FnOnce(&mut Command) -> &mut Command) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hovertone"));
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    set_up(&mut command).spawn().unwrap()
}

/// Sends the interrupt of Ctrl-C and waits for the end. Returns whether the interrupt ended it, and what it said.
pub(crate) fn interrupted(mut run: Child) -> (bool, String) {
    let sent = Command::new("sh").args(["-c", &format!("kill -INT {}", run.id())]).stderr(Stdio::null()).status();
    sent.unwrap();
    let status = run.wait().unwrap();
    let mut said = String::new();
    run.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    (status.signal() == Some(SIGINT), said)
}

/// Waits until a run has begun to write a file somewhere in a folder.
pub(crate) fn wait_for_writing(run: &mut Child, folder: &Path) {
    let ending = format!(".{}{UNFINISHED}", run.id());
    let begun = Instant::now();
    while !all_files(folder).iter().any(|file| text(file).ends_with(&ending)) {
        assert!(run.try_wait().unwrap().is_none() && begun.elapsed() < Duration::from_secs(60), "it wrote nothing");
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// All files of a folder and of its folders.
pub(crate) fn all_files(folder: &Path) -> Vec<PathBuf> {
    let entries = folder.read_dir().into_iter().flatten().flatten().map(|entry| entry.path());
    entries.flat_map(|path| if path.is_dir() { all_files(&path) } else { vec![path] }).collect()
}

/// Every file of a folder, as far as its kind shows, is whole, and none is temporary.
pub(crate) fn assert_whole(folder: &Path) {
    for file in all_files(folder).into_iter().filter(|file| !text(file).ends_with(LOCK)) {
        let name = text(&file);
        assert!(!name.ends_with(UNFINISHED), "{name}");
        let content = fs::read(&file).unwrap();
        let ends = |end: &str| content.trim_ascii_end().ends_with(end.as_bytes());
        let is_whole = match file.extension().and_then(|end| end.to_str()) {
            Some("svg") => ends("</svg>"),
            Some("html") => ends("</html>"),
            Some("json") => serde_json::from_slice::<serde_json::Value>(&content).is_ok(),
            Some("png") => content.ends_with(b"IEND\xaeB`\x82"),
            Some("wav") => hound::WavReader::open(&file).is_ok_and(|wav| wav.duration() > 0),
            _ => !content.is_empty(),
        };
        assert!(is_whole, "{name}");
    }
}

/// A log that comes from a pipe, while the pipe is open: the output is begun and never finished.
fn log_from_pipe(folder: &Path, set_up: impl FnOnce(&mut Command) -> &mut Command) -> Child {
    let out = folder.join("out.csv");
    let mut run = begun(&["log", "-", "--signal", "table.rotor1_rpm", "-o", text(&out), "--force"], set_up);
    run.stdin.as_mut().unwrap().write_all(b"time_s,rotor1_rpm\n0,600\n1,660\n").unwrap();
    wait_for_writing(&mut run, folder);
    run
}

#[test]
fn a_single_file_stays_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    for old in [None, Some("old\n")] {
        old.map_or(Ok(()), |old| fs::write(folder.path().join("out.csv"), old)).unwrap();
        let mut run = log_from_pipe(folder.path(), |command| command);
        let pipe = run.stdin.take();
        let (is_ended_by_it, said) = interrupted(run);
        assert!(is_ended_by_it && said.is_empty(), "{said}");
        drop(pipe);
        let left = all_files(folder.path());
        assert_eq!(left.len(), usize::from(old.is_some()), "{left:?}");
        left.iter().for_each(|file| assert_eq!(fs::read_to_string(file).unwrap(), "old\n"));
    }
}

#[test]
fn a_recording_from_a_pipe_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut run =
        begun(&["speed", "-", "--blades", "2", "--no-progress"], |command| command.env("TMPDIR", folder.path()));
    run.stdin.as_mut().unwrap().write_all(b"RIFF").unwrap();
    let begun = Instant::now();
    while all_files(folder.path()).is_empty() {
        assert!(begun.elapsed() < Duration::from_secs(60), "nothing was kept");
        std::thread::sleep(Duration::from_millis(1));
    }
    let pipe = run.stdin.take();
    assert!(interrupted(run).0);
    drop(pipe);
    assert!(all_files(folder.path()).is_empty());
}

#[test]
fn results_are_whole_and_the_command_can_be_repeated() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = write_experiment(folder.path());
    let out = folder.path().join("out");
    let arguments = ["identify", &experiment, "-o", text(&out), "--no-progress"];
    let mut ended = 0;
    for delay_ms in [0, 5, 20, 60, 150] {
        let mut run = begun(&arguments, |command| command);
        wait_for_writing(&mut run, &out);
        // first its list, then for a while nothing, then its results
        let begun = Instant::now();
        while !out.join("results.json").exists() && begun.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(delay_ms));
        let (is_ended_by_it, said) = interrupted(run);
        ended += u32::from(is_ended_by_it);
        // of later runs the old results may be there while this run still listens
        let is_first = delay_ms == 0;
        assert!(!is_first || !is_ended_by_it || said.contains(&format!("{}: {INCOMPLETE}", text(&out))), "{said}");
        assert_whole(&out);
    }
    assert!(ended > 1, "interrupted {ended} times");
    hovertone(&arguments).ends_with(0);
    assert_whole(&out);
    assert!(files_in(&out, ".html").len() == 1 && !files_in(&out.join("figures"), ".png").is_empty());
}

#[test]
fn an_archive_leaves_whole_parts_and_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let (archive, out) = (folder.path().join("archive"), folder.path().join("out"));
    fs::create_dir(&archive).unwrap();
    for number in 0..6 {
        let speed = RotorSpeed::from_rev_s(58.0 + f64::from(number));
        write_hover(&archive.join(format!("{number}.wav")), steady_hover("ardrone", speed, 2.0));
    }
    let arguments = ["batch", text(&archive), "-o", text(&out), "--vehicle", "ardrone", "--no-progress"];
    let mut run = begun(&arguments, |command| command);
    wait_for_writing(&mut run, &out.join("parts"));
    let (is_ended_by_it, said) = interrupted(run);
    assert!(is_ended_by_it && said.trim_end().ends_with(INCOMPLETE), "{said}");
    assert_whole(&out);
    hovertone(&arguments).ends_with(0);
    assert_whole(&out);
    assert!(out.join("recordings.parquet").exists());
}

#[test]
fn a_demo_leaves_whole_files_and_takes_its_folder_again() {
    let folder = tempfile::tempdir().unwrap();
    let demo = folder.path().join("demo");
    for (seed, delay_ms) in [("1", 0), ("1", 300), ("2", 40)] {
        let mut run = begun(&["demo", "-o", text(&demo), "--seed", seed, "--no-progress"], |command| command);
        wait_for_writing(&mut run, &demo.join("no_hull"));
        std::thread::sleep(Duration::from_millis(delay_ms));
        let (is_ended_by_it, said) = interrupted(run);
        assert!(is_ended_by_it && said.trim_end().ends_with(INCOMPLETE), "{said}");
        assert_whole(&demo);
    }
}

/// Words of a shell before a command that runs for a while.
fn behind_shell(words: &str, folder: &Path) -> Child {
    let sound = folder.join("a.wav");
    write_noise(&sound, 60.0);
    let copy = folder.join("b.wav");
    write_noise(&copy, 61.0);
    let line = format!("{words}; exec \"$0\" speed a.wav b.wav --blades 2 --no-progress");
    let mut command = Command::new("sh");
    command.args(["-c", &line, env!("CARGO_BIN_EXE_hovertone")]).current_dir(folder);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

#[test]
fn long_work_says_that_it_was_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    // a busy machine begins the work later
    let said = [200, 600, 1500].map(|delay_ms| {
        let run = behind_shell("true", folder.path());
        std::thread::sleep(Duration::from_millis(delay_ms));
        interrupted(run)
    });
    let expected = (true, "interrupted: no results were written\n".to_owned());
    assert!(said.contains(&expected), "{said:?}");
}

/// As behind `nohup`, or in the background of a script.
#[cfg(target_os = "linux")]
#[test]
fn an_interrupt_that_the_caller_ignores_ends_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let run = behind_shell("trap '' INT", folder.path());
    std::thread::sleep(Duration::from_millis(300));
    let (is_ended_by_it, said) = interrupted(run);
    assert!(!is_ended_by_it && said.contains("no rotor tone"), "{said}");
}

#[test]
fn a_file_beyond_the_limit_of_the_system_leaves_nothing_and_is_told() {
    let folder = tempfile::tempdir().unwrap();
    write_noise(&folder.path().join("a.wav"), 2.0);
    let line = "ulimit -f 1; exec \"$0\" spectrogram a.wav -o x.png --blades 2 --no-progress";
    let mut command = Command::new("sh");
    let run = command.args(["-c", line, env!("CARGO_BIN_EXE_hovertone")]).current_dir(folder.path()).output().unwrap();
    let said = String::from_utf8(run.stderr).unwrap();
    assert_eq!(run.status.code(), Some(1), "{said}");
    for words in ["x.png: this file becomes larger than the system allows", "ulimit -f unlimited"] {
        assert!(said.contains(words), "no {words:?}:\n{said}");
    }
    assert_eq!(all_files(folder.path()).len(), 1);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("a.csv");
    fs::write(&table, "time_s,rotor1_rpm\n0,600\n1,660\n").unwrap();
    let run = hovertone(&["log", text(&table), "--signal", "table.rotor1_rpm", "-o", "/dev/full"]).ends_with(1);
    assert!(run.stderr.contains("/dev/full: the disk is full") && run.stderr.contains("make room"), "{}", run.stderr);
}

#[test]
fn a_file_that_cannot_be_removed_is_told_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let allow = |mode: u32| fs::set_permissions(folder.path(), fs::Permissions::from_mode(mode)).unwrap();
    allow(0o777);
    let is_root = fs::metadata("/proc/self").is_ok_and(|own| std::os::unix::fs::MetadataExt::uid(&own) == 0);
    let mut run =
        log_from_pipe(folder.path(), |command| if is_root { command.uid(NOBODY).gid(NOBODY) } else { command });
    allow(0o555);
    let pipe = run.stdin.take();
    let (is_ended_by_it, said) = interrupted(run);
    drop(pipe);
    allow(0o755);
    assert!(is_ended_by_it && said.lines().count() == 1, "{said}");
    for words in ["error: ", UNFINISHED, "this unfinished file", "hint: remove the file"] {
        assert!(said.contains(words), "no {words:?}:\n{said}");
    }
}
