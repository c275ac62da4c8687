//! Arguments that exclude each other, and why.

use hovertone_report::ExperimentKey;
use std::ffi::OsString;
use std::path::Path;

/// The place of an experiment file among the words of a command.
const EXPERIMENT: &str = "EXPERIMENT.toml";

const NAMED_TWICE: &str = "each of the two flags alone tells which rotor is which: leave one of them out";
const WITHOUT_AIR: &str = "--plan does not use the density of the air: leave the flags of the air out, and give them \
                           later, when you fit the table";
const NOT_APART: &str = "--mean-only separates no rotors, so none gets a name: leave one of the two out";
const PRINTED: &str = "--json prints the answer as JSON and nothing else: leave one of the two out";
/// Two arguments, and why only one of them has a meaning.
const KNOWN: [([&str; 2], &str); 22] = [
    (["--gravity-m-s2", "--latitude-deg"], "both give the local gravity: leave one of them out"),
    (["--constant", "--constant-n-s2"], "both give the thrust constant: leave one of them out"),
    (
        ["--constant", "--constant-std-n-s2"],
        "the file of --constant already has an uncertainty: leave --constant-std-n-s2 out",
    ),
    (["--tachometer-rpm", "--true-hz"], "both give the known speed: leave one of them out"),
    (["--to", "--into"], "--to writes a new model, --into changes a model that you have: leave one of them out"),
    (["NAME", "--add"], "--add copies vehicles from a file, and a name shows a vehicle: leave one of them out"),
    (["--mean-only", "--method"], "both say how the speed is read from the sound: leave one of them out"),
    (
        ["--plan", "TABLE.csv"],
        "--plan plans flights before anything is measured, and a table has measurements: leave one of them out",
    ),
    (["--plan", "--temperature-c"], WITHOUT_AIR),
    (["--plan", "--pressure-hpa"], WITHOUT_AIR),
    (["--plan", "--humidity-percent"], WITHOUT_AIR),
    (["--mean-only", "--log"], NOT_APART),
    (["--mean-only", "--spin-up"], NOT_APART),
    (["--mean-only", "--microphones"], NOT_APART),
    (["--spin-up", "--log"], NAMED_TWICE),
    (["--microphones", "--log"], NAMED_TWICE),
    (["--microphones", "--spin-up"], NAMED_TWICE),
    (["--check", "--json"], "--check analyses nothing, so there are no results to print: leave one of them out"),
    (["--check", "--verbose"], "--check analyses nothing, so there are no tables to print: leave one of them out"),
    (
        ["--signals", "--signal"],
        "--signals lists the names of all signals, --signal writes one signal into a file: leave one of them out",
    ),
    (["--signals", "--json"], "--json already prints the names of all signals: leave --signals out"),
    (
        ["--output", "COMMAND"],
        "-o writes the manual pages of all commands, and the name of a command prints its page: leave one of them out",
    ),
];

/// That two arguments cannot be used together. A recording apart from its mass takes the place of an experiment file.
pub(crate) fn conflict_in_words(one: &str, other: &str, words: &[OsString]) -> String {
    match [one, other].contains(&EXPERIMENT) && !has_experiment(words) {
        true if has_mass(words) => "a file without a mass before it counts as the experiment file".to_owned(),
        true => "the mass of the vehicle in the recording is missing".to_owned(),
        false => format!("{} cannot be used with {}", in_words(one), in_words(other)),
    }
}

/// A flag as it is typed; a place by what stands there.
fn in_words(argument: &str) -> &str {
    match argument {
        EXPERIMENT => "an experiment file",
        "TABLE.csv" => "a table",
        "COMMAND" => "the name of a command",
        "NAME" => "the name of a vehicle",
        flag => flag,
    }
}

/// What to do about two arguments that cannot be used together: flags, or places without their brackets.
pub(crate) fn advice(one: &str, other: &str, words: &[OsString]) -> String {
    if let (EXPERIMENT, flag) | (flag, EXPERIMENT) = (one, other) {
        return beside_experiment(flag, words);
    }
    let of_both = |(pair, _): &&([&str; 2], &str)| *pair == [one, other] || *pair == [other, one];
    let reason = KNOWN.iter().find(of_both).map(|(_, reason)| *reason);
    let prints = || [one, other].contains(&"--json").then_some(PRINTED);
    reason.or_else(prints).unwrap_or("leave one of them out").to_owned()
}

