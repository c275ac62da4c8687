//! Numbers for people, with as many digits as their uncertainty allows. Only this file decides about digits, and about what ± means: the
//! expanded uncertainty, k = 2, everywhere.

use hovertone_vehicle::{COVERAGE_FACTOR, Estimate};

/// Digits of a value with unknown uncertainty.
const DIGITS_WITHOUT_UNCERTAINTY: usize = 6;
/// Numbers from this power of ten on are written with it: nobody counts 13 digits.
const WITH_EXPONENT: i32 = 12;
/// Most decimals of any number.
const DECIMALS_MAX: i32 = 9;

/// Power of ten of the first digit of a number once it is rounded to `digits` digits.
fn exponent(value: f64, digits: usize) -> i32 {
    let scientific = format!("{:.*e}", digits.saturating_sub(1), value.abs());
    scientific.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

/// Decimals that show two digits of the uncertainty; `None` where the uncertainty is zero or not finite.
fn decimals(std_uncertainty: Option<f64>) -> Option<usize> {
    let std_uncertainty = std_uncertainty.filter(|u| u.is_finite() && *u > 0.0)?;
    Some((1 - exponent(std_uncertainty, 2)).clamp(0, DECIMALS_MAX) as usize)
}

/// A value with decimals. The minus sign is as wide as a plus sign, and zero has none.
pub fn fixed(value: f64, decimals: usize) -> String {
    let digits = format!("{:.decimals$}", value.abs());
    let is_zero = digits.bytes().all(|digit| matches!(digit, b'0' | b'.'));
    if value < 0.0 && !is_zero { format!("−{digits}") } else { digits }
}

/// The same with a plus sign, for a difference.
pub fn signed(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    let is_zero = text.chars().all(|digit| matches!(digit, '0' | '.'));
    if text.starts_with('−') || is_zero { text } else { format!("+{text}") }
}

/// A value with a given number of digits, for values whose uncertainty is shown elsewhere.
pub fn significant(value: f64, digits: usize) -> String {
    if exponent(value, digits) >= WITH_EXPONENT {
        let sign = if value < 0.0 { "−" } else { "" };
        return format!("{sign}{:.*e}", digits.saturating_sub(1), value.abs());
    }
    let decimals = (digits as i32 - 1 - exponent(value, digits)).clamp(0, DECIMALS_MAX) as usize;
    fixed(value, decimals)
}

/// k times a standard uncertainty.
pub(crate) fn expanded(std_uncertainty: Option<f64>) -> Option<f64> {
    std_uncertainty.map(|std| COVERAGE_FACTOR * std)
}

/// Whether an estimate may be zero: its ± is larger than its value.
pub(crate) fn may_be_zero(estimate: Estimate) -> bool {
    expanded(estimate.std_uncertainty).is_some_and(|expanded| expanded > estimate.value.abs())
}

/// A value, rounded to the second digit of an uncertainty.
pub(crate) fn rounded(value: f64, uncertainty: Option<f64>) -> String {
    match decimals(uncertainty) {
        Some(decimals) => fixed(value, decimals),
        None => significant(value, DIGITS_WITHOUT_UNCERTAINTY),
    }
}

/// A spread or a standard uncertainty with two digits; a dash where it is unknown.
pub(crate) fn spread(std: Option<f64>) -> String {
    match (std, decimals(std)) {
        (Some(std), Some(decimals)) => format!("{std:.decimals$}"),
        _ => DASH.to_owned(),
    }
}

/// The number after a ±: the expanded uncertainty, k = 2, with two digits; a dash where it is unknown.
pub(crate) fn plus_minus(std_uncertainty: Option<f64>) -> String {
    spread(expanded(std_uncertainty))
}

/// "2.8315 ± 0.0035": a value and its expanded uncertainty, k = 2, from its standard uncertainty.
pub fn with_uncertainty(value: f64, std_uncertainty: Option<f64>) -> String {
    let expanded = expanded(std_uncertainty);
    match decimals(expanded) {
        Some(_) => format!("{} ± {}", rounded(value, expanded), spread(expanded)),
        None => rounded(value, None),
    }
}

/// A number with its uncertainty, and the power of ten for both.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScaledNumber {
    /// "2.8315 ± 0.0035".
    pub digits: String,
    /// Exponent of the power of ten; 0 where it is 1.
    pub exponent: i32,
}

