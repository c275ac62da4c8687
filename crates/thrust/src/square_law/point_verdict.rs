//! Whether each point agrees with the others, and which force would.

use super::ROUNDING_SHARE;
use super::agreement::{DISAGREEMENT_CHANCE, agreement_of, scatter_factor};
use super::point::{ForcePoint, PointNoise, law_through_origin};
use crate::statistics::two_sided_chance;
use serde::Serialize;

/// The same for a point that was observed once, as all others were: it is named if it lies far outside of their scatter. The test assumes
/// that speeds scatter normally, which few flights cannot show. *Decision.*
const OUTLIER_CHANCE: f64 = 0.01;
/// Smallest deviation of a misfit where no uncertainty is stated: a thrust stand of this class is no better (load cells of 0.1 % of their range,
/// used at a fifth of it). Rows nearer than this to the law are good rows, even where the others lie on it by chance or by a formula. *Decision.*
const MISFIT_SHARE_MIN: f64 = 0.005;

/// One point against the others.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PointVerdict {
    /// Name of the load or row.
    pub name: String,
    /// Its force over C ω² − 1, with the constant C of the other points; absent for a single point.
    pub deviation_share: Option<f64>,
    /// Constant from all other points (leave one out).
    pub thrust_constant_of_others_n_s2: Option<f64>,
    /// Probability that a correct point deviates at least this much.
    pub p_value: Option<f64>,
    /// Whether it agrees with the others; absent where there is no p-value.
    pub fits: Option<bool>,
    /// Off by a factor, and left out of the fit.
    pub is_gross: bool,
    /// Force that would agree with the others …
    pub force_that_fits_n: Option<f64>,
    /// … and its standard uncertainty.
    pub force_that_fits_std_n: Option<f64>,
}

/// Judges every point against the kept points. While the kept points disagree with one law, the point with the largest deviation
/// is a misfit and no longer kept. Of two points that disagree both are misfits, since nothing shows which one is wrong.
pub(super) fn verdicts(points: &[ForcePoint], gross: &[bool], noise: PointNoise) -> Vec<PointVerdict> {
    let mut kept: Vec<usize> = (0..points.len()).filter(|&index| !gross[index]).collect();
    let mut misfits: Vec<usize> = Vec::new();
    while kept.len() > 1 && together_disagree(points, &kept, noise) {
        if kept.len() == 2 {
            misfits.append(&mut kept.clone());
            break;
        }
        let worst = kept
            .iter()
            .copied()
            .filter_map(|index| Some((index, against_others(points, index, &kept, noise)?)))
            .filter(|(_, against)| against.is_far(noise))
            .max_by(|a, b| a.1.stds.abs().total_cmp(&b.1.stds.abs()));
        let Some((worst, _)) = worst else { break };
        misfits.push(worst);
        kept.retain(|&index| index != worst);
    }
    if kept.len() > 1 {
        take_back(points, &mut kept, &mut misfits, noise);
    }
    let judged = |index: usize| {
        let is_misfit = gross[index] || misfits.contains(&index);
        let against = against_others(points, index, &kept, noise);
        let fits = match noise {
            // nothing tests the law itself; a single point can still lie far outside of the scatter of the others
            PointNoise::Unrepeated { .. } => is_misfit.then_some(false),
            _ => against.as_ref().filter(|against| against.p_value.is_some()).map(|_| !is_misfit),
        };
        let that_fits = |of: fn(&Against) -> f64| against.as_ref().filter(|_| is_misfit).map(of);
        PointVerdict {
            name: points[index].name.clone(),
            deviation_share: against.as_ref().map(|against| against.deviation_share),
            thrust_constant_of_others_n_s2: against.as_ref().map(|against| against.constant_n_s2),
            p_value: against.as_ref().and_then(|against| against.p_value),
            fits: if gross[index] { Some(false) } else { fits },
            is_gross: gross[index],
            force_that_fits_n: that_fits(|against| against.expected_n),
            force_that_fits_std_n: that_fits(|against| against.expected_std_n),
        }
    };
    (0..points.len()).map(judged).collect()
}

/// Takes those misfits back that agree with the kept points after all, the nearest first: a worse misfit beside them had pulled the constant away.
fn take_back(points: &[ForcePoint], kept: &mut Vec<usize>, misfits: &mut Vec<usize>, noise: PointNoise) {
    let distance = |index: usize, kept: &[usize]| {
        against_others(points, index, kept, noise).map_or(f64::INFINITY, |against| against.stds.abs())
    };
    let mut candidates = misfits.clone();
    candidates.sort_by(|a, b| distance(*a, kept).total_cmp(&distance(*b, kept)));
    for index in candidates {
        kept.push(index);
        if together_disagree(points, kept, noise) {
            kept.pop();
        } else {
            misfits.retain(|&misfit| misfit != index);
        }
    }
}

