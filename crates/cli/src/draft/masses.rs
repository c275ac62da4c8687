//! Loads as typed: `--mass 0.413=no_hull/*.mov`, whether the shell expanded the pattern or not.

use crate::args::{Typed, rounded, typed_mass_kg};
use crate::failure::Failure;
use crate::meant::{DECIMAL_SIGN, with_point};
use hovertone_vehicle::{KnownRotor, MASS_ALONE_KG_MAX};
use std::path::Path;

const GRAMS: f64 = 1e3;
const HINT: &str = "write the mass, in g or kg, before its recordings: --mass 413g=hover.mov, or --mass 0.413=hover.mov, or --mass 413g a.mov b.mov";
/// Behind a mass that says itself what to write.
const EXAMPLE: &str = "for example --mass 413g hover.mov";

/// One load: a mass as flown and its recordings.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LoadDraft {
    /// Mass of the vehicle with the load.
    pub(crate) mass_kg: f64,
    /// Names or patterns of its recordings.
    pub(crate) recordings: Vec<String>,
}

/// The loads of all `--mass`, in the order of their first names. Each word is `KG=FILE`, a mass whose files follow, or a file of the mass
/// before it. Equal masses are one load.
pub(crate) fn loads_from_words(words: &[String]) -> Result<Vec<LoadDraft>, Failure> {
    let mut loads: Vec<LoadDraft> = Vec::new();
    let mut current_kg = None;
    for word in words {
        if has_plus_minus(word) {
            return Err(Failure::usage(
                format!("--mass {word}: a mass has no ± here"),
                "give the mass alone, as in --mass 413g; an experiment file takes the standard uncertainty as mass_std_kg",
            ));
        }
        let (mass, file) = match word.split_once('=') {
            Some((mass, file)) if starts_as_number(mass) => (Some(mass), Some(file)),
            _ if starts_as_number(word) && !Path::new(word).exists() && !word.contains(['/', '*']) && is_mass(word) => {
                (Some(word.as_str()), None)
            }
            _ => (None, Some(word.as_str())),
        };
        if let Some(mass) = mass {
            let mass_kg =
                mass_kg_from_text(mass).map_err(|what| Failure::usage(format!("--mass {word}: {what}"), EXAMPLE))?;
            current_kg = Some(mass_kg);
            put_load(&mut loads, LoadDraft { mass_kg, recordings: Vec::new() });
        }
        if let Some(unit) = file.filter(|_| mass.is_none()).and_then(unknown_unit) {
            let what = format!("--mass {word}: hovertone does not know the unit \"{unit}\"");
            return Err(Failure::usage(what, "write kilograms, such as 0.413, or grams, such as 413g"));
        }
        if let Some(point) = file.filter(|_| mass.is_none()).and_then(mass_with_point) {
            return Err(Failure::usage(format!("--mass {word}: {DECIMAL_SIGN}"), format!("write --mass {point}")));
        }
        let Some(mass_kg) = current_kg else {
            let what = match word.split_once('=') {
                Some((mass, _)) => format!("\"{mass}\" is not a mass"),
                None => "the mass of this recording is missing".to_owned(),
            };
            return Err(Failure::usage(format!("--mass {word}: {what}"), HINT));
        };
        if let Some(toml) = file.filter(|file| file.ends_with(".toml")) {
            let what = format!("{toml} comes after --mass, so it counts as a recording");
            let hint = match Path::new(toml).exists() {
                true => "to use this experiment file, leave --mass out: it has its own masses".to_owned(),
                false => format!("to write a new experiment file, name it with -o, as in `hovertone init -o {toml}`"),
            };
            return Err(Failure::usage(what, hint));
        }
        let recordings = file.filter(|file| !file.is_empty()).map(str::to_owned).into_iter().collect();
        put_load(&mut loads, LoadDraft { mass_kg, recordings });
    }
    match loads.iter().find(|load| load.recordings.is_empty()) {
        Some(load) => {
            let what = format!("--mass {}: no recording is given for this mass", mass_words(load.mass_kg));
            Err(Failure::usage(what, HINT))
        }
        None => Ok(loads),
    }
}

/// Adds recordings to the load of the same mass, or a new load.
pub(crate) fn put_load(loads: &mut Vec<LoadDraft>, new: LoadDraft) {
    match loads.iter_mut().find(|load| load.mass_kg == new.mass_kg) {
        Some(load) => load.recordings.extend(new.recordings),
        None => loads.push(new),
    }
}

/// A mass as typed: `0.413`, `0.413kg`, `413g`.
pub(crate) fn mass_kg_from_text(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let is_positive = |typed: &Typed| typed.si.is_finite() && typed.si > 0.0;
    let Typed { si: mass_kg, has_unit } = typed_mass_kg(text).filter(is_positive).ok_or_else(|| {
        let point = if text.contains(',') { format!("; {DECIMAL_SIGN}") } else { String::new() };
        format!("\"{text}\" is not a mass: write kilograms, such as 0.413, or grams, such as 413g{point}")
    })?;
    if !has_unit && mass_kg > MASS_ALONE_KG_MAX {
        return Err(format!(
            "{text} without a unit is {mass_kg} kg: did you mean {mass_kg}g? If it is that heavy, write {mass_kg}kg"
        ));
    }
    let of_mass = KnownRotor { mass_kg: Some(mass_kg), ..KnownRotor::default() };
    of_mass.check().map_err(|error| error.to_string())?;
    Ok(mass_kg)
}

