//! A command line that has no meaning: one line says what is wrong and what to do.

use crate::args::Arguments;
use crate::conflicts::{advice, conflict_in_words, place_in_experiment};
use crate::failure::Failure;
use crate::meant::{DECIMAL_SIGN, SHARE_SIGN, flag_meant, number_meant, place_meant, results_meant, with_point};
use crate::missing::{argument_of_example, missing_in_words};
use crate::nearest::nearest;
use crate::number_advice::no_percent;
use crate::see_help::{command_of, commands_with, example_and_help, is_typed};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, Command, CommandFactory, FromArgMatches};
use hovertone_report::printable;
use std::error::Error as _;
use std::ffi::OsString;
use std::num::{ParseFloatError, ParseIntError};
use std::path::Path;

/// The command line as typed.
///
/// # Errors
/// It has no meaning, or it asks for help or for the version.
pub(crate) fn typed_arguments(words: &[OsString]) -> Result<Arguments, clap::Error> {
    let mut matches = with_negative_numbers(Arguments::command()).try_get_matches_from(words)?;
    Arguments::from_arg_matches_mut(&mut matches)
}

/// A negative number is the value of the flag before it and no flag, so that our own message can say what the value must be.
fn with_negative_numbers(command: Command) -> Command {
    let allowed = |argument: Arg| {
        let takes_value = argument.get_action().takes_values() && !argument.is_positional();
        if takes_value { argument.allow_negative_numbers(true) } else { argument }
    };
    command.mut_subcommands(|command| command.mut_args(allowed))
}

/// The failure of a command line; `None` where it asks for help or for the version, which are no failures.
pub(crate) fn failure_of(error: &clap::Error, words: &[OsString]) -> Option<Failure> {
    if !error.use_stderr() || error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        return None;
    }
    let Misuse { what, hint } = Misuse::of(error, words);
    let name = error.get(ContextKind::InvalidArg).map(all_words).unwrap_or_default();
    let help = || {
        let example = example_and_help(words, argument_of_example(words, &flag_of(&name)));
        if is_two_words(words) { format!("{COMPARE_ARCHIVES}; {example}") } else { example }
    };
    Some(Failure::usage(what, hint.unwrap_or_else(help)))
}

const COMPARE_ARCHIVES: &str = "to compare two archives, run `hovertone batch-compare OUT1 OUT2`";

/// Whether `batch-compare` was typed as two words.
fn is_two_words(words: &[OsString]) -> bool {
    words.get(1).is_some_and(|word| word == "batch") && words.get(2).is_some_and(|word| word == "compare")
}

struct Misuse {
    what: String,
    /// Absent where the help is the best advice.
    hint: Option<String>,
}

impl Misuse {
    fn of(error: &clap::Error, words: &[OsString]) -> Self {
        let text = |kind: ContextKind| error.get(kind).map(all_words).unwrap_or_default();
        let (name, value) = (flag_of(&text(ContextKind::InvalidArg)), text(ContextKind::InvalidValue));
        let known = text(ContextKind::ValidValue);
        match error.kind() {
            ErrorKind::InvalidValue if value.is_empty() => {
                let hint = if known.is_empty() { None } else { Some(format!("give one of: {known}")) };
                Self { what: format!("{name} has no value"), hint }
            }
            // of a value without a flag, the name is that of its place
            ErrorKind::InvalidValue => Self {
                what: match name.starts_with('<') {
                    true => format!("\"{value}\": there is no such value"),
                    false => format!("{name} {value}: there is no such value"),
                },
                hint: Some(match nearest(&value, known.split(", ")) {
                    Some(nearest) => format!("did you mean {nearest}? Give one of: {known}"),
                    None => format!("give one of: {known}"),
                }),
            },
            ErrorKind::ValueValidation => {
                let reason = reason_of(error);
                // a comma may also stand for the colon of a pair, and a mass is no share
                let is_pair = !value.contains(':') && [":HIGH", ":WHEEL"].iter().any(|end| reason.contains(end));
                let is_share_of_mass = name.starts_with("--mass") && value.ends_with('%');
                let is_other = is_pair || is_share_of_mass || reason.contains("whole number");
                match number_meant(&value).filter(|_| !is_other) {
                    Some((SHARE_SIGN, _)) if !name.contains("share") => Self {
                        what: format!("{name} {value}: a number without a percent sign is needed"),
                        hint: Some(no_percent(&name, &value, words)),
                    },
                    Some((why, hint)) => Self { what: format!("{name} {value}: {why}"), hint: Some(hint) },
                    None => Self { what: format!("{name} {value}: {reason}"), hint: None },
                }
            }
            ErrorKind::UnknownArgument => Self::of_unknown(&name, words),
            ErrorKind::InvalidSubcommand => Self::of_unknown_command(&text(ContextKind::InvalidSubcommand)),
            ErrorKind::ArgumentConflict => {
                let other = flag_of(&text(ContextKind::PriorArg));
                if name == other || other.is_empty() {
                    let hint = Some("give it once".to_owned());
                    return Self { what: format!("{name} is given more than once"), hint };
                }
                let [name, other] = [&name, &other].map(|argument| argument.trim_matches(['[', ']', '.']));
                Self { what: conflict_in_words(name, other, words), hint: Some(advice(name, other, words)) }
            }
            ErrorKind::MissingRequiredArgument => {
                let arguments = match error.get(ContextKind::InvalidArg) {
                    Some(ContextValue::Strings(all)) => all.clone(),
                    _ => Vec::new(),
                };
                Self { what: missing_in_words(words, &arguments), hint: results_meant(words) }
            }
            ErrorKind::TooFewValues | ErrorKind::TooManyValues | ErrorKind::WrongNumberOfValues => {
                Self { what: format!("{name} has too many or too few values"), hint: None }
            }
            ErrorKind::InvalidUtf8 => {
                let word = words.iter().find(|word| word.to_str().is_none()).map(|word| word.to_string_lossy());
                let what = format!("\"{}\": this word is not valid UTF-8 text", printable(&word.unwrap_or_default()));
                let hint =
                    "if the word is the name of a file, rename the file, or give the folder of the file".to_owned();
                Self { what, hint: Some(hint) }
            }
            _ => Self { what: first_line(error), hint: None },
        }
    }

