//! What CI does and a person types: `cargo xtask ci`, `tidy`, `bench`, `validate`.

#![allow(clippy::print_stdout, clippy::print_stderr)] // a tool for people at a terminal

mod accuracy;
mod bench;
mod ci;
mod cost;
mod labels;
mod rotors;
mod roundtrip;
mod tidy;
mod validate;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

const HELP: &str = "cargo xtask <task>

  ci      all that continuous integration checks: tidy, format, clippy, tests, documentation
  tidy    rules of the house that no compiler knows
  validate  what is exported, in the hands of other programs: rotorpy (installed by pip) hovers at the speed that was heard
  bench   speed and memory of decoding and of `hovertone speed` on 30-minute files, as ratios
          [--minutes N] for shorter ones
  bench roundtrip   simulate, identify, compare with the truth: a hundred random hovers
          [--count N] for fewer, [--spread SHARE] for rotors more alike or less
  bench rotors      four rotors from one microphone against the truth of every instant: docs/rotors.md
          [--seeds N] for fewer, [--only WORDS] to print some of its sounds, clip by clip
  bench labels      which rotor is which, from logs, several microphones and the motors' start: a section of docs/rotors.md
          [--count N] for fewer flights, [--heard N] of those that are heard, [--started N] of starts;
          [--only logs|microphones|starts]
  bench accuracy    one rotor against the Cramér-Rao bound, the ± against the truth, and other programs: docs/accuracy.md
          [--draws N] [--coverage N] for fewer, [--only PART] to print one part, [--install-peers] to have them here
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let outcome = match words.as_slice() {
        ["ci"] => ci::run(&root()),
        ["tidy"] => tidy::run(&root()),
        ["bench", "roundtrip", options @ ..] => roundtrip::run(&root(), options),
        ["bench", "accuracy", options @ ..] => accuracy::run(&root(), options),
        ["bench", "rotors", options @ ..] => rotors::run(&root(), options),
        ["bench", "labels", options @ ..] => labels::run(&root(), options),
        ["validate"] => validate::run(&root()),
        ["bench", options @ ..] => bench::run(&root(), options),
        [bench::DECODE_TASK, file] => bench::decode(Path::new(file)),
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

/// The root of the workspace.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().map_or_else(PathBuf::new, Path::to_path_buf)
}

/// Where cargo builds, and where benches keep what they make.
fn target(root: &Path) -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from)
}
