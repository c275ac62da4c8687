//! Known forces and squared speeds → the square law F = C ω², how well it holds, and the laws beside it.

pub(crate) mod load_range;
pub(crate) mod point_verdict;

pub use load_range::LoadRange;
pub use point_verdict::PointVerdict;

use crate::regression::{
    Agreement, FitError, FitPoint, LineFit, ParameterPrior, ProportionalFit, line_fit, log_evidence_ratio,
    proportional_fit,
};
use hovertone_vehicle::{Ending, Estimate, RotorSpeed};
use load_range::load_range;
use point_verdict::{gross_points, verdicts};
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Points disagree with a law where right ones would do so with this chance: the usual level of such tests.
pub(crate) const DISAGREEMENT_CHANCE: f64 = 0.05;
/// Standard deviation of what an intercept may be before anybody has measured, as a share of the mean force: hulls and cables
/// that carry, scales that were not zeroed.
const INTERCEPT_PRIOR_SHARE: f64 = 0.1;
/// Standard deviation of what the exponent may be off 2 by: thrust stands give 2.0 to 2.2.
const EXPONENT_PRIOR_STD: f64 = 0.2;
/// Odds from which a law is said to be preferred to the square law ("strong" on Jeffreys' scale).
const PREFERRED_ODDS: f64 = 10.0;

/// A known force, and the squared speed at which the rotors balance it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ForcePoint {
    /// Name of the load, or of the row of a table.
    pub name: String,
    /// Mean squared speed of a rotor.
    pub speed_square_rad2_s2: f64,
    /// Its standard uncertainty.
    pub speed_square_std_rad2_s2: f64,
    /// Force.
    pub force_n: f64,
    /// Its standard uncertainty.
    pub force_std_n: f64,
}

impl ForcePoint {
    /// A shaft speed and a force, each with its standard uncertainty; 0 where nobody states it.
    pub fn from_speed(name: String, speed: RotorSpeed, speed_std_rad_s: f64, force_n: f64, force_std_n: f64) -> Self {
        let rad_s = speed.rad_s();
        Self {
            name,
            speed_square_rad2_s2: rad_s.powi(2),
            speed_square_std_rad2_s2: 2.0 * rad_s * speed_std_rad_s,
            force_n,
            force_std_n,
        }
    }

    /// The same of a mass that hovers.
    pub fn from_mass(
        name: String,
        speed: RotorSpeed,
        speed_std_rad_s: f64,
        mass_kg: f64,
        mass_std_kg: f64,
        gravity_m_s2: f64,
    ) -> Self {
        Self::from_speed(name, speed, speed_std_rad_s, mass_kg * gravity_m_s2, mass_std_kg * gravity_m_s2)
    }

    /// Constant that follows from this point alone.
    pub fn thrust_constant_n_s2(&self) -> f64 {
        self.force_n / self.speed_square_rad2_s2
    }

    fn fit_point(&self) -> FitPoint {
        FitPoint {
            x: self.speed_square_rad2_s2,
            x_std: self.speed_square_std_rad2_s2,
            y: self.force_n,
            y_std: self.force_std_n,
        }
    }

    fn logarithms(&self) -> FitPoint {
        FitPoint {
            x: self.speed_square_rad2_s2.ln(),
            x_std: self.speed_square_std_rad2_s2 / self.speed_square_rad2_s2,
            y: self.force_n.ln(),
            y_std: self.force_std_n / self.force_n,
        }
    }
}

/// Where the uncertainties of the points come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointNoise {
    /// They are stated.
    Stated,
    /// They were measured from scatter, with so many degrees of freedom.
    Measured {
        /// Effective degrees of freedom.
        degrees_of_freedom: f64,
    },
    /// Nobody states any: forces count as equally uncertain, by what the residuals show.
    FromResiduals,
}

/// The laws that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ForceLaw {
    /// F = C ω².
    Square,
    /// F = F₀ + C ω².
    SquareWithIntercept,
    /// F = F_ref (ω/ω_ref)^p.
    Power,
}

impl ForceLaw {
    /// As people write it.
    pub fn formula(self) -> &'static str {
        match self {
            Self::Square => "F = C ω²",
            Self::SquareWithIntercept => "F = F₀ + C ω²",
            Self::Power => "F = C ω^p",
        }
    }
}

/// How well a law agrees with the points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LawAgreement {
    /// Sum of the squared residuals in units of their uncertainty.
    pub chi_square: f64,
    /// Points less parameters.
    pub degrees_of_freedom: usize,
    /// Chance of disagreeing so much if the law is right: of chi-square where uncertainties are stated, of F where they
    /// were measured.
    pub p_value: f64,
}

/// A law's probability among the three, all being equally plausible beforehand.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LawProbability {
    /// Which law.
    pub law: ForceLaw,
    /// Logarithm of its evidence over that of the square law.
    pub log_evidence_ratio: f64,
    /// Its probability.
    pub probability: f64,
}

/// F = F₀ + C ω².
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct InterceptLaw {
    /// F₀.
    pub intercept_n: Estimate,
    /// C.
    pub thrust_constant_n_s2: Estimate,
}

