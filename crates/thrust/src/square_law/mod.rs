//! Known forces and squared speeds → the square law F = C ω², how well it holds, and the laws beside it.
//!
//! ```text
//! point          a force and a squared speed with their uncertainties    outliers       points that are off by a factor
//! agreement      chi-square, p-value and scatter of a fit                laws           intercept, power law, probabilities
//! point_verdict  each point against all others                           load_range     how far apart the loads are
//! ```

mod agreement;
mod laws;
mod load_range;
mod outliers;
mod point;
mod point_verdict;

pub use agreement::LawAgreement;
pub(crate) use agreement::covering_factor;
pub use laws::{ForceLaw, InterceptLaw, LawProbability, PowerLaw};
pub use load_range::LoadRange;
pub(crate) use load_range::force_ratio_for_intercept;
pub(crate) use outliers::{CONSTANTS_FOR_GROSS, are_split, gross_points, is_off_by_a_factor};
pub use point::{ForcePoint, PointNoise};
pub use point_verdict::PointVerdict;

use crate::regression::{FitError, ProportionalFit};
use crate::statistics::student_factor;
use agreement::agreement_of;
use hovertone_vehicle::{Ending, Estimate};
use laws::{intercept_law, law_probabilities, power_law, preferred};
use load_range::load_range;
use point::{law_through_origin, scatter_of};
use point_verdict::verdicts;
use serde::Serialize;

/// The square law through points, with its agreement, the other laws, and a verdict on each point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SquareLawFit {
    /// C of F = C ω². Where the points scatter more than their uncertainties allow, the standard uncertainty comes from the scatter.
    pub thrust_constant_n_s2: Estimate,
    /// How well the law holds; absent with a single point, and where no uncertainties are stated.
    pub agreement: Option<LawAgreement>,
    /// Root mean square of the residuals over the largest force.
    pub residual_rms_share: f64,
    /// Largest residual over the largest force.
    pub residual_max_share: f64,
    /// Standard uncertainty of C from the uncertainties of the points, without their scatter. A budget starts from it.
    pub(crate) own_std_n_s2: f64,
    /// Where the uncertainties of the points come from.
    #[serde(skip)]
    pub(crate) noise: PointNoise,
    /// Weight of each point: C is the mean of the constants of the points with these weights. 0 for points that are left out.
    pub(crate) shares: Vec<f64>,
    /// The law with an intercept; absent where the points do not tell it: all speeds are equal or nearly so, or, without uncertainties, there
    /// are two points or equal forces.
    pub with_intercept: Option<InterceptLaw>,
    /// The force as a power of the speed; absent in the same cases.
    pub power_law: Option<PowerLaw>,
    /// Probabilities of the laws.
    pub laws: Vec<LawProbability>,
    /// The preferred law: the square law unless another one is ten times as probable.
    pub preferred: ForceLaw,
    /// Each point: whether it agrees with the others, and which force would.
    pub points: Vec<PointVerdict>,
    /// How far the loads are apart, and whether an intercept can be seen at that distance.
    pub range: Option<LoadRange>,
}

/// Residuals below this share of a force are those of rounding: a thrust is measured to five digits at best. *Decision.*
const ROUNDING_SHARE: f64 = 5e-5;
/// Fewest points whose scatter tells an uncertainty: of two, chance makes it ten times too small in 8 % of
/// tables. *Decision.*
const SCATTER_POINTS_MIN: usize = 3;

/// A factor of a standard uncertainty above this is worth a word. *Decision.*
const WIDENED: f64 = 1.1;

/// Reason why the scatter of points tells no uncertainty of their constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoScatter {
    /// Too few points are left.
    #[error("the ± comes from the scatter of the rows: at least {SCATTER_POINTS_MIN} usable rows are needed")]
    TooFewPoints {
        /// Number of points that are not left out.
        count: usize,
    },
    /// All points lie on the law but for rounding.
    #[error("{} lie exactly on F = C ω², so they seem to be computed; the ± needs the scatter of measured rows", rows_but(*left_out))]
    Computed {
        /// Number of points that are left out, because they do not fit.
        left_out: usize,
    },
}

impl SquareLawFit {
    /// The reason why the ± of the constant is not known: no uncertainties are stated, and the points are too few, or were computed. `None`
    /// where it is known. `points` are those of the fit.
    pub fn why_no_uncertainty(&self, points: &[ForcePoint]) -> Option<NoScatter> {
        if points.iter().all(ForcePoint::has_std) {
            return None;
        }
        let count = self.shares.iter().filter(|share| **share > 0.0).count();
        if count < SCATTER_POINTS_MIN {
            return Some(NoScatter::TooFewPoints { count });
        }
        let left_out = self.shares.len() - count;
        (self.residual_max_share < ROUNDING_SHARE).then_some(NoScatter::Computed { left_out })
    }

    /// By which factor the standard uncertainty of the constant is larger than the stated uncertainties of the points alone make it, because the
    /// points scatter more. `None` where it is not, and where no uncertainties are stated.
    pub fn widening(&self) -> Option<f64> {
        self.agreement?;
        let factor = self.thrust_constant_n_s2.std_uncertainty? / self.own_std_n_s2;
        (factor.is_finite() && factor > WIDENED).then_some(factor)
    }
}

