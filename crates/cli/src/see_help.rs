//! Where the help about a command line stands, and an example of a right one.

use crate::args::Arguments;
use clap::{Arg, Command, CommandFactory};
use hovertone_vehicle::in_list;
use std::ffi::OsString;

/// The line above the examples of a help.
const EXAMPLES: &str = "Examples:";

/// Names the help of the typed command.
pub(crate) fn see_help(words: &[OsString]) -> String {
    match command_of(words) {
        Some(command) => format!("see `hovertone {} --help`", command.get_name()),
        None => "see `hovertone --help`".to_owned(),
    }
}

/// An example of a right call of the typed command: with this flag where an example has it, else behind what the flag is for; and the
/// command's help.
pub(crate) fn example_and_help(words: &[OsString], flag: &str) -> String {
    let help = see_help(words);
    let Some(command) = command_of(words) else { return help };
    let example = example_of(&command, flag).map(|example| format!("for example `{example}`"));
    let advice = example
        .or_else(|| purpose_of(&command, flag))
        .or_else(|| Some(format!("for example `{}`", examples_of(&command).first()?)));
    advice.map_or_else(|| help.clone(), |advice| format!("{advice}; {help}"))
}

/// What a flag of a command is for, by its help: "--clock-ppm PPM: …".
fn purpose_of(command: &Command, flag: &str) -> Option<String> {
    let argument = argument_of(command, flag)?;
    let value =
        argument.get_value_names().map(|names| names.join(" ")).filter(|_| argument.get_action().takes_values());
    let help = argument.get_help()?.to_string();
    Some(format!(
        "{flag}{}: {}",
        value.map_or_else(String::new, |value| format!(" {value}")),
        help.trim_end_matches('.')
    ))
}

/// The argument of a command that is given by this flag.
pub(crate) fn argument_of<'a>(command: &'a Command, flag: &str) -> Option<&'a Arg> {
    command
        .get_arguments()
        .find(|argument| argument.get_long().is_some_and(|long| flag.strip_prefix("--") == Some(long)))
}

/// The commands that have a flag, where they are not more than two.
pub(crate) fn commands_with(flag: &str) -> Option<String> {
    let commands = Arguments::command();
    let has_flag = |command: &&Command| argument_of(command, flag).is_some();
    let names: Vec<String> = commands.get_subcommands().filter(has_flag).map(|it| it.get_name().to_owned()).collect();
    let named = || names.iter().map(|name| format!("`hovertone {name}`")).collect::<Vec<_>>();
    (1..=2).contains(&names.len()).then(|| in_list(&named(), "and"))
}

/// Whether a flag is among the words, alone or as in --flag=value.
pub(crate) fn is_typed(words: &[OsString], flag: &str) -> bool {
    words.iter().filter_map(|word| word.to_str()).any(|word| word.split('=').next() == Some(flag))
}

/// The command that is typed, if there is one of that name.
pub(crate) fn command_of(words: &[OsString]) -> Option<Command> {
    let commands = Arguments::command();
    words.iter().skip(1).filter_map(|word| word.to_str()).find_map(|word| commands.find_subcommand(word)).cloned()
}

/// The examples of a command's help.
fn examples_of(command: &Command) -> Vec<String> {
    let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    // two spaces divide an example from its explanation
    let call = |line: &str| line.trim().split("  ").next().map(str::to_owned);
    help.lines().skip_while(|line| *line != EXAMPLES).skip(1).filter_map(call).collect()
}

/// The first example of the help that has the flag.
fn example_of(command: &Command, flag: &str) -> Option<String> {
    let short = argument_of(command, flag).and_then(Arg::get_short).map(|short| format!("-{short}"));
    let is_flag = |word: &str| word == flag || Some(word) == short.as_deref();
    examples_of(command).into_iter().find(|example| example.split(' ').any(is_flag))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Commands that no example names: `help` is of the parser.
    const WITHOUT_EXAMPLE: &str = "help";

    #[test]
    fn every_command_has_an_example_that_calls_it() {
        let mut count = 0;
        for command in Arguments::command().get_subcommands().filter(|command| command.get_name() != WITHOUT_EXAMPLE) {
            let example = examples_of(command).first().cloned().unwrap_or_default();
            assert!(example.starts_with(&format!("hovertone {}", command.get_name())), "{}", command.get_name());
            assert!(!example.contains("  ") && !example.contains('`'), "{example}");
            count += 1;
        }
        assert!(count > 20, "{count}");
    }

    #[test]
    fn the_example_has_the_flag_in_question() {
        let words = ["hovertone", "calibrate", "--true-hz"].map(OsString::from);
        let hint = example_and_help(&words, "--true-hz");
        assert_eq!(hint, "for example `hovertone calibrate --true-hz 1000 tone.wav`; see `hovertone calibrate --help`");
        let words = ["hovertone", "log", "flight.ulg", "--signal", "esc_status"].map(OsString::from);
        let hint = example_and_help(&words, "--output");
        assert!(hint.contains("--signal esc_status -o speeds.csv"), "{hint}");
    }

    #[test]
    fn a_flag_that_no_example_has_is_explained() {
        let words = ["hovertone", "verify", "a.wav", "a.ulg", "--clock-ppm", "x"].map(OsString::from);
        let hint = example_and_help(&words, "--clock-ppm");
        assert!(hint.starts_with("--clock-ppm PPM: ") && hint.ends_with("; see `hovertone verify --help`"), "{hint}");
    }
}
