//! Points whose constant is off by a factor: another unit, another octave of the tone, another flight.

use super::point::ForcePoint;
use crate::statistics::median;

/// A point whose constant is this many times the median, or this many times below it, is not an honest load: a wrong unit or a
/// wrong octave changes the constant by at least this factor. *Decision.*
const GROSS_FACTOR: f64 = 2.0;

/// Fewest constants among which one can be called off by a factor: of two, nothing shows which one is wrong. *Decision.*
pub(crate) const CONSTANTS_FOR_GROSS: usize = 3;

/// Whether a constant is off by a factor from the median of all constants.
pub(crate) fn is_off_by_a_factor(constant_n_s2: f64, middle_n_s2: f64) -> bool {
    !(middle_n_s2 / GROSS_FACTOR..=middle_n_s2 * GROSS_FACTOR).contains(&constant_n_s2)
}

/// For each point, whether its own constant is off by a factor from the median.
pub(crate) fn gross_points(points: &[ForcePoint]) -> Vec<bool> {
    let constants: Vec<f64> = points.iter().map(ForcePoint::thrust_constant_n_s2).collect();
    let middle = median(&constants).filter(|_| points.len() >= CONSTANTS_FOR_GROSS && !are_split(&constants));
    let is_gross = |constant: &f64| middle.is_some_and(|middle| is_off_by_a_factor(*constant, middle));
    constants.iter().map(is_gross).collect()
}

/// Whether half of the constants or more are off by a factor from the median. Then nothing shows which half is right.
pub(crate) fn are_split(constants_n_s2: &[f64]) -> bool {
    let Some(middle) = median(constants_n_s2) else { return false };
    let off = constants_n_s2.iter().filter(|constant| is_off_by_a_factor(**constant, middle)).count();
    off > 0 && 2 * off >= constants_n_s2.len()
}