fn rows_but(left_out: usize) -> String {
    match left_out {
        0 => "the rows".to_owned(),
        1 => "all rows but one that does not fit".to_owned(),
        count => format!("all rows but {count} that do not fit"),
    }
}

/// Fits the square law F = C ω² with uncertainty in both coordinates (York et al. 2004). Points that are off by a factor (wrong
/// unit, wrong octave) are left out, and their verdict says so.
///
/// # Errors
/// No point; a force or a speed that is zero, negative or not a number, with the number of its point.
pub fn square_law_fit(points: &[ForcePoint], noise: PointNoise) -> Result<SquareLawFit, FitError> {
    if let Some(index) = points.iter().position(|point| !point.is_usable()) {
        return Err(FitError::UnusablePoint { number: index + 1 });
    }
    let gross = gross_points(points);
    let kept: Vec<&ForcePoint> =
        points.iter().zip(&gross).filter(|(_, gross)| !**gross).map(|(point, _)| point).collect();
    let is_stated = noise != PointNoise::FromResiduals && points.iter().all(ForcePoint::has_std);
    let noise = if is_stated { noise } else { scatter_of(&kept) };
    let fit = law_through_origin(&kept, noise)?;
    let all_points = verdicts(points, &gross, noise);
    // two points without uncertainties leave nothing to tell the ± of a law with two parameters
    let has_freedom = !noise.is_by_residuals() || kept.len() > 2;
    // equal forces lie on a law without a slope, and again nothing tells its ±
    let has_freedom = has_freedom && (!noise.is_by_residuals() || are_different(&kept));
    let (with_intercept, line) = intercept_law(&kept, noise).filter(|_| has_freedom).unzip();
    // the evidence knows Student's distribution; a ± needs its factor
    let few = if noise.is_by_residuals() { student_factor(kept.len() as f64 - 2.0) } else { 1.0 };
    // points that tell less of a law than is known before the measurement tell nothing: loads that are nearly equal
    let with_intercept = with_intercept.filter(|law| law.widened(few).is_told_by(&kept));
    let power_law = power_law(&kept, noise).filter(|law| has_freedom && law.widened(few).is_told());
    let laws = law_probabilities(&kept, with_intercept.as_ref(), power_law.as_ref(), noise);
    let largest_n = kept.iter().map(|point| point.force_n).fold(0.0, f64::max);
    let residuals = || kept.iter().map(|p| (p.force_n - fit.slope * p.speed_square_rad2_s2).abs());
    let squares: f64 = residuals().map(|residual| residual.powi(2)).sum();
    let agreement = agreement_of(fit.agreement, noise);
    let ending = if kept.len() > 1 { Ending::Solved } else { Ending::SingleObservation };
    Ok(SquareLawFit {
        thrust_constant_n_s2: Estimate { value: fit.slope, std_uncertainty: scattered_std(fit, noise), ending },
        agreement,
        residual_rms_share: (squares / kept.len() as f64).sqrt() / largest_n,
        residual_max_share: residuals().fold(0.0, f64::max) / largest_n,
        own_std_n_s2: fit.slope_std,
        noise,
        shares: shares(points, &gross, &fit, noise),
        preferred: preferred(&laws),
        range: line.and_then(|line| load_range(&kept, &line, noise)),
        with_intercept: with_intercept.map(|law| law.widened(few)),
        power_law: power_law.map(|law| law.widened(few)),
        laws,
        points: all_points,
    })
}

/// Whether forces differ by more than rounding.
fn are_different(points: &[&ForcePoint]) -> bool {
    let forces = || points.iter().map(|point| point.force_n);
    let (least_n, most_n) = (forces().fold(f64::INFINITY, f64::min), forces().fold(0.0, f64::max));
    most_n > least_n * (1.0 + ROUNDING_SHARE)
}

/// Standard uncertainty of the slope, enlarged by the scatter of the points where that exceeds their stated uncertainties.
fn scattered_std(fit: ProportionalFit, noise: PointNoise) -> Option<f64> {
    let factor = match noise {
        // the scatter is in the uncertainties of the points already
        PointNoise::Unrepeated { degrees_of_freedom } => Some(student_factor(degrees_of_freedom)),
        _ => covering_factor(fit.agreement, noise),
    };
    Some(fit.slope_std * factor?)
}

/// Weights with which the constants of the points make the constant of the fit: x²/(u_y² + C² u_x²), divided by their sum.
fn shares(points: &[ForcePoint], gross: &[bool], fit: &ProportionalFit, noise: PointNoise) -> Vec<f64> {
    let weight = |point: &ForcePoint, is_gross: bool| {
        let variance = match noise {
            PointNoise::FromResiduals => 1.0,
            PointNoise::FromShares => point.force_n.powi(2),
            _ => point.force_std_n.powi(2) + (fit.slope * point.speed_square_std_rad2_s2).powi(2),
        };
        if is_gross { 0.0 } else { point.speed_square_rad2_s2.powi(2) / variance }
    };
    let weights: Vec<f64> = points.iter().zip(gross).map(|(point, &is_gross)| weight(point, is_gross)).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| weight / sum).collect()
}
