//! From headers to quantities and units.

use crate::csv_text::CsvText;
use csv::StringRecord;
use hovertone_vehicle::GRAVITY_STANDARD_M_S2;
use std::f64::consts::TAU;

/// Radians per second in a turn per minute.
pub(super) const RPM_RAD_S: f64 = TAU / 60.0;
/// Kilograms in a pound.
const POUND_KG: f64 = 0.453_592_37;
/// Kilograms in an ounce.
const OUNCE_KG: f64 = POUND_KG / 16.0;
/// Coverage factor of expanded uncertainties.
const COVERAGE_FACTOR: f64 = 2.0;
/// Metres in an inch.
const INCH_M: f64 = 0.0254;

/// Quantity of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    Speed,
    SpeedStd,
    Thrust,
    ThrustStd,
    Mass,
    MassStd,
    Torque,
    ShaftPower,
    ElectricalPower,
    Voltage,
    Current,
}

/// A column of a table.
pub(super) struct Column {
    pub(super) index: usize,
    pub(super) header: String,
    pub(super) quantity: Option<Quantity>,
    /// Whether the column has words: names of groups or of rows.
    pub(super) is_words: bool,
    /// Whether the column is a thrust or a torque without a known unit.
    pub(super) lacks_unit: bool,
    /// SI units per unit of the column.
    pub(super) si_per_unit: f64,
    /// Whether the column is a standard uncertainty in percent of the measured value; then `si_per_unit` is 0.01.
    pub(super) is_share: bool,
    /// Whether the column is a standard uncertainty of which the header does not say the quantity.
    pub(super) lacks_quantity: bool,
}

impl Column {
    /// The number in a row, in SI units.
    pub(super) fn number(&self, csv: &CsvText, record: &StringRecord) -> Option<f64> {
        Some(csv.number(record.get(self.index)?)? * self.si_per_unit)
    }

    /// Whether the header says that the column is a torque.
    pub(super) fn names_torque(&self) -> bool {
        words_of(&self.header.to_lowercase()).any(|word| word == "torque")
    }

    /// The quantity of its standard uncertainty, for a column of forces or of speeds.
    pub(super) fn std_quantity(&self) -> Option<Quantity> {
        match self.quantity? {
            Quantity::Speed => Some(Quantity::SpeedStd),
            Quantity::Thrust => Some(Quantity::ThrustStd),
            Quantity::Mass => Some(Quantity::MassStd),
            _ => None,
        }
    }

    /// Whether the column is an expanded uncertainty with k = 2: twice a standard uncertainty.
    pub(super) fn is_expanded(&self) -> bool {
        let is_std = matches!(self.quantity, Some(Quantity::SpeedStd | Quantity::ThrustStd | Quantity::MassStd));
        let lower = self.header.to_lowercase();
        let names_k = ["k2", "k=2", "k = 2"].iter().any(|factor| lower.contains(factor));
        is_std
            && (names_k
                || words_of(&lower).any(|word| word == "expanded")
                || words_of(&self.header).any(|word| word == "U"))
    }

    /// Whether the header says Hz, and not turns: it may be the frequency of a tone.
    pub(super) fn is_in_hz(&self) -> bool {
        let lower = self.header.to_lowercase();
        words_of(&lower).any(|word| word == "hz") && !words_of(&lower).any(|word| ["rev", "rps"].contains(&word))
    }

    /// Whether the header says that the rotor is meant, and not the motor.
    pub(super) fn names_rotor(&self) -> bool {
        words_of(&self.header.to_lowercase()).any(|word| ROTOR.contains(&word))
    }
}

/// The number before the word "rotor" or "rotors" in a header.
pub(super) fn rotors_in(header: &str) -> Option<u32> {
    let lower = header.to_lowercase();
    let before = lower[..lower.find("rotor")?].trim_end_matches([' ', '_', '-']);
    let digits = before.len() - before.trim_end_matches(|letter: char| letter.is_ascii_digit()).len();
    before[before.len() - digits..].parse().ok()
}

