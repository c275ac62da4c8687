//! Common slips of a command line, and what was meant.

use crate::see_help::{argument_of, command_of, is_typed};
use hovertone_exchange::SimulatorFormat;
use std::ffi::OsString;
use std::path::Path;

/// What is wrong with a decimal comma.
pub(crate) const DECIMAL_SIGN: &str = "the decimal sign is a point";

/// What is wrong with a percent sign.
pub(crate) const SHARE_SIGN: &str = "a share is a number without a percent sign";

/// A number with a decimal comma or a percent sign: what is wrong, and what to write.
pub(crate) fn number_meant(value: &str) -> Option<(&'static str, String)> {
    if let Some(point) = with_point(value) {
        let write = match thousands(value) {
            Some(whole) => format!("write {whole}, or {point} for a number with decimals"),
            None => format!("write {point}"),
        };
        return Some((DECIMAL_SIGN, write));
    }
    let percent: f64 =
        with_point(value.strip_suffix('%')?).as_deref().or(value.strip_suffix('%'))?.trim().parse().ok()?;
    Some((SHARE_SIGN, format!("write {}", percent / 100.0)))
}

/// The number that a comma stands in, with a point; also of a number with a unit, and of numbers with a colon between them.
pub(crate) fn with_point(word: &str) -> Option<String> {
    let of_part = |part: &str| {
        let point = part.replacen(',', ".", 1);
        let is_unit = |letter: char| letter.is_alphabetic() || letter == '"';
        point.trim_end_matches(is_unit).trim_end().parse::<f64>().is_ok().then_some(point)
    };
    let parts: Option<Vec<String>> = word.split(':').map(of_part).collect();
    parts.map(|parts| parts.join(":")).filter(|point| point != word)
}

/// The number whose comma may stand between thousands: three digits behind one to three that do not begin with 0.
fn thousands(word: &str) -> Option<String> {
    let (before, behind) = word.split_once(',')?;
    let is_whole = |digits: &str| digits.bytes().all(|digit| digit.is_ascii_digit());
    let is_head = (1..=3).contains(&before.len()) && is_whole(before) && !before.starts_with('0');
    (is_head && behind.len() == 3 && is_whole(behind)).then(|| format!("{before}{behind}"))
}

/// What was meant by a flag that the command does not have: a long flag with one dash, or a file for what is printed.
pub(crate) fn flag_meant(name: &str, words: &[OsString]) -> Option<String> {
    if name == "-o" || name == "--output" {
        return Some("the results go to stdout: write > and the name of a file behind the command".to_owned());
    }
    let command = command_of(words)?;
    if ["--figure", "--plot", "--picture"].contains(&name) && ["speed", "tones"].contains(&command.get_name()) {
        return Some("`hovertone spectrogram` draws a recording with the tracks of its rotors".to_owned());
    }
    let rests = words.iter().filter_map(|word| word.to_str()?.strip_prefix('-'));
    let is_meant = |rest: &&str| {
        let flag = rest.split('=').next().unwrap_or_default();
        format!("-{rest}").starts_with(name) && flag.len() > 1 && argument_of(&command, &format!("--{flag}")).is_some()
    };
    rests.into_iter().find(is_meant).map(|rest| format!("a long flag has two dashes: write --{rest}"))
}

/// What to do with a word that is no flag and has no place in the command.
pub(crate) fn place_meant(name: &str, words: &[OsString]) -> Option<String> {
    let ending = Path::new(name).extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    match words.get(1)?.to_str()? {
        "spectrogram" if ending == "png" || ending == "svg" => Some(format!("write -o {name}")),
        "spectrogram" | "calibrate" => Some("give one recording at a time".to_owned()),
        "export" if SimulatorFormat::ALL.iter().any(|format| format.name() == name) => {
            Some(format!("write --to {name}"))
        }
        "identify" if ending != "toml" => {
            Some("recordings stand behind their mass, as in --mass 413g hover.mov".to_owned())
        }
        _ => None,
    }
}

/// The results among the words of a command that takes them by a flag.
pub(crate) fn results_meant(words: &[OsString]) -> Option<String> {
    words.get(1).filter(|command| *command == "weigh" && !is_typed(words, "--constant"))?;
    let results = words.iter().filter_map(|word| word.to_str()).find(|word| word.ends_with(".json"))?;
    Some(format!("write --constant {results}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<OsString> {
        line.split(' ').map(OsString::from).collect()
    }

    #[test]
    fn numbers_of_other_spellings_are_understood() {
        for (typed, meant) in [
            ("0,2", "write 0.2"),
            ("62,08", "write 62.08"),
            ("3%", "write 0.03"),
            ("2,5%", "write 0.025"),
            ("0,413kg", "write 0.413kg"),
            ("8,5 in", "write 8.5 in"),
            ("100,5:200", "write 100.5:200"),
            ("1:02,5", "write 1:02.5"),
            ("20,000", "write 20000, or 20.000 for a number with decimals"),
            ("0,413", "write 0.413"),
        ] {
            assert_eq!(number_meant(typed).map(|(_, hint)| hint).as_deref(), Some(meant), "{typed}");
        }
        assert_eq!(number_meant("1,000,000"), None);
        for no_number in ["ten %", ",", "a,b", "kg", "8:69"] {
            assert_eq!(number_meant(no_number), None, "{no_number}");
        }
    }

    #[test]
    fn flags_and_words_in_a_wrong_place_are_understood() {
        let meant = |name: &str, line: &str| flag_meant(name, &words(line)).unwrap_or_default();
        assert_eq!(meant("-b", "hovertone speed -blades 2 a.wav"), "a long flag has two dashes: write --blades");
        assert_eq!(meant("-b", "hovertone speed -blades=2 a.wav"), "a long flag has two dashes: write --blades=2");
        assert_eq!(meant("-x", "hovertone speed -x a.wav"), "");
        assert!(meant("-o", "hovertone speed a.wav -o x.json").starts_with("the results go to stdout"));
        assert!(meant("--figure", "hovertone speed a.wav --figure x.png").starts_with("`hovertone spectrogram` draws"));
        let place = |name: &str, line: &str| place_meant(name, &words(line)).unwrap_or_default();
        assert_eq!(place("x.png", "hovertone spectrogram a.wav x.png"), "write -o x.png");
        assert_eq!(place("gazebo", "hovertone export r.json gazebo"), "write --to gazebo");
        assert!(place("b.wav", "hovertone identify a.wav b.wav --mass 413g").starts_with("recordings stand behind"));
        let results = words("hovertone weigh out/results.json a.wav");
        assert_eq!(results_meant(&results).as_deref(), Some("write --constant out/results.json"));
    }
}
