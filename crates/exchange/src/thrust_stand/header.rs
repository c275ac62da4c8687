//! From the words of a header to a quantity and a unit.

use super::coverage::{Coverage, is_word_of_uncertainty};
use hovertone_vehicle::GRAVITY_STANDARD_M_S2;
use std::f64::consts::TAU;

/// Radians per second in a turn per minute.
pub(super) const RPM_RAD_S: f64 = TAU / 60.0;
/// Kilograms in a pound.
const POUND_KG: f64 = 0.453_592_37;
/// Kilograms in an ounce.
const OUNCE_KG: f64 = POUND_KG / 16.0;
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

impl Quantity {
    /// Whether it is the standard uncertainty of another quantity.
    pub(super) fn is_std(self) -> bool {
        matches!(self, Self::SpeedStd | Self::ThrustStd | Self::MassStd)
    }
}

/// Meaning of a header.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Meaning {
    /// A quantity, and the number of SI units per unit.
    Known(Quantity, f64),
    /// The standard uncertainty of a quantity, in percent of it.
    Share(Quantity),
    /// A thrust or a torque with an unknown unit, or without a unit.
    UnknownUnit,
    /// A standard uncertainty of a thrust with an unknown unit, or without a unit.
    UnknownStdUnit,
    /// A standard uncertainty, of whatever.
    StdOfUnknown,
    /// An error or a tolerance of a measured quantity: whether it is a standard uncertainty, the header does not say.
    UnknownKind,
    /// Any other column.
    Other,
}

/// Words of columns that contain the name of a thrust or a speed but are neither: ratios, rates, settings.
const NO_MEASUREMENT: [&str; 12] = [
    "efficiency",
    "acceleration",
    "settling",
    "kv",
    "specific",
    "percent",
    "offset",
    "tare",
    "target",
    "setpoint",
    "coefficient",
    "constant",
];
/// Words of uncertainties of an unknown kind.
const UNKNOWN_KIND: [&str; 9] =
    ["error", "err", "tolerance", "tol", "accuracy", "precision", "deviation", "ci", "confidence"];
/// Units that a column of uncertainties may have without a word for its quantity.
const UNITS: [&str; 8] = ["n", "mn", "g", "gf", "kg", "kgf", "lbf", "ozf"];
/// Words of masses that are parts and do not hover.
const PARTS: [&str; 8] = ["motor", "prop", "propeller", "battery", "frame", "arm", "cell", "blade"];

pub(super) fn words_of(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty())
}

/// The meaning of a header, of which the coverage is known.
pub(super) fn meaning_of(coverage: &Coverage) -> Meaning {
    let lower = coverage.rest.to_lowercase().replace(['²', '^'], "2");
    let words: Vec<&str> = words_of(&lower).collect();
    let has = |any: &[&str]| words.iter().any(|word| any.contains(word));
    if !coverage.is_uncertainty && has(&UNKNOWN_KIND) {
        let as_std = Coverage { is_uncertainty: true, is_certainly: true, ..coverage.clone() };
        return match meaning_of(&as_std) {
            Meaning::Known(quantity, _) if quantity.is_std() => Meaning::UnknownKind,
            Meaning::Share(_) | Meaning::UnknownStdUnit => Meaning::UnknownKind,
            _ => Meaning::Other,
        };
    }
    if coverage.is_uncertainty && (has(&["percent", "pct"]) || lower.contains('%')) {
        return share_of(&words);
    }
    if has(&NO_MEASUREMENT) {
        return Meaning::Other;
    }
    match measured_in(&words, coverage) {
        Meaning::Other if lacks_quantity(&words, coverage) => Meaning::StdOfUnknown,
        meaning => meaning,
    }
}

/// Whether a header names an uncertainty, and at most its unit. The letter u alone is also a voltage.
fn lacks_quantity(words: &[&str], coverage: &Coverage) -> bool {
    coverage.is_uncertainty
        && words.iter().all(|word| UNITS.contains(word) || is_word_of_uncertainty(word))
        && (words.len() > 1 || coverage.is_certainly)
}

/// The measured quantity, or its standard uncertainty, and the unit.
fn measured_in(words: &[&str], coverage: &Coverage) -> Meaning {
    let has = |any: &[&str]| words.iter().any(|word| any.contains(word));
    let is_std = coverage.is_uncertainty;
    let measured = |quantity, si_per_unit: Option<f64>| {
        let unknown = if is_std { Meaning::UnknownStdUnit } else { Meaning::UnknownUnit };
        si_per_unit.map_or(unknown, |si_per_unit| Meaning::Known(quantity, si_per_unit))
    };
    if has(&["torque"]) {
        return if is_std { Meaning::Other } else { measured(Quantity::Torque, torque_unit_n_m(words)) };
    }
    let either = |plain, std| if is_std { std } else { plain };
    let has_force = has(&["thrust", "lift", "force"]);
    if has_force && has(&["w", "watt"]) {
        // thrust per watt
        return Meaning::Other;
    }
    if has_force || has(&["weight"]) && newtons_in(words).is_some() {
        let unit_n = newtons_in(words).or(kilograms_in(words).map(|kg| kg * GRAVITY_STANDARD_M_S2));
        return measured(either(Quantity::Thrust, Quantity::ThrustStd), unit_n);
    }
    if has(&["mass", "weight", "load"]) && !has(&PARTS) {
        let unit_kg = kilograms_in(words);
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
    } else if coverage.is_certainly {
        // the uncertainties of power, voltage and current are not used
        Meaning::Other
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
    use super::super::coverage::coverage_of;
    use super::*;

    fn meaning(header: &str) -> Meaning {
        meaning_of(&coverage_of(header))
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
            ("thrust_standard_deviation_n", Quantity::ThrustStd, 1.0),
            ("Thrust ± (N)", Quantity::ThrustStd, 1.0),
            ("±[rad/s]", Quantity::SpeedStd, 1.0),
            ("mass_expanded_g", Quantity::MassStd, 1e-3),
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
            let Meaning::Known(found, factor) = meaning(header) else { panic!("{header}") };
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
            "power_error_w",
            "voltage_std_V",
            "thrust_constant_total_n_s2",
            "thrust_constant_total_std_n_s2",
            "propeller mass (g)",
            "Load cell 1 (g)",
            "Motor Efficiency (%)",
            "Propeller Mech. Efficiency (N/W)",
            "90% settling time (s)",
        ] {
            assert_eq!(meaning(header), Meaning::Other, "{header}");
        }
    }

    #[test]
    fn units_that_are_not_known_are_not_guessed() {
        for header in ["thrust", "Thrust (%)", "torque", "Torque (foo)", "lift_stone"] {
            assert_eq!(meaning(header), Meaning::UnknownUnit, "{header}");
        }
    }

    #[test]
    fn what_is_uncertain_and_how_is_not_guessed() {
        for header in [
            "thrust_error_n",
            "thrust_tolerance",
            "mass_error_g",
            "rpm accuracy",
            "thrust_error_percent",
            "Thrust 95% CI (N)",
        ] {
            assert_eq!(meaning(header), Meaning::UnknownKind, "{header}");
        }
        for header in ["±", "std_n", "uncertainty (g)", "u_percent"] {
            assert_eq!(meaning(header), Meaning::StdOfUnknown, "{header}");
        }
        assert_eq!([meaning("thrust_std"), meaning("±thrust")], [Meaning::UnknownStdUnit; 2]);
        assert_eq!(meaning("U"), Meaning::Other);
    }
}