    /// A word in the place of a command.
    fn of_unknown_command(name: &str) -> Self {
        let commands = Arguments::command();
        let nearest = nearest(name, commands.get_subcommands().map(Command::get_name));
        let hint = nearest.map_or_else(
            || "`hovertone --help` lists all commands".to_owned(),
            |nearest| format!("did you mean {nearest}?"),
        );
        Self { what: format!("there is no command \"{name}\""), hint: Some(hint) }
    }

    /// A word that is neither a flag nor a value.
    fn of_unknown(name: &str, words: &[OsString]) -> Self {
        let is_negative = |word: &str| {
            word.strip_prefix('-').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit() || c == '.'))
        };
        let negative =
            words.iter().filter_map(|word| word.to_str()).find(|word| is_negative(word) && word.starts_with(name));
        if let Some(word) = negative {
            let before = words.windows(2).find(|pair| pair[1] == *word).and_then(|pair| pair[0].to_str());
            let flag =
                before.filter(|before| before.starts_with("--")).map_or(String::new(), |flag| format!("{flag} "));
            if let Some(point) = with_point(word) {
                let what = format!("{flag}{word}: {DECIMAL_SIGN}");
                return Self { what, hint: Some(format!("write {point}")) };
            }
            let hint =
                "write the value without the minus sign; if this is the name of a file, write ./ before it".to_owned();
            return Self { what: format!("{flag}{word}: this value cannot be negative"), hint: Some(hint) };
        }
        if let Some(place) = place_of_log(name, words) {
            return Self { what: format!("there is no flag {name}"), hint: Some(place.to_owned()) };
        }
        if let Some(what) = idle_here(name, words) {
            return Self { what, hint: Some(format!("leave {name} out")) };
        }
        if name.starts_with('-') {
            let meant = place_in_experiment(name, words).or_else(|| flag_meant(name, words));
            let of_other = || Some(format!("this flag belongs to {}", commands_with(name)?));
            let hint = meant.or_else(of_other).or_else(|| nearest_flag(name, words));
            return Self { what: format!("there is no flag {name}"), hint };
        }
        match words.get(1).and_then(|command| command.to_str()) {
            Some("listen") => return Self::of_recording_alone(name, words),
            Some("init") => {
                let is_new_file = name.ends_with(".toml");
                if !is_new_file && !Path::new(name).exists() {
                    let behind = "write each recording after its mass, as in --mass 413g";
                    let hint = format!("check the name and its folder; {behind} {name}");
                    return Self { what: format!("{name}: there is no such file"), hint: Some(hint) };
                }
                let what = format!("\"{name}\": init needs a mass before each recording");
                let hint = if is_new_file {
                    format!("to name the new file, write -o {name}")
                } else {
                    format!("write --mass 413g {name}, with your mass")
                };
                return Self { what, hint: Some(hint) };
            }
            _ => {}
        }
        Self { what: format!("\"{name}\" has no place in this command"), hint: place_meant(name, words) }
    }

    /// A word without a flag behind `listen`: most probably the name of a recording.
    fn of_recording_alone(name: &str, words: &[OsString]) -> Self {
        let flag = "--from-file";
        if is_typed(words, flag) {
            let hint = Some(format!("leave \"{name}\" out"));
            return Self { what: format!("\"{name}\": listen hears one recording at a time"), hint };
        }
        let what = format!("\"{name}\": listen takes a recording only with the flag {flag}");
        Self { what, hint: Some(format!("write {flag} {name}")) }
    }
}