pub(super) fn columns_of(headers: &StringRecord, records: &[StringRecord]) -> Vec<Column> {
    let column = |(index, header): (usize, &str)| {
        let meaning = meaning_of(header);
        let known = match meaning {
            Meaning::Known(quantity, si_per_unit) => Some((quantity, si_per_unit)),
            Meaning::Share(quantity) => Some((quantity, 0.01)),
            Meaning::UnknownUnit | Meaning::StdOfUnknown | Meaning::Other => None,
        };
        let cells = || records.iter().filter_map(|record| record.get(index));
        let is_word = |cell: &str| !cell.is_empty() && cell.replacen(',', ".", 1).parse::<f64>().is_err();
        let mut column = Column {
            index,
            header: header.to_owned(),
            quantity: known.map(|(quantity, _)| quantity),
            is_words: known.is_none()
                && !records.is_empty()
                && (cells().all(is_word) || NAMED_PARTS.contains(&header.trim().to_lowercase().as_str())),
            lacks_unit: matches!(meaning, Meaning::UnknownUnit),
            lacks_quantity: matches!(meaning, Meaning::StdOfUnknown),
            is_share: matches!(meaning, Meaning::Share(_)),
            si_per_unit: known.map_or(1.0, |(_, si_per_unit)| si_per_unit),
        };
        if column.is_expanded() {
            column.si_per_unit /= COVERAGE_FACTOR;
        }
        column
    };
    headers.iter().enumerate().map(column).collect()
}

/// Meaning of a header.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Meaning {
    /// A quantity, and the number of SI units per unit.
    Known(Quantity, f64),
    /// The standard uncertainty of a quantity, in percent of it.
    Share(Quantity),
    /// A thrust or a torque with an unknown unit, or without a unit.
    UnknownUnit,
    /// A standard uncertainty in percent, of whatever.
    StdOfUnknown,
    /// Any other column.
    Other,
}

/// Words of columns that contain the name of a thrust or a speed but are neither: ratios, rates, settings, errors of an unknown kind.
const NO_MEASUREMENT: [&str; 15] = [
    "efficiency",
    "acceleration",
    "settling",
    "kv",
    "specific",
    "percent",
    "error",
    "err",
    "tolerance",
    "offset",
    "tare",
    "target",
    "setpoint",
    "coefficient",
    "constant",
];
/// Words of standard uncertainties.
const STD: [&str; 9] = ["std", "stddev", "stdev", "sd", "sigma", "uncertainty", "unc", "u", "se"];
/// Words of masses that are parts and do not hover.
const PARTS: [&str; 8] = ["motor", "prop", "propeller", "battery", "frame", "arm", "cell", "blade"];

/// Headers of columns that name a part, also where a name is a number: a propeller 1045.
const NAMED_PARTS: [&str; 4] = ["propeller", "prop", "motor", "esc"];
/// Words of a rotor.
const ROTOR: [&str; 4] = ["rotor", "prop", "propeller", "wheel"];

fn words_of(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty())
}

