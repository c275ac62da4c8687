//! `listen`: sound as it arrives, as lines and on a screen.

use crate::testkit::{
    hovertone, hovertone_with, recordings, refused_with, steady_hover, text, write_hover, write_noise,
};
use hovertone_vehicle::RotorSpeed;
use portable_pty::{CommandBuilder, PtySize, native_pty_system};
use std::fs::File;
use std::io::{Read, Write};
use std::num::NonZero;
use std::path::Path;
use std::process::Stdio;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

fn write_ardrone(path: &Path, duration_s: f64) {
    write_hover(path, steady_hover("ardrone", RotorSpeed::from_rpm(3600.0), duration_s));
}

#[test]
fn a_recording_and_a_pipe_give_the_same_speeds() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    write_ardrone(&sound, 6.0);
    let words = ["listen", "--vehicle", "ardrone", "--rotors", "1", "--speed", "1000", "--json", "--from-file"];
    let of_file = hovertone(&[&words[..], &[text(&sound)]].concat()).ends_with(0).json_lines();
    let pipe = [&words[..], &["-"]].concat();
    let input = Stdio::from(File::open(&sound).unwrap());
    assert_eq!(hovertone_with(&pipe, |command| command.stdin(input)).ends_with(0).json_lines(), of_file);
    assert_eq!(of_file.len(), 60);
    for (number, line) in of_file.iter().enumerate() {
        let time_s = line["time_s"].as_f64().unwrap();
        assert!((time_s - 0.1 * (number + 1) as f64).abs() < 1e-3, "{line}");
        if time_s > 2.15 {
            let (speed, std) = (line["speed_rev_s"].as_f64().unwrap(), line["std_uncertainty_rev_s"].as_f64().unwrap());
            assert!(line["status"] == "ok" && (speed - 60.0).abs() < 0.3 && std > 0.0 && std < 0.3, "{line}");
        }
    }
}

#[test]
fn lines_for_people_say_when_there_is_no_rotor() {
    let folder = tempfile::tempdir().unwrap();
    let noise = folder.path().join("noise.wav");
    write_noise(&noise, 5.0);
    let run = hovertone(&["listen", "--blades", "2", "--speed", "1000", "--from-file", text(&noise)]).ends_with(3);
    let lines: Vec<&str> = run.stdout.lines().collect();
    assert_eq!(lines.len(), 7, "{}", run.stdout);
    assert!(lines[0].contains("time") && lines[0].contains("level") && lines[0].contains("speed"), "{}", run.stdout);
    assert!(lines[1].contains("1.0 s") && lines[1].ends_with(" dB  listening"), "{}", run.stdout);
    assert!(lines.iter().any(|line| line.contains("no rotor tone: ")), "{}", run.stdout);
    assert!(lines[3..6].iter().all(|line| line.contains("no rotor tone")), "{}", run.stdout);
    assert_eq!(lines[6], "no speed was heard in 5.0 s");
}

#[test]
fn the_last_line_has_the_mean_and_the_time_that_had_a_speed() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    write_ardrone(&sound, 6.0);
    let words = ["listen", "--vehicle", "ardrone", "--rotors", "1", "--speed", "1000", "--from-file", text(&sound)];
    let run = hovertone(&words).ends_with(0);
    let last = run.stdout.lines().last().unwrap();
    let mean_rev_s: f64 = last.strip_prefix("mean: ").unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((mean_rev_s - 60.0).abs() < 0.3, "{last}");
    assert!(last.contains(" ± ") && last.ends_with(" s of 6.0 s"), "{last}");
}

/// Cars and machines resemble a rotor for some seconds.
#[test]
fn sound_without_a_rotor_has_no_mean() {
    for (folder, file, words) in [
        (
            "small-multirotors",
            "BACKGROUND_001.wav",
            "several speeds were possible; if this is a rotor, give --diameter-m",
        ),
        (
            "real",
            "BACKGROUND_006.flac",
            "a mean needs one clear speed for 3 s without a gap, or for half of the time. A shorter speed may come from another sound",
        ),
    ] {
        let Some(folder) = recordings(folder) else { return };
        let file = folder.join(file);
        let run = hovertone(&["listen", "--blades", "2", "--speed", "1000", "--from-file", text(&file)]).ends_with(3);
        let last = run.stdout.lines().last().unwrap();
        assert!(last.starts_with("no mean: one speed was clear in only ") && last.contains(words), "{last}");
    }
}

