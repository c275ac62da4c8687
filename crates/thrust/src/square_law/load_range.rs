//! How far apart loads must lie to tell the square law from one with an intercept.

use crate::regression::{FitPoint, LineFit, line_fit};
use crate::square_law::{ForcePoint, PointNoise, scatter_factor};
use serde::Serialize;

/// An intercept is looked for usefully where its uncertainty is below this share of the mean force: the size of what airframe,
/// hull and cable do.
const INTERCEPT_STD_SHARE_MAX: f64 = 0.02;
/// Widest range that is recommended: no multirotor hovers over more.
const RATIO_MAX: f64 = 10.0;
/// Step of the search for the range, a hundredth of what anybody can load.
const RATIO_STEP: f64 = 0.01;

/// The range of the loads.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LoadRange {
    /// Largest over smallest force.
    pub force_ratio: f64,
    /// Uncertainty of an intercept over the mean force.
    pub intercept_std_share: f64,
    /// Whether that is small enough to see what an intercept may be.
    pub shows_intercept: bool,
    /// Ratio of forces that would do, with as many loads as exact as these; absent where none would.
    pub force_ratio_needed: Option<f64>,
}

pub(crate) fn load_range(points: &[&ForcePoint], line: &LineFit, noise: PointNoise) -> Option<LoadRange> {
    let factor = scatter_factor(line.agreement, noise)?;
    let forces = || points.iter().map(|point| point.force_n);
    let (least, most) = (forces().fold(f64::INFINITY, f64::min), forces().fold(0.0, f64::max));
    let mean = forces().sum::<f64>() / points.len() as f64;
    let intercept_std_share = factor * line.intercept_std / mean;
    // what each load leaves open, in its own force: the same at any range
    let squares: f64 = points
        .iter()
        .map(|point| match noise {
            PointNoise::FromResiduals => (factor / point.force_n).powi(2),
            _ => {
                (point.force_std_n / point.force_n).powi(2)
                    + (point.speed_square_std_rad2_s2 / point.speed_square_rad2_s2).powi(2)
            }
        })
        .sum();
    Some(LoadRange {
        force_ratio: most / least,
        intercept_std_share,
        shows_intercept: intercept_std_share <= INTERCEPT_STD_SHARE_MAX,
        force_ratio_needed: force_ratio_for_intercept((squares / points.len() as f64).sqrt(), points.len()),
    })
}

/// Ratio of the largest to the smallest of so many evenly spaced loads, each known to `std_share`, that shows an intercept.
pub(crate) fn force_ratio_for_intercept(std_share: f64, load_count: usize) -> Option<f64> {
    let shows = |ratio: f64| intercept_std_share(std_share, load_count, ratio) <= INTERCEPT_STD_SHARE_MAX;
    let steps = ((RATIO_MAX - 1.0) / RATIO_STEP) as usize;
    (1..=steps).map(|step| 1.0 + step as f64 * RATIO_STEP).find(|&ratio| shows(ratio))
}

/// Uncertainty of the intercept over the mean force, for evenly spaced loads from 1 to `ratio`, each known to `std_share`.
pub(crate) fn intercept_std_share(std_share: f64, load_count: usize, ratio: f64) -> f64 {
    let step = (ratio - 1.0) / (load_count.max(2) - 1) as f64;
    let loads: Vec<FitPoint> = (0..load_count.max(2))
        .map(|index| 1.0 + index as f64 * step)
        .map(|force| FitPoint::with_y_std(force, force, std_share * force))
        .collect();
    line_fit(&loads).map_or(f64::INFINITY, |line| 2.0 * line.intercept_std / (1.0 + ratio))
}
