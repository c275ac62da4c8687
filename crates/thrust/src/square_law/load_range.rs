//! How far apart the loads must be to distinguish the square law from one with an intercept.

use super::agreement::scatter_factor;
use super::point::{ForcePoint, PointNoise};
use crate::regression::{FitPoint, LineFit, line_fit};
use serde::Serialize;

/// An intercept is visible where its standard uncertainty is below this share of the mean force. Airframe, hull and cable cause
/// intercepts of that size. *Decision.*
const INTERCEPT_STD_SHARE_MAX: f64 = 0.02;

/// Largest ratio of forces that is recommended. No multirotor hovers over a wider range of loads. *Decision.*
const RATIO_MAX: f64 = 10.0;

/// Step of the search for the ratio. A hundredth is finer than a load can be chosen. *Numeric.*
const RATIO_STEP: f64 = 0.01;

/// The range of the loads.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LoadRange {
    /// Largest over smallest force.
    pub force_ratio: f64,
    /// Standard uncertainty of an intercept over the mean force.
    pub intercept_std_share: f64,
    /// Whether that is small enough to see an intercept.
    pub shows_intercept: bool,
    /// Ratio of forces that would be enough for the same number of loads with the same uncertainties; absent where no ratio is.
    pub force_ratio_needed: Option<f64>,
}

/// The range of the loads, from the line with an intercept through them. `None` where the scatter of the points is unknown.
pub(super) fn load_range(points: &[&ForcePoint], line: &LineFit, noise: PointNoise) -> Option<LoadRange> {
    let factor = scatter_factor(line.agreement, noise)?;
    let forces = || points.iter().map(|point| point.force_n);
    let (least, most) = (forces().fold(f64::INFINITY, f64::min), forces().fold(0.0, f64::max));
    let mean = forces().sum::<f64>() / points.len() as f64;
    let intercept_std_share = factor * line.intercept_std / mean;
    let force_ratio = most / least;
    // the uncertainty of evenly spaced loads of the same range with this intercept: it is assumed to be the same at any range
    let std_share = intercept_std_share / self::intercept_std_share(1.0, points.len(), force_ratio);
    let shows_intercept = intercept_std_share <= INTERCEPT_STD_SHARE_MAX;
    let needed = force_ratio_for_intercept(std_share, points.len());
    // loads that show it are far enough apart, also between two steps of the search
    let enough = needed.map_or(force_ratio, |needed| needed.min(force_ratio));
    let force_ratio_needed = if shows_intercept { Some(enough) } else { needed };
    Some(LoadRange { force_ratio, intercept_std_share, shows_intercept, force_ratio_needed })
}

/// Smallest ratio of the largest to the smallest force that shows an intercept, for `load_count` evenly spaced loads, each with
/// the relative standard uncertainty `std_share`. `None` where no ratio up to [`RATIO_MAX`] does.
pub(crate) fn force_ratio_for_intercept(std_share: f64, load_count: usize) -> Option<f64> {
    let shows = |ratio: f64| intercept_std_share(std_share, load_count, ratio) <= INTERCEPT_STD_SHARE_MAX;
    let steps = ((RATIO_MAX - 1.0) / RATIO_STEP) as usize;
    (1..=steps).map(|step| 1.0 + step as f64 * RATIO_STEP).find(|&ratio| shows(ratio))
}

/// Standard uncertainty of the intercept over the mean force, for evenly spaced loads from 1 to `ratio`, each with the relative
/// standard uncertainty `std_share`.
fn intercept_std_share(std_share: f64, load_count: usize, ratio: f64) -> f64 {
    let step = (ratio - 1.0) / (load_count.max(2) - 1) as f64;
    let loads: Vec<FitPoint> = (0..load_count.max(2))
        .map(|index| 1.0 + index as f64 * step)
        .map(|force| FitPoint::with_y_std(force, force, std_share * force))
        .collect();
    line_fit(&loads).map_or(f64::INFINITY, |line| 2.0 * line.intercept_std / (1.0 + ratio))
}
