//! What to do about a number that is out of its range.

use crate::see_help::{argument_of, command_of, see_help};
use hovertone_report::significant;
use std::ffi::OsString;

/// Ends of names, and what a number of that name is in.
const UNITS: [(&str, &str); 15] = [
    ("_n_m_s2", "in N m/(rad/s)²"),
    ("height_m", "in m"),
    ("_ppm", "in millionths"),
    ("_hpa", "in hPa, as a weather report has it"),
    ("_percent", "in percent"),
    ("_deg", "in degrees"),
    ("_rpm", "in turns per minute"),
    ("_hz", "in Hz"),
    ("_kg", "in kg, or with its unit, as in 413g"),
    ("_share", "as a share: 0.03 is 3 %"),
    ("_m_s2", "in m/s²"),
    ("_n_s2", "in N/(rad/s)²"),
    ("_m", "in m, or with its unit, as in 24cm or 8in"),
    ("_s", "in seconds"),
    ("_c", "in degrees Celsius"),
];

/// Numbers below this are written with an exponent.
const SMALL: f64 = 1e-3;

/// "correct --window-s, in seconds: see …", where the name is that of a flag of the command, or of a key in a file.
pub(crate) fn correct_number(name: &str, words: &[OsString]) -> String {
    let name = name.rsplit('.').next().unwrap_or(name).trim_start_matches('-').replace('-', "_");
    let flag = format!("--{}", name.replace('_', "-"));
    let is_flag = command_of(words).is_some_and(|command| argument_of(&command, &flag).is_some());
    let place = if is_flag { flag } else { name.clone() };
    let unit = unit_of(&name).map_or(String::new(), |unit| format!(", {unit}"));
    format!("correct {place}{unit}: {}", see_help(words))
}

/// What a number of this name, in the spelling of files, is in.
fn unit_of(name: &str) -> Option<&'static str> {
    UNITS.iter().find(|(end, _)| name.ends_with(end)).map(|(_, unit)| *unit)
}

/// What to write for a percentage that a flag does not take. That of a standard uncertainty is computed where its value is given too.
pub(crate) fn no_percent(flag: &str, percent: &str, words: &[OsString]) -> String {
    let of_flag = flag.replacen("-std", "", 1);
    let whole = words.windows(2).find(|pair| flag != of_flag && pair[0] == *of_flag);
    let number = |word: &str| word.trim().parse::<f64>().ok();
    let numbers = whole.and_then(|pair| Some((pair[1].to_str()?, number(percent.strip_suffix('%')?)?)));
    if let Some((whole, percent)) = numbers
        && let Some(value) = number(whole)
    {
        let part = value * percent / 100.0;
        let shown = |part: f64| if part.abs() < SMALL { format!("{part:.2e}") } else { significant(part, 3) };
        return format!(
            "{percent} % of {whole} is {}; the flag takes the standard uncertainty, so if {percent} % is a ± (k = 2), give half of it: {}",
            shown(part),
            shown(part / 2.0)
        );
    }
    match unit_of(&flag.trim_start_matches('-').replace('-', "_")) {
        Some("in millionths") => "give it in millionths (ppm): 1 % is 10000 ppm".to_owned(),
        Some(unit) => format!("give it {unit}"),
        None => see_help(words),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_flag_and_its_unit_are_named() {
        let words = ["hovertone", "speed", "a.wav", "--window-s", "-1"].map(OsString::from);
        for (name, advice) in [
            ("window_s", "correct --window-s, in seconds"),
            ("rotors", "correct --rotors"),
            ("diameter_m", "correct --diameter-m, in m, or with its unit, as in 24cm or 8in"),
            ("clock_ppm", "correct --clock-ppm, in millionths"),
            ("vehicle.mass_kg", "correct --mass-kg, in kg, or with its unit, as in 413g"),
            ("hop_ratio", "correct hop_ratio"),
        ] {
            assert_eq!(correct_number(name, &words), format!("{advice}: see `hovertone speed --help`"));
        }
    }
}