/// That a flag about the progress of a long analysis changes nothing in a command that shows none.
fn idle_here(name: &str, words: &[OsString]) -> Option<String> {
    let command = command_of(words).filter(|_| name == "--no-progress")?;
    Some(format!("{name} changes nothing: `hovertone {}` shows no progress", command.get_name()))
}

/// Where the log stands in commands that take it without a flag; others have `--log`.
fn place_of_log(name: &str, words: &[OsString]) -> Option<&'static str> {
    let command = words.get(1).and_then(|word| word.to_str()).filter(|_| name == "--log")?;
    match command {
        "verify" | "greybox" => Some("write the log after the recording, without a flag"),
        "motor" | "log" => Some("write the log without a flag"),
        _ => None,
    }
}

/// "did you mean --force?", of the flags of the typed command.
fn nearest_flag(name: &str, words: &[OsString]) -> Option<String> {
    let command = command_of(words)?;
    let flags: Vec<String> =
        command.get_arguments().filter_map(|flag| Some(format!("--{}", flag.get_long()?))).collect();
    let nearest = only_flag_of_unit(name, &flags)
        .or_else(|| nearest(name.trim_start_matches('-'), flags.iter().map(|flag| flag.trim_start_matches('-'))))?;
    Some(format!("did you mean --{}?", nearest.trim_start_matches('-')))
}

/// The flag whose value has the unit of the typed flag, such as rpm, where only one has it.
fn only_flag_of_unit<'a>(name: &str, flags: &'a [String]) -> Option<&'a str> {
    let (_, unit) = name.rsplit_once('-').filter(|(before, _)| !before.trim_matches('-').is_empty())?;
    let mut of_unit = flags.iter().filter(|flag| flag.rsplit_once('-').is_some_and(|(_, of)| of == unit));
    let only = of_unit.next()?;
    of_unit.next().is_none().then_some(only)
}

/// Why a value is refused.
fn reason_of(error: &clap::Error) -> String {
    match error.source() {
        Some(source) if source.is::<ParseFloatError>() => "a number is needed, such as 0.25".to_owned(),
        Some(source) if source.is::<ParseIntError>() => "a whole number, 0 or more, is needed".to_owned(),
        Some(source) => source.to_string(),
        None => "this value cannot be used here".to_owned(),
    }
}

/// `--mass-kg` of `--mass-kg <KG>`; a name of a file stays.
fn flag_of(argument: &str) -> String {
    if argument.starts_with('-') { argument.split([' ', '=', '[']).next().unwrap_or_default() } else { argument }
        .to_owned()
}

/// The words of a context, joined by commas.
fn all_words(value: &ContextValue) -> String {
    match value {
        ContextValue::Strings(all) => all.join(", "),
        one => one.to_string(),
    }
}

