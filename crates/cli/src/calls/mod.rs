//! The commands for other programs: a command line as words, and what it finds as data. Nothing is printed, and no interrupt is watched.
//!
//! The words are those of the command line, so that a flag has one meaning and a refusal one wording, whoever gives it.

mod heard;
mod identified;
mod loaded;

pub use crate::caller::OnProgress;
pub use heard::HeardRecording;
pub use identified::IdentifiedExperiment;
pub use loaded::LoadedSound;

use crate::args::Command;
use crate::caller::Caller;
use crate::failure::{Ending, Failure};
use crate::misuse::{failure_of, typed_arguments};
use crate::terminal::Terminal;
use crate::{identify, run_command, speed, tones};
use hovertone_media::Samples;
use std::ffi::OsString;

/// A call of a command.
pub struct Call {
    caller: Caller,
}

/// What a command has printed.
#[derive(Clone, Debug)]
pub struct Printed {
    /// What goes to stdout.
    pub data: String,
    /// What goes to stderr.
    pub messages: String,
    /// How the run ended.
    pub ending: Ending,
}

impl Call {
    /// The command of a command line, without the name of the program.
    pub fn new(words: impl IntoIterator<Item = OsString>, on_progress: Option<OnProgress>) -> Self {
        let words = [OsString::from("hovertone")].into_iter().chain(words).collect();
        Self { caller: Caller { words, on_progress } }
    }

    /// Runs any command and keeps what it prints.
    ///
    /// # Errors
    /// What the command would refuse.
    pub fn printed(self) -> Result<Printed, Failure> {
        let (mut data, mut messages) = (Vec::new(), Vec::new());
        let ending = self.with_command(|command| {
            let mut terminal = Terminal::kept(&mut data, &mut messages);
            run_command(&command, &mut terminal)
        })?;
        let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
        Ok(Printed { data: text(data), messages: text(messages), ending })
    }

    /// Hears the recordings of `speed` or `tones`. The first recording may be in memory: its word then is only a name.
    ///
    /// # Errors
    /// What the command would refuse; another command. A file that cannot be read is a recording with its reason.
    pub fn heard(self, samples: Option<Samples>) -> Result<Vec<HeardRecording>, Failure> {
        self.with_command(|command| match command {
            Command::Speed(arguments) => speed::called(&arguments, samples).map(HeardRecording::all),
            Command::Tones(arguments) => tones::called(&arguments, samples).map(HeardRecording::all),
            _ => Err(Failure::internal("this command hears no recordings")),
        })
    }

    /// Decodes the first recording of `tones`, and analyses nothing.
    ///
    /// # Errors
    /// What the command would refuse; a file that cannot be read; another command.
    pub fn loaded(self) -> Result<LoadedSound, Failure> {
        self.with_command(|command| match command {
            Command::Tones(arguments) => LoadedSound::of(tones::first_recording(&arguments)?),
            _ => Err(Failure::internal("this command loads no recording")),
        })
    }

    /// The recordings of `batch`, in the order of its tables; nothing is heard.
    ///
    /// # Errors
    /// What the command would refuse; another command.
    #[cfg(feature = "archive")]
    pub fn archive_names(self) -> Result<Vec<String>, Failure> {
        self.with_command(|command| match command {
            Command::Batch(arguments) => crate::batch::called::names(&arguments),
            _ => Err(Failure::internal("this command has no archive")),
        })
    }

    /// The row that `batch` would write for its first recording, as a stream of Arrow IPC; nothing is written.
    ///
    /// # Errors
    /// What the command would refuse; another command. A recording that cannot be heard is a row with its error.
    #[cfg(feature = "archive")]
    pub fn archive_row(self) -> Result<Vec<u8>, Failure> {
        self.with_command(|command| match command {
            Command::Batch(arguments) => crate::batch::called::row(&arguments),
            _ => Err(Failure::internal("this command has no archive")),
        })
    }

