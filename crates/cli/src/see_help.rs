//! Where the help about a command line stands, and an example of a right one.

use crate::args::Arguments;
use clap::{Command, CommandFactory};
use std::ffi::OsString;

/// The line above the examples of a help.
const EXAMPLES: &str = "Examples:";

/// Names the help of the typed command.
pub(crate) fn see_help(words: &[OsString]) -> String {
    match typed_command(words) {
        Some(command) => format!("see `hovertone {} --help`", command.get_name()),
        None => "see `hovertone --help`".to_owned(),
    }
}

/// An example of a right call of the typed command, with this flag where an example has it; and the command's help.
pub(crate) fn example_and_help(words: &[OsString], flag: &str) -> String {
    let help = see_help(words);
    match typed_command(words).and_then(|command| example_of(&command, flag)) {
        Some(example) => format!("as in `{example}`; {help}"),
        None => help,
    }
}

/// The command that is typed, if there is one of that name.
pub(crate) fn typed_command(words: &[OsString]) -> Option<Command> {
    let commands = Arguments::command();
    words.iter().skip(1).filter_map(|word| word.to_str()).find_map(|word| commands.find_subcommand(word)).cloned()
}

/// The first example of the help that has the flag, else the first.
fn example_of(command: &Command, flag: &str) -> Option<String> {
    let help = command.get_after_help()?.to_string();
    // two spaces divide an example from its explanation
    let call = |line: &str| line.trim().split("  ").next().map(str::to_owned);
    let examples: Vec<String> = help.lines().skip_while(|line| *line != EXAMPLES).skip(1).filter_map(call).collect();
    let long = command
        .get_arguments()
        .find(|argument| argument.get_long().map(|long| format!("--{long}")).as_deref() == Some(flag));
    let short = long.and_then(|argument| argument.get_short()).map(|short| format!("-{short}"));
    let is_flag = |word: &str| word == flag || Some(word) == short.as_deref();
    let with_flag = examples.iter().find(|example| example.split(' ').any(is_flag));
    with_flag.or_else(|| examples.first()).cloned()
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
            let example = example_of(command, "").unwrap_or_default();
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
        assert_eq!(hint, "as in `hovertone calibrate --true-hz 1000 tone.wav`; see `hovertone calibrate --help`");
        let words = ["hovertone", "log", "flight.ulg", "--signal", "esc_status"].map(OsString::from);
        let hint = example_and_help(&words, "--output");
        assert!(hint.contains("--signal esc_status -o speeds.csv"), "{hint}");
    }
}
