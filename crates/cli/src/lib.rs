//! The commands of hovertone: a command line as typed, its meaning, its run.
//!
//! Each command has three steps: the command line as typed (`args`), its meaning (`resolve` of the command), the run. Data goes to stdout
//! and to files, all messages for people to stderr. [`run`] is the program `hovertone`; [`calls`] are the same commands for other programs.

mod args;
#[cfg(feature = "archive")]
mod batch;
mod calibrate;
mod caller;
pub mod calls;
mod compare;
mod conflicts;
mod copies;
mod demo;
mod draft;
mod drawing;
mod each_file;
mod export;
mod failure;
mod figure_file;
mod file_list;
mod files;
mod fit;
mod foreign_speed;
mod greybox;
mod identify;
mod init;
mod inputs;
mod job;
mod jobs;
mod labels;
mod listen;
mod log;
mod meant;
mod microphones;
mod missing;
mod misuse;
mod model_file;
mod motor;
mod nearest;
mod number_advice;
mod of_recording;
mod order_words;
mod output_file;
mod output_folder;
mod outputs;
mod own_vehicles;
mod place;
mod progress;
mod recording;
mod recording_files;
mod report_folder;
mod rights;
mod scale_uncertainty;
mod see_help;
#[cfg(feature = "page")]
mod serve;
mod settings;
mod shell;
mod simulate;
mod spectrogram;
mod speed;
mod spin_up;
mod stored;
mod temporary_file;
mod terminal;
mod text_file;
mod thumbnail;
mod today;
mod toml_file;
mod toml_words;
mod tones;
mod typed;
mod unused_facts;
mod vehicles;
mod verify;
mod wav;
mod weigh;
mod weighed_tone;
mod which_speed;
mod wording;

pub use failure::{Ending, Failure};

use args::Command;
use std::ffi::OsString;
use std::process::ExitCode;
use terminal::Terminal;

/// Runs the command line of this process.
pub fn run() -> ExitCode {
    temporary_file::end_with_run();
    let mut terminal = Terminal::of_process();
    let words: Vec<OsString> = std::env::args_os().collect();
    let arguments = match misuse::typed_arguments(&words) {
        Ok(arguments) => arguments,
        Err(error) => match misuse::failure_of(&error, &words) {
            Some(failure) => {
                terminal.failure(&failure);
                return failure.exit_code();
            }
            None => error.exit(),
        },
    };
    let ending = run_command(&arguments.command, &mut terminal);
    inputs::forget_stdin();
    match ending.and_then(|ending| terminal.flush().map(|()| ending)) {
        Ok(ending) => ending.exit_code(),
        Err(Failure::StdoutClosed) => ExitCode::SUCCESS,
        Err(failure) => {
            terminal.failure(&failure);
            failure.exit_code()
        }
    }
}

fn run_command(command: &Command, terminal: &mut Terminal<'_>) -> Result<Ending, Failure> {
    match command {
        Command::Init(arguments) => init::run(arguments, terminal),
        Command::Speed(arguments) => speed::run(arguments, terminal),
        Command::Listen(arguments) => listen::run(arguments, terminal),
        #[cfg(feature = "archive")]
        Command::Batch(arguments) => batch::run(arguments, terminal),
        #[cfg(feature = "archive")]
        Command::BatchCompare(arguments) => batch::compare::run(arguments, terminal),
        Command::Tones(arguments) => tones::run(arguments, terminal),
        Command::Spectrogram(arguments) => spectrogram::run(arguments, terminal),
        Command::Identify(arguments) => identify::run(arguments, terminal),
        Command::Calibrate(arguments) => calibrate::run(arguments, terminal),
        Command::Fit(arguments) => fit::run(arguments, terminal),
        Command::Weigh(arguments) => weigh::run(arguments, terminal),
        Command::Export(arguments) => export::run(arguments, terminal),
        Command::Compare(arguments) => compare::run(arguments, terminal),
        Command::Log(arguments) => log::run(arguments, terminal),
        Command::Motor(arguments) => motor::run(arguments, terminal),
        Command::Verify(arguments) => verify::run(arguments, terminal),
        Command::GreyBox(arguments) => greybox::run(arguments, terminal),
        Command::Demo(arguments) => demo::run(arguments, terminal),
        Command::Simulate(arguments) => simulate::run(arguments, terminal),
        Command::Vehicles(arguments) => vehicles::run(arguments, terminal),
        #[cfg(feature = "page")]
        Command::Serve(arguments) => serve::run(arguments, terminal),
        #[cfg(not(feature = "page"))]
        Command::Serve(_) => Err(Failure::Failed {
            what: "this build of hovertone has no page for the browser".to_owned(),
            hint: "use `hovertone speed` and `hovertone identify` in the terminal; or build the page: `cargo xtask page`, then `cargo build --release --features page`".to_owned(),
            path: None,
        }),
        Command::Completions(arguments) => shell::run_completions(arguments, terminal),
        Command::Man(arguments) => shell::run_man(arguments, terminal),
    }
}
