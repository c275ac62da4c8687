//! What a command needs and was not given, in words.

use crate::see_help::{command_of, is_typed};
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
    needed("listen", "--from-file <FILE>", "a recording (--from-file FILE)"),
    needed("batch", "<DIR|PATTERN|LIST|URL>...", "a folder with recordings"),
    needed("batch", "--output <OUT>", "a folder for the results (-o OUT)"),
    needed("batch-compare", "<OUT1>", "the earlier folder that `hovertone batch` wrote"),
    needed("batch-compare", "<OUT2>", "the later folder that `hovertone batch` wrote"),
    needed("spectrogram", "<FILE>", "a recording"),
    needed("spectrogram", "--output <PICTURE>", "a name for the picture (-o PICTURE.png)"),
    needed("identify", "<EXPERIMENT.toml>", "an experiment file"),
    needed("calibrate", "<RECORDING>", "a recording"),
    needed(
        "calibrate",
        "--tachometer-rpm <RPM>",
        "a known speed (--tachometer-rpm RPM) or a known tone (--true-hz HZ)",
    ),
    needed("fit", "<TABLE.csv>...", "at least one table of speeds and thrusts"),
    needed("weigh", "<FILE>...", "at least one recording"),
    needed("weigh", "--constant <RESULTS.json>", "a thrust constant (--constant RESULTS.json)"),
    needed("export", "<RESULTS.json>", RESULTS),
    needed("export", "--to <FORMAT>", "a format (--to FORMAT) or a model (--into MODEL)"),
    needed("compare", "<RESULTS.json>", RESULTS),
    needed("compare", "<MODEL>...", "at least one model of a simulator"),
    needed("log", "<FILE>...", "at least one log"),
    needed("motor", "<FILE>...", "at least one log or recording"),
    needed("verify", "<RECORDING>", "a recording"),
    needed("verify", "<LOG>", "the log of the same flight"),
    needed("greybox", "<RECORDING> [LOG]...", "a recording and its log, or the log alone"),
    needed("greybox", "--vehicle <NAME>", "a vehicle (--vehicle NAME)"),
    needed("simulate", "<SCENARIO.toml>", "a scenario file"),
    needed("completions", "<SHELL>", "the name of your shell"),
];

/// An argument that flags need beside them.
struct NeededBeside {
    argument: &'static str,
    flags: &'static [&'static str],
    words: &'static str,
}

const fn needed_beside(argument: &'static str, flags: &'static [&'static str], words: &'static str) -> NeededBeside {
    NeededBeside { argument, flags, words }
}

const OF_PLAN: &[&str] = &[
    "--wanted-share",
    "--added-mass-kg",
    "--mass-std-kg",
    "--speed-spread-share",
    "--correlation-s",
    "--rotors-separated",
];
const OF_DRAFT: &[&str] =
    &["--vehicle", "--blades", "--gear", "--rotors", "--diameter-m", "--gravity-m-s2", "--latitude-deg", "--height-m"];
const ALL_BESIDE: [NeededBeside; 8] = [
    needed_beside("<EXPERIMENT.toml>", OF_DRAFT, "masses and recordings too (--mass KG=FILES)"),
    needed_beside("--log <FILE>", &["--log-offset-s", "--log-axes", "--layout"], "the log too (--log FILE)"),
    needed_beside("--commands <LOG>", &["--offset"], "the log of the commands too (--commands LOG)"),
    needed_beside("--signal <NAME>", &["--output", "-o"], "the name of the signal too (--signal NAME)"),
    needed_beside("--output <FILE.csv>", &["--signal"], "a file for the signal too (-o FILE.csv)"),
    needed_beside("--plan", OF_PLAN, "a plan and the mass of the vehicle (--plan --mass-kg KG)"),
    needed_beside("--plan", &["--mass-kg"], "--plan too, because the mass belongs to a plan of flights"),
    needed_beside("--mass-kg <KG>", &["--plan"], "the mass of the vehicle (--mass-kg KG)"),
];

/// "--log-axes needs the log too (--log FILE)".
fn missing_beside(words: &[OsString], arguments: &[String]) -> Option<String> {
    let is_missing = |beside: &&NeededBeside| arguments.iter().any(|argument| argument == beside.argument);
    ALL_BESIDE.iter().filter(is_missing).find_map(|beside| {
        let flag = beside.flags.iter().find(|flag| is_typed(words, flag))?;
        Some(format!("{flag} needs {}", beside.words))
    })
}

/// The argument whose example helps where this one is missing.
pub(crate) fn argument_of_example<'a>(words: &[OsString], argument: &'a str) -> &'a str {
    let is_draft = argument == "<EXPERIMENT.toml>" && OF_DRAFT.iter().any(|flag| is_typed(words, flag));
    if is_draft { "--mass" } else { argument }
}

/// "speed needs at least one recording", of the missing arguments as the parser names them.
pub(crate) fn missing_in_words(words: &[OsString], arguments: &[String]) -> String {
    if let Some(beside) = missing_beside(words, arguments) {
        return beside;
    }
    let Some(command) = command_of(words) else {
        return format!("this is missing: {}", arguments.join(", "));
    };
    let name = command.get_name();
    let known = |argument: &String| ALL.iter().find(|needed| needed.command == name && needed.argument == argument);
    // the parser has the flags first, a person the files
    let (flags, files): (Vec<&String>, Vec<&String>) =
        arguments.iter().partition(|argument| argument.starts_with("--"));
    let named: Vec<&str> = files
        .into_iter()
        .chain(flags)
        .map(|argument| known(argument).map_or(argument.as_str(), |one| one.words))
        .collect();
    format!("{name} needs {}", named.join(", and "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::misuse::typed_arguments;
    use clap::error::{ContextKind, ContextValue};
    use std::collections::BTreeSet;

    #[test]
    fn what_a_flag_needs_beside_it_has_words() {
        for (line, words) in [
            ("speed a.wav --log-axes flu", "--log-axes needs the log too (--log FILE)"),
            ("motor a.wav --offset 0", "--offset needs the log of the commands too (--commands LOG)"),
            ("log a.ulg -o a.csv", "-o needs the name of the signal too (--signal NAME)"),
            ("log a.ulg --signal speed", "--signal needs a file for the signal too (-o FILE.csv)"),
            (
                "fit a.csv --wanted-share=0.1",
                "--wanted-share needs a plan and the mass of the vehicle (--plan --mass-kg KG)",
            ),
            ("fit --plan", "--plan needs the mass of the vehicle (--mass-kg KG)"),
            ("fit --mass-kg 0.4", "--mass-kg needs --plan too, because the mass belongs to a plan of flights"),
        ] {
            let words_typed: Vec<OsString> = format!("hovertone {line}").split(' ').map(OsString::from).collect();
            let error = typed_arguments(&words_typed).unwrap_err();
            let Some(ContextValue::Strings(arguments)) = error.get(ContextKind::InvalidArg) else { panic!("{line}") };
            assert_eq!(missing_in_words(&words_typed, arguments), words);
        }
    }

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