fn meaning_of(header: &str) -> Meaning {
    let lower = header.to_lowercase().replace(['²', '^'], "2");
    let words: Vec<&str> = words_of(&lower).collect();
    let has = |any: &[&str]| words.iter().any(|word| any.contains(word));
    if has(&STD) && (has(&["percent", "pct"]) || lower.contains('%')) {
        return share_of(&words);
    }
    if has(&NO_MEASUREMENT) {
        return Meaning::Other;
    }
    let either = |plain, std| if has(&STD) { std } else { plain };
    let measured = |quantity, si_per_unit: Option<f64>| {
        si_per_unit.map_or(Meaning::UnknownUnit, |si_per_unit| Meaning::Known(quantity, si_per_unit))
    };
    if has(&["torque"]) {
        return if has(&STD) { Meaning::Other } else { measured(Quantity::Torque, torque_unit_n_m(&words)) };
    }
    let has_force = has(&["thrust", "lift", "force"]);
    if has_force && has(&["w", "watt"]) {
        // thrust per watt
        return Meaning::Other;
    }
    if has_force || has(&["weight"]) && newtons_in(&words).is_some() {
        let unit_n = newtons_in(&words).or(kilograms_in(&words).map(|kg| kg * GRAVITY_STANDARD_M_S2));
        return measured(either(Quantity::Thrust, Quantity::ThrustStd), unit_n);
    }
    if has(&["mass", "weight", "load"]) && !has(&PARTS) {
        let unit_kg = kilograms_in(&words);
        return unit_kg.map_or(Meaning::Other, |kg| Meaning::Known(either(Quantity::Mass, Quantity::MassStd), kg));
    }
    let speed = |rad_s: f64| Meaning::Known(either(Quantity::Speed, Quantity::SpeedStd), rad_s);
    if has(&["rpm"]) {
        speed(RPM_RAD_S)
    } else if has(&["rad"]) && has(&["s"]) && has(&["speed"]) || has(&["omega", "ω"]) || words == ["rad", "s"] {
        // a unit that stands alone names the speed of the rotor
        speed(1.0)
    } else if has(&["rev", "rps"]) || has(&["hz"]) && has(&["speed", "shaft"]) {
        speed(TAU)
    } else if has(&["power"]) {
        let is_shaft = has(&["mechanical", "shaft"]);
        let unit_w = if has(&["kw"]) {
            1e3
        } else if has(&["mw"]) {
            1e-3
        } else {
            1.0
        };
        Meaning::Known(if is_shaft { Quantity::ShaftPower } else { Quantity::ElectricalPower }, unit_w)
    } else if has(&["voltage", "volt", "volts"]) {
        Meaning::Known(Quantity::Voltage, if has(&["mv"]) { 1e-3 } else { 1.0 })
    } else if has(&["current", "amps", "ampere", "amperes"]) {
        Meaning::Known(Quantity::Current, if has(&["ma"]) { 1e-3 } else { 1.0 })
    } else {
        Meaning::Other
    }
}

/// The meaning of a standard uncertainty in percent.
fn share_of(words: &[&str]) -> Meaning {
    let has = |any: &[&str]| words.iter().any(|word| any.contains(word));
    match () {
        () if has(&["thrust", "lift", "force"]) => Meaning::Share(Quantity::ThrustStd),
        () if has(&["mass", "weight", "load"]) => Meaning::Share(Quantity::MassStd),
        () if has(&["rpm", "speed", "omega", "rps"]) => Meaning::Share(Quantity::SpeedStd),
        () if has(&["torque", "power", "voltage", "current"]) => Meaning::Other,
        () => Meaning::StdOfUnknown,
    }
}

/// The unit of force that is a word of its own.
fn newtons_in(words: &[&str]) -> Option<f64> {
    words.iter().find_map(|word| match *word {
        "n" => Some(1.0),
        "mn" => Some(1e-3),
        _ => None,
    })
}

/// The unit of mass, or the force of that mass under standard gravity.
fn kilograms_in(words: &[&str]) -> Option<f64> {
    words.iter().find_map(|word| match *word {
        "gf" | "g" | "gram" | "grams" | "gramm" => Some(1e-3),
        "kgf" | "kg" | "kp" => Some(1.0),
        "lbf" | "lb" | "lbs" => Some(POUND_KG),
        "ozf" | "oz" => Some(OUNCE_KG),
        _ => None,
    })
}

