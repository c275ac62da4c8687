//! Arguments that exclude each other, and why.

use hovertone_report::ExperimentKey;
use std::ffi::OsString;
use std::path::Path;

/// The place of an experiment file among the words of a command.
const EXPERIMENT: &str = "EXPERIMENT.toml";

const NAMED_TWICE: &str = "each names the rotors by itself: leave one of them out";
const WITHOUT_AIR: &str = "a plan does not use the air: leave it out; give it when you fit the tables";
const PRINTED: &str = "--json prints the answer as JSON, and nothing else: leave one of them out";
/// Two arguments, and why only one of them has a meaning.
const KNOWN: [([&str; 2], &str); 18] = [
    (["--gravity-m-s2", "--latitude-deg"], "both give the local gravity: leave one of them out"),
    (["--constant", "--constant-n-s2"], "both give the thrust constant: leave one of them out"),
    (
        ["--constant", "--constant-std-n-s2"],
        "the results of --constant have an uncertainty already: leave --constant-std-n-s2 out",
    ),
    (["--tachometer-rpm", "--true-hz"], "both give the known speed: leave one of them out"),
    (["--to", "--into"], "--to writes a new model, --into changes one that you have: leave one of them out"),
    (["--mean-only", "--method"], "both say how the speed is read from the sound: leave one of them out"),
    (["--plan", "TABLE.csv"], "a plan is made before there are tables: leave one of them out"),
    (["--plan", "--temperature-c"], WITHOUT_AIR),
    (["--plan", "--pressure-hpa"], WITHOUT_AIR),
    (["--plan", "--humidity-percent"], WITHOUT_AIR),
    (["--spin-up", "--log"], NAMED_TWICE),
    (["--microphones", "--log"], NAMED_TWICE),
    (["--microphones", "--spin-up"], NAMED_TWICE),
    (["--check", "--json"], "--check analyses nothing, so there are no results to print: leave one of them out"),
    (["--check", "--verbose"], "--check analyses nothing, so there are no tables to print: leave one of them out"),
    (["--signals", "--signal"], "--signals lists the names of all, --signal writes one: leave one of them out"),
    (["--signals", "--json"], "--json has the names of all signals already: leave --signals out"),
    (["--output", "COMMAND"], "-o writes the pages of all commands, COMMAND prints one: leave one of them out"),
];

/// That two arguments cannot be used together. A recording apart from its mass takes the place of an experiment file.
pub(crate) fn conflict_in_words(one: &str, other: &str, words: &[OsString]) -> String {
    match [one, other].contains(&EXPERIMENT) && !has_experiment(words) {
        true if has_mass(words) => "a file that does not stand behind a mass counts as the experiment file".to_owned(),
        true => "the mass that hovers in the recording is missing".to_owned(),
        false => format!("{one} cannot be used with {other}"),
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
        true => format!("write it into the experiment file, as {key} under {table}"),
        false => {
            format!("only an experiment file has a place for it, as {key} under {table}: `hovertone init` writes one")
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
        return format!("write each recording directly behind its mass, as in --mass 413g hover.mov{order}");
    }
    match ExperimentKey::of_flag(flag) {
        Some(ExperimentKey { key, table, .. }) => format!(
            "write it into the experiment file, as {key} in {table}; or leave the file out, and give --mass with recordings"
        ),
        None => {
            "write it into the experiment file, as mass_kg in [vehicle], or as added_mass_kg in its [[load]]; or leave the file out".to_owned()
        }
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
            advised.starts_with("write it into the experiment file, as latitude_deg in [vehicle]; or"),
            "{advised}"
        );
        assert!(advice("--vehicle", EXPERIMENT, &words).contains("as preset in [vehicle]"));
        assert!(advice(EXPERIMENT, "--vehicle", &words[..2]).starts_with("write each recording directly behind"));
        assert!(advice(EXPERIMENT, "--mass", &words).contains("as mass_kg in [vehicle], or as added_mass_kg"));
        assert!(advice(EXPERIMENT, "--mass", &words[..2]).starts_with("write each recording directly behind"));
    }

    #[test]
    fn a_flag_of_another_command_is_told_its_key_in_an_experiment_file() {
        let words = ["hovertone", "identify", "bench.toml"].map(OsString::from);
        let told = |flag: &str, words: &[OsString]| place_in_experiment(flag, words).unwrap_or_default();
        assert_eq!(told("--band", &words), "write it into the experiment file, as band_hz under [tone]");
        assert!(told("--mass-kg", &words).contains("as mass_kg in [vehicle]"));
        assert!(told("--order", &words[..2]).starts_with("only an experiment file has a place for it, as order under"));
        assert_eq!(told("--mass-kg", &words[..2]) + &told("--colour", &words), "");
        let speed = ["hovertone", "speed", "bench.toml"].map(OsString::from);
        assert_eq!(place_in_experiment("--band", &speed), None);
    }
}