fn first_line(error: &clap::Error) -> String {
    let text = error.to_string();
    text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(line: &str) -> String {
        let words: Vec<OsString> = line.split(' ').map(OsString::from).collect();
        let error = typed_arguments(&words).unwrap_err();
        match failure_of(&error, &words) {
            Some(Failure::Usage { what, hint, .. }) => format!("{what} ({hint})"),
            _ => panic!("{line} is no wrong use"),
        }
    }

    #[test]
    fn each_misuse_is_one_line_with_the_reason_and_the_advice() {
        for (line, expected) in [
            ("hovertone speed a.wav --method guess", "--method guess: there is no such value (give one of: "),
            (
                "hovertone speed a.wav --blades",
                "--blades has no value (for example `hovertone speed --blades 2 hover.mp4`; see `hovertone speed --help`)",
            ),
            (
                "hovertone speed a.wav --blades -1",
                "--blades -1: must be a whole number from 1 to 12 (for example `hovertone speed --blades 2 hover.mp4`; see `hovertone speed --help`)",
            ),
            (
                "hovertone speed a.wav --blades two",
                "--blades two: must be a whole number from 1 to 12 (for example `hovertone speed --blades 2 hover.mp4`; see `hovertone speed --help`)",
            ),
            (
                "hovertone speed a.wav --window-s long",
                "--window-s long: a number is needed, such as 0.25 (--window-s S: Length of a frame (a short piece of sound) in s",
            ),
            (
                "hovertone speed a.wav --mass-kg heavy",
                "--mass-kg heavy: a mass is needed, such as 413g, or 0.413 in kilograms (--mass-kg KG: Mass as flown, in kg or as 413g",
            ),
            ("hovertone completions tcsh", "\"tcsh\": there is no such value (did you mean zsh? Give one of: bash, "),
            (
                "hovertone calibrate a.wav --true-rpm 3600",
                "there is no flag --true-rpm (did you mean --tachometer-rpm?)",
            ),
            (
                "hovertone speed a.wav --tachometer-rpm 3600",
                "there is no flag --tachometer-rpm (this flag belongs to `hovertone calibrate`)",
            ),
            ("hovertone speed a.wav --blade 2", "there is no flag --blade (did you mean --blades?)"),
            ("hovertone weigh a.wav --added 0.1", "there is no flag --added (for example `hovertone weigh "),
            ("hovertone speed a.wav --forc", "there is no flag --forc (did you mean --force?)"),
            ("hovertone spead a.wav", "there is no command \"spead\" (did you mean speed?)"),
            ("hovertone speeed a.wav", "there is no command \"speeed\" (did you mean speed?)"),
            ("hovertone speed2", "there is no command \"speed2\" (did you mean speed?)"),
            ("hovertone identfy", "there is no command \"identfy\" (did you mean identify?)"),
            ("hovertone spectogram", "there is no command \"spectogram\" (did you mean spectrogram?)"),
            ("hovertone quality", "there is no command \"quality\" (`hovertone --help` lists all commands)"),
            (
                "hovertone speed",
                "speed needs at least one recording (for example `hovertone speed --blades 2 hover.mp4`; see",
            ),
            (
                "hovertone batch compare a b",
                "batch needs a folder for the results (-o OUT) (to compare two archives, run `hovertone batch-compare OUT1 OUT2`; for example",
            ),
            (
                "hovertone identify --vehicle ardrone",
                "--vehicle needs masses and recordings too (--mass KG=FILES) (for example `hovertone identify --vehicle ardrone --mass ",
            ),
            (
                "hovertone weigh a.wav",
                "weigh needs a thrust constant (--constant RESULTS.json) (for example `hovertone weigh",
            ),
            (
                "hovertone batch",
                "batch needs a folder with recordings, and a folder for the results (-o OUT) (for example",
            ),
            (
                "hovertone demo extra",
                "\"extra\" has no place in this command (for example `hovertone demo`; see `hovertone demo --help`)",
            ),
            (
                "hovertone spectrogram a.wav b.wav -o x.png",
                "\"b.wav\" has no place in this command (give one recording at a time)",
            ),
            (
                "hovertone init hover.mp4",
                "hover.mp4: there is no such file (check the name and its folder; write each recording after its \
                 mass, as in --mass 413g hover.mp4)",
            ),
            (
                "hovertone init src/lib.rs",
                "\"src/lib.rs\": init needs a mass before each recording (write --mass 413g src/lib.rs, with your mass)",
            ),
            (
                "hovertone listen hover.mp4",
                "\"hover.mp4\": listen takes a recording only with the flag --from-file (write --from-file",
            ),
            (
                "hovertone listen --from-file a.wav b.wav",
                "\"b.wav\": listen hears one recording at a time (leave \"b.wav\"",
            ),
            (
                "hovertone identify a.toml --check --json",
                "--check cannot be used with --json (--check analyses nothing, so",
            ),
            ("hovertone speed a.wav --blades 2 --blades 3", "--blades is given more than once (give it once)"),
            (
                "hovertone identify --mass -0.4=a.mov",
                "--mass -0.4=a.mov: this value cannot be negative (write the value",
            ),
            ("hovertone speed a.wav --gear -8:69", "--gear -8:69: this value cannot be negative (write the value"),
            (
                "hovertone weigh a.wav --constant-n-s2 -2.8e-5",
                "--constant-n-s2 -2.8e-5: this value cannot be negative (write the value",
            ),
        ] {
            let line_said = said(line);
            assert!(line_said.starts_with(expected) && !line_said.contains('\n'), "{line}: {line_said}");
        }
    }

    #[test]
    fn help_and_version_are_no_failures() {
        for line in ["hovertone --help", "hovertone speed --help", "hovertone --version", "hovertone"] {
            let words: Vec<OsString> = line.split(' ').map(OsString::from).collect();
            assert!(failure_of(&typed_arguments(&words).unwrap_err(), &words).is_none(), "{line}");
        }
    }
}
