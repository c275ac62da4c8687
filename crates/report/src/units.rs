//! The constant of one rotor in the units of other programs, ready to be pasted.

use crate::number::{expanded, with_uncertainty};
use hovertone_exchange::ConstantUnits;
use hovertone_thrust::ThrustTable;

/// Digits of a pasted value, more than its uncertainty needs.
const PASTED_DIGITS: usize = 6;

/// A thrust constant in one unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConstantInUnit {
    /// The unit, or the formula of a coefficient.
    pub unit: &'static str,
    /// For people: "(7.073 ± 0.035) · 10⁻⁶".
    pub text: String,
    /// For programs: "7.07290e-6".
    pub pasted: String,
}

/// The constant of one rotor in every common unit, and as coefficients where air and diameter are known; empty without a constant.
pub fn constants_in_units(table: &ThrustTable) -> Vec<ConstantInUnit> {
    let Some(constant) = table.thrust_constant_per_rotor_n_s2 else { return Vec::new() };
    let units = ConstantUnits::from_n_s2(constant.value);
    let share = constant.std_uncertainty.map(|std| std / constant.value);
    let in_unit = |unit: &'static str, value: f64| ConstantInUnit {
        unit,
        text: in_powers(value, share.map(|share| share * value)),
        pasted: format!("{value:.*e}", PASTED_DIGITS - 1),
    };
    let mut all = vec![
        in_unit("N/(rad/s)², N s²", units.n_s2()),
        in_unit("N/rpm²", units.n_rpm2()),
        in_unit("N/(rev/s)²", units.n_rev_s2()),
        in_unit("gram-force/rpm²", units.g_rpm2()),
    ];
    if let Some(both) = table.coefficients {
        all.push(in_unit("C_T = F/(ρ n² D⁴)", both.propeller));
        all.push(in_unit("C_T = F/(ρ A (ωR)²)", both.rotorcraft));
    }
    all
}

/// "(7.073 ± 0.035) · 10⁻⁶"; without a known uncertainty no brackets.
fn in_powers(value: f64, std_uncertainty: Option<f64>) -> String {
    let exponent = value.abs().log10().floor() as i32;
    let unit = 10f64.powi(exponent);
    let digits = with_uncertainty(value / unit, std_uncertainty.map(|std| std / unit));
    match expanded(std_uncertainty) {
        Some(_) => format!("({digits}) · 10{}", superscript(exponent)),
        None => format!("{digits} · 10{}", superscript(exponent)),
    }
}

/// A whole number in raised digits.
pub(crate) fn superscript(number: i32) -> String {
    let raised = |letter: char| match letter {
        '-' => '⁻',
        digit => digit.to_digit(10).and_then(|digit| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(digit as usize)).unwrap_or(digit),
    };
    number.to_string().chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_raised_and_uncertainties_follow() {
        assert_eq!(in_powers(7.0729e-6, Some(0.0175e-6)), "(7.073 ± 0.035) · 10⁻⁶");
        assert_eq!(in_powers(0.109, None), "1.09000 · 10⁻¹");
        assert_eq!(superscript(-10), "⁻¹⁰");
    }
}
