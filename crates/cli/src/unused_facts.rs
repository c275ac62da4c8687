//! Facts that were given to `hovertone export` and change nothing: the text has no place for them, or has them already.

use crate::args::ExportArguments;
use crate::terminal::Terminal;
use hovertone_exchange::{IdentifiedRotor, ModelError, SimulatorFormat, export_text};
use hovertone_report::Notice;
use hovertone_vehicle::in_list;

/// A fact that a flag gives.
pub(crate) struct Given {
    flag: &'static str,
    value: f64,
    fact: Fact,
}

impl Given {
    /// Whether the text of a format is another without this fact.
    fn is_in(&self, format: SimulatorFormat, rotor: &IdentifiedRotor) -> bool {
        let text_with = |value: Option<f64>| {
            let mut other = rotor.clone();
            *(self.fact)(&mut other) = value;
            export_text(&other, format).ok()
        };
        text_with(Some(self.value)).is_some_and(|text| text_with(None).is_none_or(|without| without != text))
    }
}

/// Why a given fact changes nothing.
pub(crate) struct Unused<'a> {
    /// Where the text has no place for it.
    pub(crate) without_place: &'a dyn Fn(&Given) -> Notice,
    /// Where the text has this very number already.
    pub(crate) same: Notice,
}

/// Names the given facts without which the text that is made of the rotor is the same. Another value tells whether the text has a place for it.
pub(crate) fn say_unused(
    rotor: &IdentifiedRotor,
    arguments: &ExportArguments,
    why: &Unused<'_>,
    text_of: impl Fn(&IdentifiedRotor) -> Result<String, ModelError>,
    terminal: &mut Terminal,
) {
    let Ok(text) = text_of(rotor) else { return };
    for (flag, given, fact) in [
        ("--torque-constant-n-m-s2", arguments.torque_constant_n_m_s2, torque_of as Fact),
        ("--hover-command", arguments.hover_command, command_of),
        ("--diameter-m", arguments.diameter_m, diameter_of),
        ("--air-density-kg-m3", arguments.air_density_kg_m3, density_of),
    ] {
        let Some(value) = given else { continue };
        let is_same_with = |value: Option<f64>| {
            let mut other = rotor.clone();
            *fact(&mut other) = value;
            text_of(&other).is_ok_and(|other| other == text)
        };
        if is_same_with(None) {
            let why = match is_same_with(Some(0.5 * value)) {
                true => (why.without_place)(&Given { flag, value, fact }),
                false => why.same.clone(),
            };
            terminal.warning(&Notice::new(format!("{flag} changes nothing: {}", why.text), &why.hint), "");
        }
    }
}

/// A fact of a rotor, to be changed.
type Fact = fn(&mut IdentifiedRotor) -> &mut Option<f64>;

fn torque_of(rotor: &mut IdentifiedRotor) -> &mut Option<f64> {
    &mut rotor.torque_constant_n_m_s2
}

fn command_of(rotor: &mut IdentifiedRotor) -> &mut Option<f64> {
    &mut rotor.hover_command
}

fn diameter_of(rotor: &mut IdentifiedRotor) -> &mut Option<f64> {
    &mut rotor.propeller_diameter_m
}

fn density_of(rotor: &mut IdentifiedRotor) -> &mut Option<f64> {
    &mut rotor.air_density_kg_m3
}

/// Why a fact is not in the text of a format: C_T needs another fact too, or only other formats have a number for it.
pub(crate) fn no_place_in(format: SimulatorFormat, given: &Given, rotor: &IdentifiedRotor) -> Notice {
    let partner = match given.flag {
        "--diameter-m" => Some(("--air-density-kg-m3", "the density of the air", density_of as Fact)),
        "--air-density-kg-m3" => Some(("--diameter-m", "the diameter of the propellers", diameter_of as Fact)),
        _ => None,
    };
    if let Some((flag, name, fact)) = partner {
        let mut complete = rotor.clone();
        fact(&mut complete).get_or_insert(1.0);
        if given.is_in(format, &complete) {
            let text = format!("the thrust coefficient C_T needs {name} too");
            return Notice::new(text, format!("give {flag} too, or leave {} out", given.flag));
        }
    }
    if given.flag == "--hover-command" && rotor.mass_kg.is_none() {
        return Notice::new(
            "the thrust in a hover needs the mass, and these results have no mass",
            "leave the flag out",
        );
    }
    let all = SimulatorFormat::ALL.into_iter().filter(|format| given.is_in(*format, rotor));
    let names: Vec<&str> = all.map(SimulatorFormat::name).collect();
    let hint = match names[..] {
        [] => "leave the flag out".to_owned(),
        [only] => format!("leave the flag out, or give --to {only}: this format has a number for it"),
        _ => format!("leave the flag out, or choose a format with a number for it: --to {}", in_list(&names, "or")),
    };
    Notice::new(format!("the format {} has no number for it", format.name()), hint)
}
