//! Where the help about a command line stands.

use crate::args::Arguments;
use clap::CommandFactory;
use std::ffi::OsString;

/// Names the help of the typed command.
pub(crate) fn see_help(words: &[OsString]) -> String {
    let commands = Arguments::command();
    let named =
        words.iter().skip(1).filter_map(|word| word.to_str()).find(|word| commands.find_subcommand(word).is_some());
    named.map_or_else(|| "see `hovertone --help`".to_owned(), |name| format!("see `hovertone {name} --help`"))
}
