//! Headers → quantities and units.

use crate::units::GRAVITY_STANDARD_M_S2;
use csv::StringRecord;
use std::f64::consts::TAU;

/// A pound.
const POUND_KG: f64 = 0.453_592_37;

/// What a column holds.
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
    /// Whether it holds words, which make groups.
    pub(super) is_words: bool,
    /// SI units in one unit of the column.
    si_per_unit: f64,
}

impl Column {
    /// The number in a row, in SI.
    pub(super) fn number(&self, record: &StringRecord) -> Option<f64> {
        let number: f64 = record.get(self.index)?.parse().ok()?;
        Some(number * self.si_per_unit)
    }
}

pub(super) fn columns_of(headers: &StringRecord, records: &[StringRecord]) -> Vec<Column> {
    let column = |(index, header): (usize, &str)| {
        let known = quantity_of(header);
        let cells = || records.iter().filter_map(|record| record.get(index));
        let is_word = |cell: &str| !cell.is_empty() && cell.parse::<f64>().is_err();
        Column {
            index,
            header: header.to_owned(),
            quantity: known.map(|(quantity, _)| quantity),
            is_words: known.is_none() && !records.is_empty() && cells().all(is_word),
            si_per_unit: known.map_or(1.0, |(_, si_per_unit)| si_per_unit),
        }
    };
    headers.iter().enumerate().map(column).collect()
}

/// What a header means, and how many SI units one of its units is.
fn quantity_of(header: &str) -> Option<(Quantity, f64)> {
    let lower = header.to_lowercase().replace(['²', '^'], "2");
    let words: Vec<&str> = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let has = |any: &[&str]| words.iter().any(|word| any.contains(word));
    let is_std = has(&["std", "uncertainty", "sd", "u"]);
    let either = |plain, std| if is_std { std } else { plain };
    // efficiencies and rates of change have the words of what they are made of
    if has(&["efficiency", "acceleration", "settling", "time", "kv", "prop", "motor"])
        && !has(&["speed", "power", "rpm"])
    {
        return None;
    }
    if has(&["efficiency", "acceleration"]) {
        return None;
    }
    let force = |kilogram_is_force: f64| {
        if has(&["n"]) {
            Some(1.0)
        } else if has(&["gf", "g", "gram", "grams", "gramm"]) {
            Some(1e-3 * kilogram_is_force)
        } else if has(&["kgf", "kg", "kp"]) {
            Some(kilogram_is_force)
        } else if has(&["lbf", "lb", "lbs"]) {
            Some(POUND_KG * kilogram_is_force)
        } else {
            None
        }
    };
    if has(&["thrust", "lift", "force"]) {
        return Some((either(Quantity::Thrust, Quantity::ThrustStd), force(GRAVITY_STANDARD_M_S2)?));
    }
    if has(&["mass", "weight", "load"]) && !has(&["n"]) {
        return Some((either(Quantity::Mass, Quantity::MassStd), force(1.0)?));
    }
    if has(&["rpm"]) {
        return Some((either(Quantity::Speed, Quantity::SpeedStd), TAU / 60.0));
    }
    if has(&["rad"]) && has(&["s"]) && has(&["speed", "omega", "ω"]) || has(&["omega", "ω"]) {
        return Some((either(Quantity::Speed, Quantity::SpeedStd), 1.0));
    }
    if has(&["rev", "rps", "hz"]) && has(&["speed", "shaft", "rps", "rev"]) {
        return Some((either(Quantity::Speed, Quantity::SpeedStd), TAU));
    }
    if has(&["torque"]) {
        return Some((Quantity::Torque, 1.0));
    }
    if has(&["power"]) {
        return Some((
            if has(&["mechanical", "shaft"]) { Quantity::ShaftPower } else { Quantity::ElectricalPower },
            1.0,
        ));
    }
    if has(&["voltage", "volt", "volts"]) {
        return Some((Quantity::Voltage, 1.0));
    }
    has(&["current", "amps", "ampere", "amperes"]).then_some((Quantity::Current, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_as_people_write_them() {
        for (header, quantity, si_per_unit) in [
            ("Motor Electrical Speed (RPM)", Quantity::Speed, TAU / 60.0),
            ("rpm", Quantity::Speed, TAU / 60.0),
            ("avg_rpm", Quantity::Speed, TAU / 60.0),
            ("speed_rad_s", Quantity::Speed, 1.0),
            ("omega [rad/s]", Quantity::Speed, 1.0),
            ("speed_rev_s", Quantity::Speed, TAU),
            ("speed_std_rpm", Quantity::SpeedStd, TAU / 60.0),
            ("Thrust (gf)", Quantity::Thrust, 9.80665e-3),
            ("Thrust (N)", Quantity::Thrust, 1.0),
            ("thrust_g_4rotors", Quantity::Thrust, 9.80665e-3),
            ("thrust_std_n", Quantity::ThrustStd, 1.0),
            ("mass_g", Quantity::Mass, 1e-3),
            ("mass_std_g", Quantity::MassStd, 1e-3),
            ("Torque (N·m)", Quantity::Torque, 1.0),
            ("Mechanical Power (W)", Quantity::ShaftPower, 1.0),
            ("Electrical Power (W)", Quantity::ElectricalPower, 1.0),
            ("voltage_V", Quantity::Voltage, 1.0),
            ("current_A", Quantity::Current, 1.0),
        ] {
            let (found, factor) = quantity_of(header).unwrap_or_else(|| panic!("{header}"));
            assert_eq!(found, quantity, "{header}");
            assert!((factor - si_per_unit).abs() < 1e-12, "{header}: {factor}");
        }
        for header in [
            "Time (s)",
            "motor",
            "prop",
            "Overall Efficiency (gf/W)",
            "Max acceleration (RPM/s)",
            "AccX (g)",
            "ESC signal (µs)",
        ] {
            assert_eq!(quantity_of(header), None, "{header}");
        }
    }
}