/// A mass for people: grams, without an exponent.
pub(crate) fn mass_words(mass_kg: f64) -> String {
    format!("{} g", rounded(mass_kg * GRAMS))
}

/// The letters behind a number, where the word is no file: "lb" of "500lb".
fn unknown_unit(word: &str) -> Option<&str> {
    let unit = word.trim_start_matches(|letter: char| letter.is_ascii_digit() || ".-+".contains(letter)).trim_start();
    let number = word.strip_suffix(unit)?.trim();
    let is_unit = !unit.is_empty() && unit.chars().all(char::is_alphabetic) && number.parse::<f64>().is_ok();
    // a recording has a point before its ending
    (is_unit && !number.ends_with('.') && !Path::new(word).exists()).then_some(unit)
}

/// Whether a word begins with a mass and its ±, and is no file.
fn has_plus_minus(word: &str) -> bool {
    let mass = word.split('=').next().unwrap_or(word);
    starts_as_number(mass) && ["±", "+-", "+/-"].iter().any(|sign| mass.contains(sign)) && !Path::new(word).exists()
}

/// A mass with a decimal comma, where the word is no file, with a point.
fn mass_with_point(word: &str) -> Option<String> {
    with_point(word).filter(|point| is_mass(point) && !Path::new(word).exists())
}

fn is_mass(word: &str) -> bool {
    typed_mass_kg(word).is_some()
}

fn starts_as_number(text: &str) -> bool {
    text.trim_start_matches(['-', '+', '.']).starts_with(|c: char| c.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loads(words: &[&str]) -> Result<Vec<(f64, String)>, String> {
        let words: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
        match loads_from_words(&words) {
            Ok(loads) => Ok(loads.into_iter().map(|load| (load.mass_kg, load.recordings.join(" "))).collect()),
            Err(Failure::Usage { what, .. }) => Err(what),
            Err(_) => panic!("wrong use ends with 2"),
        }
    }

    #[test]
    fn a_pattern_is_one_load_whether_the_shell_expanded_it_or_not() {
        let quoted = loads(&["0.413=no_hull/*.mov", "0.444=small/*.mov"]).unwrap();
        assert_eq!(quoted, [(0.413, "no_hull/*.mov".to_owned()), (0.444, "small/*.mov".to_owned())]);
        let of_shell = loads(&["0.413", "no_hull/1.mov", "no_hull/2.mov", "444g", "small/1.mov"]).unwrap();
        assert_eq!(of_shell, [(0.413, "no_hull/1.mov no_hull/2.mov".to_owned()), (0.444, "small/1.mov".to_owned())]);
        // 0.413={a,b}.mov, and 0.413=a.mov b.mov
        let braces = loads(&["0.413=a.mov", "0.413=b.mov", "c.mov"]).unwrap();
        assert_eq!(braces, [(0.413, "a.mov b.mov c.mov".to_owned())]);
        assert_eq!(loads(&["0.413=~/x=1/a.mov"]).unwrap()[0].1, "~/x=1/a.mov");
        assert!(loads(&["1.2=2024-05-01/a.mov", "2024=x/a.mov"]).unwrap_err().contains("2024g"));
        assert_eq!(loads(&["1.2", "2024-05-01/a.mov"]).unwrap()[0].1, "2024-05-01/a.mov");
    }

    #[test]
    fn what_is_no_load_says_how_to_write_one() {
        for (words, said) in [
            (&["a.mov"][..], "the mass of this recording is missing"),
            (&["0.413"], "no recording"),
            (&["0.413="], "no recording"),
            (&["0.413", "0.444=b.mov"], "413 g: no recording"),
            (&["0,413=a.mov"], "the decimal sign is a point"),
            (&["0,413", "a.mov"], "--mass 0,413: the decimal sign is a point"),
            (&["0.413", "a.mov", "0,462kg", "b.mov"], "--mass 0,462kg: the decimal sign is a point"),
            (&["0.413±0.001", "a.mov"], "a mass has no ± here"),
            (&["413g+-1g=a.mov"], "a mass has no ± here"),
            (&["413=a.mov"], "413g"),
            (&["-0.4=a.mov"], "is not a mass"),
            (&["0.0005=a.mov"], "mass_kg = 0.0005, but it must be from 0.001"),
            (&["0.4=a.mov", "experiment.toml"], "counts as a recording"),
        ] {
            let what = loads(words).unwrap_err();
            assert!(what.contains(said), "{words:?}: {what}");
        }
    }

    #[test]
    fn masses_have_units() {
        assert_eq!(mass_kg_from_text("413g"), Ok(0.413));
        assert_eq!(mass_kg_from_text("413 g"), Ok(0.413));
        assert_eq!(mass_kg_from_text("60kg"), Ok(60.0));
        assert_eq!(mass_words(0.413), "413 g");
        assert_eq!(mass_words(0.1 + 0.2), "300 g");
    }
}
