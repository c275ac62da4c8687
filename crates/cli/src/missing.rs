//! What a command needs and was not given, in words.

use crate::see_help::typed_command;
use std::ffi::OsString;

/// An argument of a command, and what to call it.
struct Needed {
    command: &'static str,
    argument: &'static str,
    words: &'static str,
}

const fn needed(command: &'static str, argument: &'static str, words: &'static str) -> Needed {
    Needed { command, argument, words }
}

const RESULTS: &str = "the results.json of `hovertone identify`";
/// Arguments whose names alone do not say what is needed.
const ALL: [Needed; 27] = [
    needed("speed", "<FILE>...", "at least one recording"),
    needed("tones", "<FILE>...", "at least one recording"),
    needed("listen", "--from-file <FILE>", "a recording: --from-file FILE"),
    needed("batch", "<DIR|PATTERN|LIST|URL>...", "a folder with recordings"),
    needed("batch", "--output <OUT>", "a folder for the results: -o OUT"),
    needed("batch-compare", "<OUT1>", "the earlier folder that `hovertone batch` wrote"),
    needed("batch-compare", "<OUT2>", "the later folder that `hovertone batch` wrote"),
    needed("spectrogram", "<FILE>", "a recording"),
    needed("spectrogram", "--output <PICTURE>", "a name for the picture: -o PICTURE.png"),
    needed("identify", "<EXPERIMENT.toml>", "an experiment file"),
    needed("calibrate", "<RECORDING>", "a recording"),
    needed("calibrate", "--tachometer-rpm <RPM>", "a known speed: --tachometer-rpm RPM or --true-hz HZ"),
    needed("fit", "<TABLE.csv>...", "at least one table of speeds and thrusts"),
    needed("weigh", "<FILE>...", "at least one recording"),
    needed("weigh", "--constant <RESULTS.json>", "a thrust constant: --constant RESULTS.json"),
    needed("export", "<RESULTS.json>", RESULTS),
    needed("export", "--to <FORMAT>", "a format or a model: --to FORMAT or --into MODEL"),
    needed("compare", "<RESULTS.json>", RESULTS),
    needed("compare", "<MODEL>...", "at least one model of a simulator"),
    needed("log", "<FILE>...", "at least one log"),
    needed("motor", "<FILE>...", "at least one log or recording"),
    needed("verify", "<RECORDING>", "a recording"),
    needed("verify", "<LOG>", "the log of the same flight"),
    needed("greybox", "<RECORDING> [LOG]...", "a recording and its log, or the log alone"),
    needed("greybox", "--vehicle <NAME>", "a vehicle: --vehicle NAME"),
    needed("simulate", "<SCENARIO.toml>", "a scenario file"),
    needed("completions", "<SHELL>", "the name of your shell"),
];

/// "speed needs at least one recording", of the missing arguments as the parser names them.
pub(crate) fn missing_in_words(words: &[OsString], arguments: &[String]) -> String {
    let Some(command) = typed_command(words) else {
        return format!("this is missing: {}", arguments.join(", "));
    };
    let name = command.get_name();
    let known = |argument: &String| ALL.iter().find(|needed| needed.command == name && needed.argument == argument);
    let named: Vec<&str> =
        arguments.iter().map(|argument| known(argument).map_or(argument.as_str(), |one| one.words)).collect();
    format!("{name} needs {}", named.join(", and "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::misuse::typed_arguments;
    use clap::error::{ContextKind, ContextValue};
    use std::collections::BTreeSet;

    /// Every argument of the list is one that the parser misses where a command stands alone, or with its files.
    #[test]
    fn what_a_command_lacks_has_words() {
        let mut found = BTreeSet::new();
        let lines: BTreeSet<String> = (ALL.iter())
            .flat_map(|needed| ["", " a.json", " --blades 2"].map(|rest| format!("hovertone {}{rest}", needed.command)))
            .collect();
        for line in &lines {
            let words: Vec<OsString> = line.split(' ').map(OsString::from).collect();
            let Err(error) = typed_arguments(&words) else { continue };
            let Some(ContextValue::Strings(arguments)) = error.get(ContextKind::InvalidArg) else { continue };
            if error.kind() == clap::error::ErrorKind::MissingRequiredArgument {
                let sentence = missing_in_words(&words, arguments);
                assert!(sentence.contains(" needs ") && !sentence.contains('<'), "{line}: {sentence}");
                found.extend(arguments.iter().map(|argument| (words[1].clone(), argument.clone())));
            }
        }
        assert_eq!(found.len(), ALL.len(), "{found:?}");
    }
}