/// F = F_ref (ω/ω_ref)^p.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PowerLaw {
    /// p.
    pub exponent: Estimate,
    /// ω_ref, in the middle of the points.
    pub reference_rad_s: f64,
    /// F_ref.
    pub reference_force_n: f64,
}

/// The square law through points, and what else they say.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SquareLawFit {
    /// C of F = C ω². Where the points disagree with the law more than their uncertainties say, their scatter is taken.
    pub thrust_constant_n_s2: Estimate,
    /// How well the law holds; absent with a single point, and where nobody states uncertainties.
    pub agreement: Option<LawAgreement>,
    /// Root mean square of the residuals over the largest force.
    pub residual_rms_share: f64,
    /// Largest residual over the largest force.
    pub residual_max_share: f64,
    /// The uncertainty that the points themselves leave in C, before any scatter; what budgets start from.
    pub(crate) own_std_n_s2: f64,
    /// How much each point decides: C is the mean of the points' own constants with these weights. 0 for those left out.
    pub(crate) shares: Vec<f64>,
    /// With an intercept; absent where all speeds are alike.
    pub with_intercept: Option<InterceptLaw>,
    /// As a power of the speed; absent where all speeds are alike.
    pub power_law: Option<PowerLaw>,
    /// What the evidence says of the laws.
    pub laws: Vec<LawProbability>,
    /// The law that the evidence prefers: the square law unless another is ten times as probable.
    pub preferred: ForceLaw,
    /// Each point: whether it fits the others, and what would.
    pub points: Vec<PointVerdict>,
    /// How far the loads lie apart, and whether that is enough to see an intercept.
    pub range: Option<LoadRange>,
}

/// Fits the square law. Points that are off by a factor (wrong unit, wrong octave) are left out and said so.
///
/// # Errors
/// No point; forces or speeds that are zero, negative or no numbers, by the number of the point.
pub fn square_law_fit(points: &[ForcePoint], noise: PointNoise) -> Result<SquareLawFit, FitError> {
    let is_usable = |point: &ForcePoint| {
        let positive =
            [point.force_n, point.speed_square_rad2_s2].iter().all(|number| number.is_finite() && *number > 0.0);
        positive && point.force_std_n >= 0.0 && point.speed_square_std_rad2_s2 >= 0.0
    };
    if let Some(index) = points.iter().position(|point| !is_usable(point)) {
        return Err(FitError::UnusablePoint { number: index + 1 });
    }
    let has_std = |point: &ForcePoint| point.force_std_n > 0.0 || point.speed_square_std_rad2_s2 > 0.0;
    let noise = if points.iter().all(has_std) { noise } else { PointNoise::FromResiduals };
    let gross = gross_points(points);
    let kept: Vec<&ForcePoint> =
        points.iter().zip(&gross).filter(|(_, gross)| !**gross).map(|(point, _)| point).collect();
    let fit = law_through_origin(&kept, noise)?;
    let all_points = verdicts(points, &gross, noise);
    let (with_intercept, line) = intercept_law(&kept, noise).unzip();
    let power_law = power_law(&kept, noise);
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
        shares: shares(points, &gross, &fit, noise),
        preferred: preferred(&laws),
        range: line.and_then(|line| load_range(&kept, &line, noise)),
        with_intercept,
        power_law,
        laws,
        points: all_points,
    })
}

/// The fit's points: with their own uncertainties, or with forces that are all equally uncertain by one unit.
pub(crate) fn fit_points(points: &[&ForcePoint], noise: PointNoise) -> Vec<FitPoint> {
    let of = |point: &&ForcePoint| match noise {
        PointNoise::FromResiduals => FitPoint::with_y_std(point.speed_square_rad2_s2, point.force_n, 1.0),
        PointNoise::Stated | PointNoise::Measured { .. } => point.fit_point(),
    };
    points.iter().map(of).collect()
}

pub(crate) fn law_through_origin(points: &[&ForcePoint], noise: PointNoise) -> Result<ProportionalFit, FitError> {
    proportional_fit(&fit_points(points, noise))
}

/// Standard uncertainty of the slope with the scatter of the points where it is larger than their uncertainties say, or
/// where nothing else is known.
pub(crate) fn scattered_std(fit: ProportionalFit, noise: PointNoise) -> Option<f64> {
    Some(fit.slope_std * scatter_factor(fit.agreement, noise)?)
}

/// Factor from stated to real uncertainties; `None` where nothing tells.
pub(crate) fn scatter_factor(agreement: Agreement, noise: PointNoise) -> Option<f64> {
    match (noise, agreement_of(agreement, noise)) {
        (PointNoise::FromResiduals, _) => agreement.scatter_factor(),
        (_, Some(law)) if law.p_value < DISAGREEMENT_CHANCE => agreement.scatter_factor(),
        _ => Some(1.0),
    }
}