/// A point against the constant of the others.
struct Against {
    constant_n_s2: f64,
    expected_n: f64,
    expected_std_n: f64,
    deviation_share: f64,
    /// Deviation in standard uncertainties.
    stds: f64,
    p_value: Option<f64>,
}

impl Against {
    /// Whether the point is so far from the law that it may be a misfit. Stated uncertainties say themselves what is far.
    fn is_far(&self, noise: PointNoise) -> bool {
        !noise.is_by_residuals() || self.deviation_share.abs() >= MISFIT_SHARE_MIN
    }
}

fn against_others(points: &[ForcePoint], index: usize, kept: &[usize], noise: PointNoise) -> Option<Against> {
    let own = &points[index];
    let others: Vec<&ForcePoint> = kept.iter().filter(|&&other| other != index).map(|&other| &points[other]).collect();
    let fit = law_through_origin(&others, noise).ok()?;
    // without repeated observations only the residuals of the others show the noise
    let factor = scatter_factor(fit.agreement, noise);
    let (speed_std, force_std_n) = match noise {
        // rows that agree by chance show less noise than the digits of a force have
        PointNoise::FromResiduals => (0.0, factor.unwrap_or(f64::INFINITY).hypot(ROUNDING_SHARE * own.force_n)),
        PointNoise::FromShares => (0.0, factor.unwrap_or(f64::INFINITY).hypot(ROUNDING_SHARE) * own.force_n),
        PointNoise::Unrepeated { .. } => {
            let factor = factor.unwrap_or(f64::INFINITY);
            (factor * own.speed_square_std_rad2_s2, factor * own.force_std_n)
        }
        _ => (own.speed_square_std_rad2_s2, own.force_std_n),
    };
    let expected_n = fit.slope * own.speed_square_rad2_s2;
    let slope_std = fit.slope_std * factor.unwrap_or(f64::INFINITY);
    let expected_std_n = (slope_std * own.speed_square_rad2_s2).hypot(fit.slope * speed_std);
    let stds = stds_of(own.force_n - expected_n, expected_std_n.hypot(force_std_n));
    let p_value = match noise {
        PointNoise::Stated => two_sided_chance(stds, None),
        PointNoise::Measured { degrees_of_freedom } => two_sided_chance(stds, Some(degrees_of_freedom)),
        PointNoise::FromResiduals | PointNoise::FromShares | PointNoise::Unrepeated { .. } => {
            two_sided_chance(stds, Some(fit.agreement.degrees_of_freedom as f64))
        }
    };
    Some(Against {
        constant_n_s2: fit.slope,
        expected_n,
        expected_std_n: if expected_std_n.is_finite() { expected_std_n } else { 0.0 },
        deviation_share: own.force_n / expected_n - 1.0,
        stds,
        p_value,
    })
}

/// A deviation in standard uncertainties; 0 for points that agree to the last digit, whose scatter is 0 as well.
fn stds_of(deviation: f64, std: f64) -> f64 {
    if deviation == 0.0 { 0.0 } else { deviation / std }
}

/// Whether the kept points disagree with one law. Where the residuals alone show the noise, the smallest p-value of the points decides, times
/// their number (Bonferroni 1936).
fn together_disagree(points: &[ForcePoint], kept: &[usize], noise: PointNoise) -> bool {
    let p_value = match noise {
        PointNoise::FromResiduals | PointNoise::FromShares | PointNoise::Unrepeated { .. } => {
            let p_of =
                |&index: &usize| against_others(points, index, kept, noise).filter(|it| it.is_far(noise))?.p_value;
            kept.iter().filter_map(p_of).reduce(f64::min).map(|p_value| p_value * kept.len() as f64)
        }
        _ => {
            let of: Vec<&ForcePoint> = kept.iter().map(|&index| &points[index]).collect();
            law_through_origin(&of, noise)
                .ok()
                .and_then(|fit| agreement_of(fit.agreement, noise))
                .map(|law| law.p_value)
        }
    };
    let chance = if matches!(noise, PointNoise::Unrepeated { .. }) { OUTLIER_CHANCE } else { DISAGREEMENT_CHANCE };
    p_value.is_some_and(|p_value| p_value < chance)
}
