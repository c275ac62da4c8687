//! Flags about a recording, which change nothing where a log tells the speeds.

use crate::caller::typed_words;
use crate::failure::Failure;
use crate::see_help::is_typed;
use clap::{Args, Command};
use std::path::Path;

/// It changes no answer about a recording either.
const HARMLESS: &str = "--no-progress";

/// The flags of a group of arguments.
pub(crate) fn flags_of<Group: Args>() -> Vec<String> {
    let group = Group::augment_args(Command::new("group"));
    let flags = group.get_arguments().filter_map(|argument| Some(format!("--{}", argument.get_long()?)));
    flags.filter(|flag| flag != HARMLESS).collect()
}

/// Refuses the first of the flags that is typed.
pub(crate) fn refuse_of_recording(flags: &[String], log: &Path) -> Result<(), Failure> {
    let words = typed_words();
    let Some(flag) = flags.iter().find(|flag| is_typed(&words, flag)) else { return Ok(()) };
    Err(Failure::Usage {
        what: format!("this is a log, but {flag} belongs to a recording"),
        hint: format!("leave {flag} out: hovertone uses the whole log, with its own speeds and commands"),
        path: Some(log.to_owned()),
    })
}

#[cfg(test)]
mod tests {
    use super::flags_of;
    use crate::args::HearingArguments;

    #[test]
    fn a_group_lists_the_flags_that_change_an_answer() {
        assert_eq!(flags_of::<HearingArguments>(), ["--audio-track", "--channel", "--clock-correction-ppm"]);
    }
}