#[test]
fn of_several_possible_speeds_none_has_a_plus_minus() {
    let Some(folder) = recordings("small-multirotors") else { return };
    let file = folder.join("DRONE_001.wav");
    let run = hovertone(&["listen", "--speed", "1000", "--from-file", text(&file)]).ends_with(3);
    let lines: Vec<&str> = run.stdout.lines().skip(1).filter(|line| line.contains("speeds are possible")).collect();
    assert!(lines.len() >= 5, "{}", run.stdout);
    for line in lines {
        assert!(line.contains(" or ") && line.contains(" rev/s") && !line.contains('±'), "{line}");
    }
}

/// 4 blades at 42.4 rev/s and 2 blades at 84.8 rev/s have the same tone.
#[test]
fn a_tone_of_the_given_blades_asks_for_no_other_blades() {
    let Some(folder) = recordings("small-multirotors") else { return };
    let file = folder.join("DRONE_001.wav");
    let run = hovertone(&["listen", "--blades", "2", "--speed", "1000", "--from-file", text(&file)]).ends_with(0);
    let words = ["fits --blades 2 (84.", "listen for longer; if this message stays, check --blades 2"];
    assert!(words.iter().all(|words| run.stdout.contains(words)), "{}", run.stdout);
    assert!(!run.stdout.contains("--blades 4") && !run.stdout.contains("the given facts"), "{}", run.stdout);
}

#[test]
fn a_mean_that_contradicts_the_given_vehicle_is_not_to_be_used() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    write_hover(&sound, steady_hover("ardrone", RotorSpeed::from_rev_s(60.1), 6.0));
    let words = ["listen", "--vehicle", "crazyflie", "--speed", "1000", "--from-file", text(&sound)];
    let run = hovertone(&words).ends_with(3);
    let last = run.stdout.lines().last().unwrap();
    assert!(
        last.contains("do not use this mean, because the sound contradicts --vehicle crazyflie: "),
        "{}",
        run.stdout
    );
    assert!(last.ends_with("; check --vehicle crazyflie"), "{}", run.stdout);
    hovertone(&[&words[..], &["--json"]].concat()).ends_with(3);
}

#[test]
fn a_recording_without_its_flag_is_refused_with_the_right_command() {
    refused_with(&["listen", "hover.mp4"], &["--from-file hover.mp4"]);
    refused_with(&["listen", "--blades", "2", "hover.mp4"], &["--from-file hover.mp4"]);
    refused_with(&["listen", "--from-file", "a.mp4", "b.mp4"], &["one recording at a time"]);
}

#[test]
fn what_cannot_be_heard_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    write_ardrone(&sound, 2.0);
    let refused = |more: &[&str], words: &[&str]| {
        refused_with(&[&["listen", "--blades", "2", "--from-file", text(&sound)], more].concat(), words);
    };
    refused(&["--speed", "0"], &["--speed = 0"]);
    refused(&["--plain", "--json"], &["--plain", "--json"]);
    refused_with(&["listen", "--blades", "2"], &["--from-file"]);
    let text_file = folder.path().join("notes.txt");
    std::fs::write(&text_file, "no sound at all, only words\n".repeat(100)).unwrap();
    let input = Stdio::from(File::open(&text_file).unwrap());
    let run = hovertone_with(&["listen", "--from-file", "-"], |command| command.stdin(input)).ends_with(1);
    assert!(run.stderr.contains("the pipe holds no sound"), "{}", run.stderr);
    hovertone(&["listen", "--from-file", "gone.wav"]).ends_with(1);
}