impl ScaledNumber {
    /// The exponent with a minus sign as wide as a plus sign.
    pub fn superscript(&self) -> String {
        self.exponent.to_string().replace('-', "−")
    }
}

/// A value and its expanded uncertainty (k = 2, from the standard uncertainty), with one digit before the point.
pub fn scaled_number(value: f64, std_uncertainty: Option<f64>) -> ScaledNumber {
    let unit = PowerOfTen::of([value]);
    let digits = with_uncertainty(unit.scale(value), std_uncertainty.map(|std| unit.scale(std)));
    ScaledNumber { digits, exponent: unit.0 }
}

/// Text in place of a missing number.
pub(crate) const DASH: &str = "–";

/// A power of ten that brings a column to one digit before the point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PowerOfTen(i32);

impl PowerOfTen {
    /// The power for the largest of the values.
    pub(crate) fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let largest = values.into_iter().filter(|value| value.is_finite()).fold(0.0, |a: f64, b| a.max(b.abs()));
        Self(if largest > 0.0 { exponent(largest, 6) } else { 0 })
    }

    /// The power of ten as a factor.
    pub(crate) const fn exact(exponent: i32) -> Self {
        Self(exponent)
    }

    /// The value in this unit. Division by a whole power rounds once, multiplication by 1e-5 rounds twice.
    pub(crate) fn scale(self, value: f64) -> f64 {
        value / 10f64.powi(self.0)
    }

    /// The unit, as "1e-5 N s²".
    pub(crate) fn unit(self, unit: &str) -> String {
        if self.0 == 0 { unit.to_owned() } else { format!("1e{} {unit}", self.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::Ending;

    #[test]
    fn digits_follow_the_uncertainty() {
        for (value, std_uncertainty, expected) in [
            (720.213_45, Some(0.0321), "720.213 ± 0.064"),
            (720.213_45, Some(3.21), "720.2 ± 6.4"),
            (21_606.4, Some(321.0), "21606 ± 642"),
            (720.0, Some(0.0498), "720.00 ± 0.10"),
            (720.213_45, Some(0.0), "720.213"),
            (720.213_45, None, "720.213"),
            (2.831_534, None, "2.83153"),
        ] {
            assert_eq!(with_uncertainty(value, std_uncertainty), expected);
        }
        assert_eq!((significant(0.078, 4), significant(0.109_57, 4)), ("0.07800".to_owned(), "0.1096".to_owned()));
        assert_eq!((significant(-1.26e15, 2), significant(9.96e11, 2)), ("−1.3e15".to_owned(), "1.0e12".to_owned()));
        assert_eq!((spread(None), spread(Some(0.0996))), (DASH.to_owned(), "0.10".to_owned()));
        assert_eq!(plus_minus(Some(0.0498)), "0.10");
    }

    #[test]
    fn an_estimate_may_be_zero_where_its_plus_minus_reaches_zero() {
        let estimate = |value, std_uncertainty| Estimate { value, std_uncertainty, ending: Ending::Solved };
        assert!(may_be_zero(estimate(-0.19, Some(0.1))) && !may_be_zero(estimate(0.21, Some(0.1))));
        assert!(!may_be_zero(estimate(0.0, None)));
    }

    #[test]
    fn zero_has_no_minus_and_there_is_one_minus_sign() {
        assert_eq!((fixed(-0.001, 2), fixed(-1.5, 1), fixed(-0.0, 0)), ("0.00".into(), "−1.5".into(), "0".into()));
        assert_eq!(
            (signed(-0.001, 2), signed(-0.5, 2), signed(0.25, 2)),
            ("0.00".into(), "−0.50".into(), "+0.25".into())
        );
        assert_eq!(significant(-0.25, 3), "−0.250");
    }

    #[test]
    fn a_column_gets_the_unit_of_its_largest_value() {
        let unit = PowerOfTen::of([2.8315e-5, 9.9e-6]);
        assert_eq!(unit.unit("N s²"), "1e-5 N s²");
        assert!((unit.scale(2.8315e-5) - 2.8315).abs() < 1e-12);
        assert_eq!(PowerOfTen::of([]).unit("N s²"), "N s²");
        assert_eq!(PowerOfTen::of([7.0]).unit("N s²"), "N s²");
    }
}
