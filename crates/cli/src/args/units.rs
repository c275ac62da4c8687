//! Lengths and masses as people type them: a number with its unit, or a plain number in metres or kilograms.

/// Units of a length, longest names first.
const LENGTHS_M: [Unit; 6] = [
    Unit { name: "inches", si: 0.0254 },
    Unit { name: "inch", si: 0.0254 },
    Unit { name: "in", si: 0.0254 },
    Unit { name: "mm", si: 1e-3 },
    Unit { name: "cm", si: 1e-2 },
    Unit { name: "m", si: 1.0 },
];
/// Units of a mass, longest names first.
const MASSES_KG: [Unit; 6] = [
    Unit { name: "kilograms", si: 1.0 },
    Unit { name: "kilogram", si: 1.0 },
    Unit { name: "grams", si: 1e-3 },
    Unit { name: "gram", si: 1e-3 },
    Unit { name: "kg", si: 1.0 },
    Unit { name: "g", si: 1e-3 },
];
struct Unit {
    name: &'static str,
    /// SI units in it.
    si: f64,
}

/// A number as typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Typed {
    /// Its value in SI units.
    pub(crate) si: f64,
    /// Whether a unit stands behind it.
    pub(crate) has_unit: bool,
}

/// A length in metres: `0.2`, `200mm`, `8in`.
pub(crate) fn length_m(text: &str) -> Result<f64, String> {
    let text = text.replace('"', "in").to_lowercase();
    let typed = with_unit(&text, &LENGTHS_M).map(|typed| typed.si);
    typed.ok_or_else(|| "a length is needed, such as 200mm or 8in, or 0.2 in metres".to_owned())
}

/// A mass in kilograms: `0.413`, `413g`.
pub(crate) fn mass_kg(text: &str) -> Result<f64, String> {
    typed_mass_kg(text)
        .map(|typed| typed.si)
        .ok_or_else(|| "a mass is needed, such as 413g, or 0.413 in kilograms".to_owned())
}

/// A mass with its unit, or without one in kilograms.
pub(crate) fn typed_mass_kg(text: &str) -> Option<Typed> {
    with_unit(text, &MASSES_KG)
}

fn with_unit(text: &str, units: &[Unit]) -> Option<Typed> {
    let text = text.trim();
    let suffixed = units.iter().find_map(|unit| {
        let number = text.strip_suffix(unit.name)?.trim().parse::<f64>().ok()?;
        Some(Typed { si: rounded(number * unit.si), has_unit: true })
    });
    suffixed.or_else(|| Some(Typed { si: text.parse().ok()?, has_unit: false }))
}

/// Without the last digits of binary arithmetic.
pub(crate) fn rounded(value: f64) -> f64 {
    const DECIMALS: f64 = 1e9;
    (value * DECIMALS).round() / DECIMALS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_units_or_are_si() {
        for (text, expected_m) in [
            ("8in", 0.2032),
            ("8 inches", 0.2032),
            ("8\"", 0.2032),
            ("200mm", 0.2),
            ("20 cm", 0.2),
            ("0.2m", 0.2),
            ("0.2", 0.2),
        ] {
            assert_eq!(length_m(text), Ok(expected_m), "{text}");
        }
        assert_eq!((mass_kg("413 grams"), mass_kg("2 kilograms")), (Ok(0.413), Ok(2.0)));
        assert_eq!((mass_kg("413g"), mass_kg("0.413 kg"), mass_kg("0.413")), (Ok(0.413), Ok(0.413), Ok(0.413)));
        assert!(
            length_m("8ft").is_err() && length_m("in").is_err() && mass_kg("413lb").is_err() && mass_kg("").is_err()
        );
    }
}