/// What to do about a flag that `identify` does not have, where an experiment file has a key for it.
pub(crate) fn place_in_experiment(flag: &str, words: &[OsString]) -> Option<String> {
    words.get(1).filter(|command| *command == "identify")?;
    let has_file = has_experiment(words);
    if flag == "--mass-kg" {
        // without a file, --mass is meant
        return has_file.then(|| beside_experiment("--mass", words));
    }
    let ExperimentKey { key, table, .. } = ExperimentKey::of_flag(flag)?;
    Some(match has_file {
        true => format!("write {key} under {table} in the experiment file instead"),
        false => {
            format!(
                "write {key} under {table} in an experiment file instead; `hovertone init` writes an experiment file"
            )
        }
    })
}

fn has_mass(words: &[OsString]) -> bool {
    words.iter().any(|word| word.to_str().is_some_and(|word| word.split('=').next() == Some("--mass")))
}

fn has_experiment(words: &[OsString]) -> bool {
    words.iter().any(|word| Path::new(word).extension().is_some_and(|extension| extension == "toml"))
}

/// A fact beside an experiment file, which has a place for it.
fn beside_experiment(flag: &str, words: &[OsString]) -> String {
    if !has_experiment(words) {
        let order = if has_mass(words) { ", and all other flags before --mass" } else { "" };
        return format!("write each recording directly after its mass, as in --mass 413g hover.mov{order}");
    }
    match ExperimentKey::of_flag(flag) {
        Some(ExperimentKey { key, table, .. }) => format!(
            "write {key} under {table} in the experiment file instead; or leave the file out, and give --mass with recordings"
        ),
        None => "write the mass into the experiment file, as mass_kg under [vehicle] or as added_mass_kg under its \
             [[load]]; or leave the file out, and give --mass with recordings"
            .to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::Arguments;
    use clap::CommandFactory;

    #[test]
    fn each_pair_that_the_parser_refuses_has_its_reason() {
        let mut count = 0;
        for command in Arguments::command().get_subcommands() {
            for argument in command.get_arguments() {
                for other in command.get_arg_conflicts_with(argument) {
                    let name = |argument: &clap::Arg| match argument.get_long() {
                        Some(long) => format!("--{long}"),
                        None => argument.get_value_names().unwrap_or_default().join(" "),
                    };
                    let (one, other) = (name(argument), name(other));
                    assert_ne!(
                        advice(&one, &other, &[]),
                        "leave one of them out",
                        "{}: {one} {other}",
                        command.get_name()
                    );
                    count += 1;
                }
            }
        }
        assert!(count > 20, "{count}");
    }

    #[test]
    fn a_fact_beside_an_experiment_file_is_told_its_place() {
        let words = ["hovertone", "identify", "bench.toml"].map(OsString::from);
        let advised = advice(EXPERIMENT, "--latitude-deg", &words);
        assert!(
            advised.starts_with("write latitude_deg under [vehicle] in the experiment file instead; or"),
            "{advised}"
        );
        assert!(advice("--vehicle", EXPERIMENT, &words).contains("preset under [vehicle]"));
        assert!(advice(EXPERIMENT, "--vehicle", &words[..2]).starts_with("write each recording directly after"));
        assert!(advice(EXPERIMENT, "--mass", &words).contains("as mass_kg under [vehicle] or as added_mass_kg"));
        assert!(advice(EXPERIMENT, "--mass", &words[..2]).starts_with("write each recording directly after"));
    }

    #[test]
    fn a_flag_of_another_command_is_told_its_key_in_an_experiment_file() {
        let words = ["hovertone", "identify", "bench.toml"].map(OsString::from);
        let told = |flag: &str, words: &[OsString]| place_in_experiment(flag, words).unwrap_or_default();
        assert_eq!(told("--band", &words), "write band_hz under [tone] in the experiment file instead");
        assert!(told("--mass-kg", &words).contains("as mass_kg under [vehicle]"));
        assert!(told("--order", &words[..2]).starts_with("write order under [tone] in an experiment file instead"));
        assert_eq!(told("--mass-kg", &words[..2]) + &told("--colour", &words), "");
        let speed = ["hovertone", "speed", "bench.toml"].map(OsString::from);
        assert_eq!(place_in_experiment("--band", &speed), None);
    }
}
