//! Exams and benchmarks, run by people: `cargo run --release -p hovertone-bench -- EXAM`.

#![allow(clippy::print_stdout, clippy::print_stderr)] // a tool for people at a terminal

mod accuracy;
mod batch;
mod cost;
mod document;
mod greybox;
mod labels;
mod logs;
mod motor;
mod options;
mod real;
mod rotors;
mod rotors_report;
mod roundtrip;
mod speed;
mod verify;
mod workspace;

use std::path::Path;
use std::process::ExitCode;
use workspace::root;

const HELP: &str = "cargo run --release -p hovertone-bench -- EXAM

  speed      speed and memory of decoding and of `hovertone speed` on 30-minute files, as ratios: docs/speed.md
             [--minutes N] for shorter files
  logs       speed and memory of `hovertone log` on long logs of each format: docs/logs.md
             [--mb N] for shorter logs
  batch      `hovertone batch` on 10,000 recordings of 2 s: throughput, memory, and a run that is killed twenty times: docs/batch.md
             [--count N] for fewer recordings
  motor      time constants from the sound of steps, on simulated benches: a section of docs/motor.md
             [--count N] for fewer benches, [--first-seed N] for others, [--reverberation S] for another room,
             [--only room|open], [--vehicle NAME], [--list] to print each answer, [--save DIR] to keep the sounds
  accuracy   one rotor against the Cramér-Rao bound, the ± against the truth, and other programs: docs/accuracy.md
             [--draws N] [--coverage N] for fewer draws, [--only PART] to print one part,
             [--install-peers] to install the other programs
  rotors     four rotors from one microphone against the truth of every instant: docs/rotors.md
             [--seeds N] for fewer seeds, [--only WORDS] to print some of its sounds, clip by clip
  labels     which rotor is which, from logs, several microphones and the start of the motors: a section of docs/rotors.md
             [--count N] for fewer flights, [--heard N] for fewer that are heard, [--started N] for fewer starts;
             [--only logs|microphones|starts]
  real       real recordings, heard by the command as a user would: docs/real-sound.md, docs/real-sound.png
             [--data DIR] for other recordings, [--semi-real DIR] for those made before, [--hovertone PATH] for another program,
             [--only CLASS] to print one class, [--all] to print right cases too, [--ci] for the subset with its floors,
             [--peers] to run other programs, or [--peers-of real|semi-real] on one set,
             [--out ROWS.json] to keep the rows, [--compare ROWS.json] to print what changed
  sensitivity  what one step of each setting changes on the real recordings: docs/sensitivity.md
             [--data DIR] for other recordings, [--try NAME=VALUE,…] to print what other values change
  saying-more  each error with a fact about the vehicle said and without it, on simulated and semi-real sound: docs/saying-more.md
             [--semi-real DIR] for recordings made before, [--flights N] for fewer flights
  levels     levels of the lines and evidence of simulated flights beside real recordings: docs/synthetic-and-real.md
             [--data DIR] for other recordings, [--flights N] for fewer flights
  greybox    the low-level model of simulated flights against its truth, from logged speeds and from sound: docs/greybox.md
             [--logged N] for another number of flights with logged speeds, [--heard N] for those that are heard, [--first-seed N]
             for others, [--vehicle NAME], [--only logged|open|room], [--list] to print each answer
  verify     sound against telemetry on simulated flights, with right and wrong orders and clocks: a section of docs/verify.md
             [--count N] for fewer flights
  roundtrip  simulate, identify, compare with the truth: a hundred random hovers
             [--count N] for fewer hovers, [--spread SHARE] for another spread of the rotors
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    if words.contains(&"--help") {
        println!("{HELP}");
        return ExitCode::SUCCESS;
    }
    let outcome = match words.as_slice() {
        ["speed", options @ ..] => speed::run(&root(), options),
        ["logs", options @ ..] => logs::run(&root(), options),
        ["batch", options @ ..] => batch::run(&root(), options),
        ["motor", options @ ..] => motor::run(&root(), options),
        ["accuracy", options @ ..] => accuracy::run(&root(), options),
        ["rotors", options @ ..] => rotors::run(&root(), options),
        ["real", options @ ..] => real::run(&root(), options),
        ["sensitivity", options @ ..] => real::sensitivity::run(&root(), options),
        ["levels", options @ ..] => real::levels::run(&root(), options),
        ["saying-more", options @ ..] => real::saying_more::run(&root(), options),
        ["labels", options @ ..] => labels::run(&root(), options),
        ["greybox", options @ ..] => greybox::run(options),
        ["verify", options @ ..] => verify::run(options),
        ["roundtrip", options @ ..] => roundtrip::run(&root(), options),
        [speed::DECODE_TASK, file] => speed::decode(Path::new(file)),
        _ => Err(HELP.to_owned()),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