    /// Identifies the experiment of `identify`.
    ///
    /// # Errors
    /// What the command would refuse; another command.
    pub fn identified(self) -> Result<IdentifiedExperiment, Failure> {
        self.with_command(|command| match command {
            Command::Identify(arguments) => identify::called(&arguments).map(IdentifiedExperiment::new),
            _ => Err(Failure::internal("this command identifies no experiment")),
        })
    }

    fn with_command<T>(self, run: impl FnOnce(Command) -> Result<T, Failure>) -> Result<T, Failure> {
        let words = self.caller.words.clone();
        self.caller.during(|| {
            let arguments = typed_arguments(&words).map_err(|error| {
                failure_of(&error, &words).unwrap_or_else(|| Failure::internal("help is for people at a terminal"))
            })?;
            run(arguments.command)
        })
    }
}

/// A failure as the command line prints it, without the word "error".
pub fn failure_in_words(failure: &Failure) -> String {
    let (mut data, mut messages) = (Vec::new(), Vec::new());
    Terminal::kept(&mut data, &mut messages).failure(failure);
    let text = String::from_utf8_lossy(&messages);
    text.trim_end().trim_start_matches("error: ").to_owned()
}

#[cfg(test)]
mod tests {
    use super::{Call, failure_in_words};
    use crate::failure::{Ending, Failure};
    use hovertone_media::Samples;
    use std::ffi::OsString;
    use std::sync::{Arc, Mutex};

    fn call(line: &str) -> Call {
        Call::new(line.split(' ').map(OsString::from), None)
    }

    /// A rotor with two unlike blades at 70 rev/s in some noise, for 3 s.
    fn rotor() -> Samples {
        let mut state = 1_u32;
        let sample = |n: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = f64::from(state) / f64::from(u32::MAX) - 0.5;
            let line = |order: u32| {
                let level = if order.is_multiple_of(2) { 0.2 } else { 0.04 } / f64::from(order);
                level * (std::f64::consts::TAU * 70.0 * f64::from(order * n) / 16_000.0).cos()
            };
            (0.03 * noise + (1..13).map(line).sum::<f64>()) as f32
        };
        Samples::new((0..48_000).map(sample).collect(), 1, 16_000.0)
    }

    #[test]
    fn an_array_is_heard_and_drawn() {
        let told = Arc::new(Mutex::new(Vec::new()));
        let listener = Arc::clone(&told);
        let words = ["speed", "--blades=2", "--rotors=1", "--json", "array"].map(OsString::from);
        let call = Call::new(words, Some(Arc::new(move |share| listener.lock().unwrap().push(share))));
        let heard = call.heard(Some(rotor())).unwrap();
        let [recording] = heard.as_slice() else { panic!("one recording") };
        let speed = recording.record().speed().unwrap().speed;
        assert!((speed.rev_s() - 70.0).abs() < 0.05, "{}", speed.rev_s());
        assert!(recording.figure().unwrap().unwrap().svg.contains("<svg"));
        let told = told.lock().unwrap();
        assert!(told.is_sorted() && told.last() == Some(&1.0) && told.len() > 5, "{told:?}");
    }

    #[test]
    fn a_refusal_has_the_words_of_the_command_line() {
        let words = |result: Result<Vec<super::HeardRecording>, Failure>| match result {
            Err(failure) => failure_in_words(&failure),
            Ok(_) => panic!("it was not refused"),
        };
        let no_file = "speed needs at least one recording (hint: for example `hovertone speed --blades 2 hover.mp4`; see `hovertone speed --help`)";
        assert_eq!(words(call("speed").heard(None)), no_file);
        // advice about a number names the help of the command that was called, not that of the program that calls
        let beyond = words(call("speed --clock-ppm=-1 array").heard(Some(rotor())));
        assert!(beyond.ends_with("see `hovertone speed --help`)"), "{beyond}");
        let text = words(call("fit table.csv").heard(None));
        assert!(text.starts_with("this command hears no recordings"), "{text}");
    }

    #[test]
    fn what_a_command_prints_is_kept() {
        let printed = call("vehicles --json").printed().unwrap();
        assert!(printed.data.contains("ardrone") && printed.messages.is_empty());
        assert_eq!(printed.ending, Ending::Done);
    }
}