/// Newton metres in the unit of a torque: a force and a length, in two words or one.
fn torque_unit_n_m(words: &[&str]) -> Option<f64> {
    let joined = words.iter().find_map(|word| match *word {
        "nm" => Some(1.0),
        "mnm" => Some(1e-3),
        "ncm" => Some(1e-2),
        "nmm" => Some(1e-3),
        _ => None,
    });
    let force_n = newtons_in(words).or(kilograms_in(words).map(|kg| kg * GRAVITY_STANDARD_M_S2));
    let length_m = words.iter().find_map(|word| match *word {
        "m" => Some(1.0),
        "cm" => Some(1e-2),
        "mm" => Some(1e-3),
        "in" | "inch" => Some(INCH_M),
        "ft" => Some(12.0 * INCH_M),
        _ => None,
    });
    joined.or(force_n.zip(length_m).map(|(force_n, length_m)| force_n * length_m))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_may_say_of_how_many_rotors() {
        let rotors: Vec<Option<u32>> =
            ["thrust_g_4rotors", "Thrust of 6 rotors (N)", "rotor_thrust_n", "thrust_n"].map(rotors_in).into();
        assert_eq!(rotors, [Some(4), Some(6), None, None]);
    }

    #[test]
    fn headers_as_people_write_them() {
        for (header, quantity, si_per_unit) in [
            ("Motor Electrical Speed (RPM)", Quantity::Speed, RPM_RAD_S),
            ("rpm", Quantity::Speed, RPM_RAD_S),
            ("avg_rpm", Quantity::Speed, RPM_RAD_S),
            ("speed_rad_s", Quantity::Speed, 1.0),
            ("omega [rad/s]", Quantity::Speed, 1.0),
            ("rad/s", Quantity::Speed, 1.0),
            ("[rad/s]", Quantity::Speed, 1.0),
            ("rev/s", Quantity::Speed, TAU),
            ("speed_rev_s", Quantity::Speed, TAU),
            ("speed_std_rpm", Quantity::SpeedStd, RPM_RAD_S),
            ("Thrust (gf)", Quantity::Thrust, 9.80665e-3),
            ("Thrust (N)", Quantity::Thrust, 1.0),
            ("thrust_g_4rotors", Quantity::Thrust, 9.80665e-3),
            ("thrust_std_n", Quantity::ThrustStd, 1.0),
            ("mass_g", Quantity::Mass, 1e-3),
            ("mass_std_g", Quantity::MassStd, 1e-3),
            ("Motor thrust (mN)", Quantity::Thrust, 1e-3),
            ("thrust_ozf", Quantity::Thrust, 0.278_013_85),
            ("thrust_stddev_n", Quantity::ThrustStd, 1.0),
            ("weight_n", Quantity::Thrust, 1.0),
            ("Torque (N·m)", Quantity::Torque, 1.0),
            ("Torque (lbf·in)", Quantity::Torque, 0.112_984_829),
            ("Torque (ozf·in)", Quantity::Torque, 7.061_551_81e-3),
            ("torque_mnm", Quantity::Torque, 1e-3),
            ("Torque (kgf.cm)", Quantity::Torque, 0.0980665),
            ("Mechanical Power (W)", Quantity::ShaftPower, 1.0),
            ("Electrical Power (W)", Quantity::ElectricalPower, 1.0),
            ("voltage_V", Quantity::Voltage, 1.0),
            ("current_A", Quantity::Current, 1.0),
        ] {
            let Meaning::Known(found, factor) = meaning_of(header) else { panic!("{header}") };
            assert_eq!(found, quantity, "{header}");
            assert!((factor / si_per_unit - 1.0).abs() < 1e-8, "{header}: {factor}");
        }
        for header in [
            "Time (s)",
            "motor",
            "prop",
            "Overall Efficiency (gf/W)",
            "Max acceleration (RPM/s)",
            "AccX (g)",
            "ESC signal (µs)",
            "Specific thrust (g/W)",
            "thrust_error_n",
            "thrust_constant_total_n_s2",
            "thrust_constant_total_std_n_s2",
            "propeller mass (g)",
            "Load cell 1 (g)",
            "Motor Efficiency (%)",
            "Propeller Mech. Efficiency (N/W)",
            "90% settling time (s)",
        ] {
            assert_eq!(meaning_of(header), Meaning::Other, "{header}");
        }
    }
    #[test]
    fn units_that_are_not_known_are_not_guessed() {
        for header in ["thrust", "Thrust (%)", "torque", "Torque (foo)", "lift_stone"] {
            assert_eq!(meaning_of(header), Meaning::UnknownUnit, "{header}");
        }
    }
}
