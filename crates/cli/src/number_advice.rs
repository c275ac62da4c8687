//! What to do about a number that is out of its range.

use crate::see_help::{argument_of, see_help, typed_command};
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

/// "correct --window-s, in seconds: see …", where the name is that of a flag of the command, or of a key in a file.
pub(crate) fn correct_number(name: &str, words: &[OsString]) -> String {
    let name = name.rsplit('.').next().unwrap_or(name).trim_start_matches('-').replace('-', "_");
    let flag = format!("--{}", name.replace('_', "-"));
    let is_flag = typed_command(words).is_some_and(|command| argument_of(&command, &flag).is_some());
    let place = if is_flag { flag } else { name.clone() };
    let unit = UNITS.iter().find(|(end, _)| name.ends_with(end)).map(|(_, unit)| format!(", {unit}"));
    format!("correct {place}{}: {}", unit.unwrap_or_default(), see_help(words))
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