fn nonzero(count: u16) -> NonZero<u16> {
    NonZero::new(count).unwrap()
}

/// A command in a terminal of a size.
struct InTerminal {
    screen: vt100::Parser,
    bytes: Receiver<Vec<u8>>,
    keys: Box<dyn Write + Send>,
    child: Box<dyn portable_pty::Child + Send + Sync>,
}

impl InTerminal {
    fn start(arguments: &[&str], rows: u16, cols: u16) -> Self {
        let pair = native_pty_system().openpty(PtySize { rows, cols, pixel_width: 0, pixel_height: 0 }).unwrap();
        let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_hovertone"));
        command.args(arguments);
        command.env("TERM", "xterm-256color");
        let child = pair.slave.spawn_command(command).unwrap();
        let mut reader = pair.master.try_clone_reader().unwrap();
        let keys = pair.master.take_writer().unwrap();
        let (sender, bytes) = channel();
        std::thread::spawn(move || {
            let mut buffer = [0; 4096];
            while let Ok(count @ 1..) = reader.read(&mut buffer) {
                if sender.send(buffer[..count].to_vec()).is_err() {
                    break;
                }
            }
        });
        Self { screen: vt100::Parser::new(nonzero(rows), nonzero(cols), 0), bytes, keys, child }
    }

    /// Waits until the screen satisfies a condition; returns what it shows.
    fn until(&mut self, is_met: impl Fn(&str) -> bool) -> String {
        let begun = Instant::now();
        loop {
            let contents = self.screen.screen().contents();
            if is_met(&contents) {
                return contents;
            }
            assert!(begun.elapsed() < Duration::from_secs(120), "the screen shows\n{contents}");
            if let Ok(bytes) = self.bytes.recv_timeout(Duration::from_millis(200)) {
                self.screen.process(&bytes);
            }
        }
    }

    /// What the terminal shows after the end of the command.
    fn after_end(&mut self) -> String {
        self.child.wait().unwrap();
        while let Ok(bytes) = self.bytes.recv_timeout(Duration::from_secs(2)) {
            self.screen.process(&bytes);
        }
        self.screen.screen().contents()
    }

    fn press(&mut self, keys: &str) {
        self.keys.write_all(keys.as_bytes()).unwrap();
        self.keys.flush().unwrap();
    }
}

#[test]
fn the_screen_shows_the_speed_and_answers_keys() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    write_ardrone(&sound, 40.0);
    for (rows, cols) in [(24, 80), (60, 200)] {
        let arguments =
            ["listen", "--vehicle", "ardrone", "--rotors", "1", "--speed", "2", "--from-file", text(&sound)];
        let mut terminal = InTerminal::start(&arguments, rows, cols);
        let shown = terminal.until(|text| text.contains("(k = 2)") && text.contains("now"));
        for words in ["hovertone hover.wav", "q quit", "rpm", "rad/s", "level", " dB", "−60 s"] {
            assert!(shown.contains(words), "{words} at {cols} x {rows}:\n{shown}");
        }
        let widest = shown.lines().map(|line| line.chars().count()).max().unwrap_or(0);
        assert!(widest <= usize::from(cols) && shown.lines().count() <= usize::from(rows));
        terminal.press("f");
        terminal.until(|text| text.contains("FROZEN") && text.contains("go on"));
        terminal.press("q");
        assert!(terminal.child.wait().unwrap().success());
        // the terminal is as it was
        terminal.until(|text| !text.contains("q quit"));
    }
}

#[test]
fn a_warning_stays_when_the_screen_is_gone() {
    let folder = tempfile::tempdir().unwrap();
    // a WAV file with the wrong name
    let sound = folder.path().join("hover.flac");
    write_ardrone(&sound, 3.0);
    let arguments = ["listen", "--vehicle", "ardrone", "--rotors", "1", "--speed", "1000", "--from-file", text(&sound)];
    let shown = InTerminal::start(&arguments, 24, 200).after_end();
    assert!(shown.contains("warning: the file's name ends in .flac") && !shown.contains("q quit"), "{shown}");
}