pub(crate) fn agreement_of(agreement: Agreement, noise: PointNoise) -> Option<LawAgreement> {
    let freedom = agreement.degrees_of_freedom as f64;
    let p_value = match noise {
        PointNoise::FromResiduals => None,
        PointNoise::Stated => agreement.p_value(),
        PointNoise::Measured { degrees_of_freedom } => {
            let distribution = FisherSnedecor::new(freedom, degrees_of_freedom).ok()?;
            Some(distribution.sf(agreement.chi_square / freedom))
        }
    }?;
    Some(LawAgreement { chi_square: agreement.chi_square, degrees_of_freedom: agreement.degrees_of_freedom, p_value })
}

fn shares(points: &[ForcePoint], gross: &[bool], fit: &ProportionalFit, noise: PointNoise) -> Vec<f64> {
    let weight = |(point, gross): (&ForcePoint, &bool)| {
        let variance = match noise {
            PointNoise::FromResiduals => 1.0,
            _ => point.force_std_n.powi(2) + (fit.slope * point.speed_square_std_rad2_s2).powi(2),
        };
        if *gross { 0.0 } else { point.speed_square_rad2_s2.powi(2) / variance }
    };
    let weights: Vec<f64> = points.iter().zip(gross).map(weight).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| weight / sum).collect()
}

fn estimate(value: f64, std_uncertainty: Option<f64>) -> Estimate {
    Estimate { value, std_uncertainty, ending: Ending::Solved }
}

fn intercept_law(points: &[&ForcePoint], noise: PointNoise) -> Option<(InterceptLaw, LineFit)> {
    let line = line_fit(&fit_points(points, noise)).ok()?;
    let factor = scatter_factor(line.agreement, noise);
    let law = InterceptLaw {
        intercept_n: estimate(line.intercept, factor.map(|factor| factor * line.intercept_std)),
        thrust_constant_n_s2: estimate(line.slope, factor.map(|factor| factor * line.slope_std)),
    };
    Some((law, line))
}

/// The power law, straight in logarithms. Where nobody states uncertainties, forces count as equally uncertain in per cent.
fn power_law(points: &[&ForcePoint], noise: PointNoise) -> Option<PowerLaw> {
    let logarithms: Vec<FitPoint> = points
        .iter()
        .map(|point| match noise {
            PointNoise::FromResiduals => FitPoint { x_std: 0.0, y_std: 1.0, ..point.logarithms() },
            _ => point.logarithms(),
        })
        .collect();
    let line = line_fit(&logarithms).ok()?;
    let factor = scatter_factor(line.agreement, noise);
    Some(PowerLaw {
        // the abscissa is the logarithm of the square
        exponent: estimate(2.0 * line.slope, factor.map(|factor| 2.0 * factor * line.slope_std)),
        reference_rad_s: (line.x_centre / 2.0).exp(),
        reference_force_n: (line.intercept + line.slope * line.x_centre).exp(),
    })
}

fn law_probabilities(
    points: &[&ForcePoint],
    with_intercept: Option<&InterceptLaw>,
    power_law: Option<&PowerLaw>,
    noise: PointNoise,
) -> Vec<LawProbability> {
    let freedom = points.len().saturating_sub(2);
    let noise_freedom = match noise {
        PointNoise::FromResiduals => Some(freedom),
        PointNoise::Stated | PointNoise::Measured { .. } => None,
    };
    if noise_freedom == Some(0) {
        // two points and no uncertainty: every law with two parameters goes through them
        return Vec::new();
    }
    let mean_n = points.iter().map(|point| point.force_n).sum::<f64>() / points.len() as f64;
    let of = |estimate: Estimate, prior: ParameterPrior| {
        let std = estimate.std_uncertainty.filter(|std| *std > 0.0)?;
        Some(log_evidence_ratio(estimate.value, std, prior, noise_freedom))
    };
    let intercept = with_intercept
        .and_then(|law| of(law.intercept_n, ParameterPrior { null: 0.0, std: INTERCEPT_PRIOR_SHARE * mean_n }));
    let power = power_law.and_then(|law| of(law.exponent, ParameterPrior { null: 2.0, std: EXPONENT_PRIOR_STD }));
    let ratios = [(ForceLaw::Square, Some(0.0)), (ForceLaw::SquareWithIntercept, intercept), (ForceLaw::Power, power)];
    let known: Vec<(ForceLaw, f64)> = ratios.into_iter().filter_map(|(law, ratio)| Some((law, ratio?))).collect();
    let largest = known.iter().map(|(_, ratio)| *ratio).fold(f64::NEG_INFINITY, f64::max);
    let sum: f64 = known.iter().map(|(_, ratio)| (ratio - largest).exp()).sum();
    known
        .into_iter()
        .map(|(law, ratio)| LawProbability {
            law,
            log_evidence_ratio: ratio,
            probability: (ratio - largest).exp() / sum,
        })
        .collect()
}

fn preferred(laws: &[LawProbability]) -> ForceLaw {
    laws.iter()
        .filter(|law| law.log_evidence_ratio > PREFERRED_ODDS.ln())
        .max_by(|a, b| a.log_evidence_ratio.total_cmp(&b.log_evidence_ratio))
        .map_or(ForceLaw::Square, |law| law.law)
}
