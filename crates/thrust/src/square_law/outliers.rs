//! Points whose constant is off by a factor: another unit, another octave of the tone, another flight.

use super::point::ForcePoint;
use crate::regression::{FitPoint, line_fit};
use crate::statistics::median;

/// A point whose constant is this many times the median, or this many times below it, is not an honest load: a wrong unit or a
/// wrong octave changes the constant by at least this factor. *Decision.*
const GROSS_FACTOR: f64 = 2.0;

/// Fewest constants among which one can be called off by a factor: of two, nothing shows which one is wrong. *Decision.*
pub(crate) const CONSTANTS_FOR_GROSS: usize = 3;

/// A force this near to the straight line through the others, as a share, lies on it. *Decision.*
const LINE_SHARE: f64 = 0.1;

/// Whether a constant is off by a factor from the median of all constants.
pub(crate) fn is_off_by_a_factor(constant_n_s2: f64, middle_n_s2: f64) -> bool {
    !(middle_n_s2 / GROSS_FACTOR..=middle_n_s2 * GROSS_FACTOR).contains(&constant_n_s2)
}

/// For each point, whether its own constant is off by a factor from the median, and its force from the straight line through the others: where the
/// scale has an offset, the constants of the least forces are off too.
pub(crate) fn gross_points(points: &[ForcePoint]) -> Vec<bool> {
    let constants: Vec<f64> = points.iter().map(ForcePoint::thrust_constant_n_s2).collect();
    let middle = median(&constants).filter(|_| points.len() >= CONSTANTS_FOR_GROSS && !are_split(&constants));
    let is_off = |constant: &f64| middle.is_some_and(|middle| is_off_by_a_factor(*constant, middle));
    let off: Vec<bool> = constants.iter().map(is_off).collect();
    let others: Vec<&ForcePoint> = points.iter().zip(&off).filter(|(_, off)| !**off).map(|(point, _)| point).collect();
    points.iter().zip(off).map(|(point, off)| off && !is_on_line(point, &others)).collect()
}

/// Whether a force lies on the straight line F = F₀ + C ω² through other points. The line is followed beyond these by their range at most.
fn is_on_line(point: &ForcePoint, others: &[&ForcePoint]) -> bool {
    let speeds = || others.iter().map(|other| other.speed_square_rad2_s2);
    let (least, most) = (speeds().fold(f64::INFINITY, f64::min), speeds().fold(f64::NEG_INFINITY, f64::max));
    let reach = least - (most - least)..=most + (most - least);
    if others.len() < CONSTANTS_FOR_GROSS || !reach.contains(&point.speed_square_rad2_s2) {
        return false;
    }
    let alike = |other: &&ForcePoint| FitPoint::with_y_std(other.speed_square_rad2_s2, other.force_n, 1.0);
    let line = line_fit(&others.iter().map(alike).collect::<Vec<_>>());
    line.is_ok_and(|line| {
        let expected_n = line.intercept + line.slope * point.speed_square_rad2_s2;
        (point.force_n - expected_n).abs() <= LINE_SHARE * point.force_n
    })
}

/// Whether half of the constants or more are off by a factor from the median. Then nothing shows which half is right.
pub(crate) fn are_split(constants_n_s2: &[f64]) -> bool {
    let Some(middle) = median(constants_n_s2) else { return false };
    let off = constants_n_s2.iter().filter(|constant| is_off_by_a_factor(**constant, middle)).count();
    off > 0 && 2 * off >= constants_n_s2.len()
}
