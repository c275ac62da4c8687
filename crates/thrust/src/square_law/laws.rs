//! The laws beside the square law, and how probable each of the three is.

use super::agreement::scatter_factor;
use super::point::{ForcePoint, PointNoise, fit_points};
use crate::regression::{FitPoint, LineFit, ParameterPrior, line_fit, log_evidence_ratio};
use hovertone_vehicle::{Ending, Estimate};
use serde::Serialize;

/// Standard deviation of the prior on the intercept F₀, as a share of the mean force: hulls and cables that carry weight, scales
/// that were not set to zero. *Decision.*
const INTERCEPT_PRIOR_SHARE: f64 = 0.1;

/// Exponent of the square law. *Physics.*
const SQUARE_EXPONENT: f64 = 2.0;

/// Standard deviation of the prior on the exponent about 2. Thrust stands measure exponents from 2.0 to 2.2. *Decision.*
const EXPONENT_PRIOR_STD: f64 = 0.2;

/// Odds from which another law is preferred to the square law: "strong" evidence on Jeffreys' scale (Jeffreys 1961). *Decision.*
const PREFERRED_ODDS: f64 = 10.0;

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
    /// The law as a formula for people.
    pub fn formula(self) -> &'static str {
        match self {
            Self::Square => "F = C ω²",
            Self::SquareWithIntercept => "F = F₀ + C ω²",
            Self::Power => "F = C ω^p",
        }
    }
}

/// Probability of a law among the three, which are equally probable before the measurement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LawProbability {
    /// Which law.
    pub law: ForceLaw,
    /// Natural logarithm of the evidence of this law over the evidence of the square law.
    pub log_evidence_ratio: f64,
    /// Probability after the measurement.
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

impl InterceptLaw {
    /// With all uncertainties times a factor.
    pub(super) fn widened(self, factor: f64) -> Self {
        Self {
            intercept_n: widened(self.intercept_n, factor),
            thrust_constant_n_s2: widened(self.thrust_constant_n_s2, factor),
        }
    }
}

impl InterceptLaw {
    /// Whether the points tell the intercept better than its prior does.
    pub(super) fn is_told_by(&self, points: &[&ForcePoint]) -> bool {
        self.intercept_n.std_uncertainty.is_none_or(|std_n| std_n <= intercept_prior_std_n(points))
    }
}

impl PowerLaw {
    /// Whether the points tell the exponent better than its prior does.
    pub(super) fn is_told(&self) -> bool {
        self.exponent.std_uncertainty.is_none_or(|std| std <= EXPONENT_PRIOR_STD)
    }

    /// With the uncertainty of the exponent times a factor.
    pub(super) fn widened(self, factor: f64) -> Self {
        Self { exponent: widened(self.exponent, factor), ..self }
    }
}

fn intercept_prior_std_n(points: &[&ForcePoint]) -> f64 {
    INTERCEPT_PRIOR_SHARE * points.iter().map(|point| point.force_n).sum::<f64>() / points.len() as f64
}

fn widened(estimate: Estimate, factor: f64) -> Estimate {
    Estimate { std_uncertainty: estimate.std_uncertainty.map(|std| factor * std), ..estimate }
}

fn estimate(value: f64, std_uncertainty: Option<f64>) -> Estimate {
    Estimate { value, std_uncertainty, ending: Ending::Solved }
}

/// The law with an intercept, and the straight line behind it; `None` where all speeds are equal.
pub(super) fn intercept_law(points: &[&ForcePoint], noise: PointNoise) -> Option<(InterceptLaw, LineFit)> {
    let line = line_fit(&fit_points(points, noise)).ok()?;
    let factor = scatter_factor(line.agreement, noise);
    let law = InterceptLaw {
        intercept_n: estimate(line.intercept, factor.map(|factor| factor * line.intercept_std)),
        thrust_constant_n_s2: estimate(line.slope, factor.map(|factor| factor * line.slope_std)),
    };
    Some((law, line))
}

/// The power law, a straight line in logarithms. Without stated uncertainties all forces have the same relative uncertainty.
pub(super) fn power_law(points: &[&ForcePoint], noise: PointNoise) -> Option<PowerLaw> {
    let logarithms: Vec<FitPoint> = points
        .iter()
        .map(|point| match noise {
            PointNoise::FromResiduals | PointNoise::FromShares => {
                FitPoint { x_std: 0.0, y_std: 1.0, ..point.logarithms() }
            }
            _ => point.logarithms(),
        })
        .collect();
    let line = line_fit(&logarithms).ok()?;
    let factor = scatter_factor(line.agreement, noise);
    Some(PowerLaw {
        // the abscissa is ln ω² = 2 ln ω
        exponent: estimate(2.0 * line.slope, factor.map(|factor| 2.0 * factor * line.slope_std)),
        reference_rad_s: (line.x_centre / 2.0).exp(),
        reference_force_n: (line.intercept + line.slope * line.x_centre).exp(),
    })
}

/// Probabilities of the laws from their evidences (MacKay 1992). Empty where the points leave no degree of freedom to compare them.
pub(super) fn law_probabilities(
    points: &[&ForcePoint],
    with_intercept: Option<&InterceptLaw>,
    power_law: Option<&PowerLaw>,
    noise: PointNoise,
) -> Vec<LawProbability> {
    let freedom = points.len().saturating_sub(2);
    let noise_freedom = match noise {
        PointNoise::FromResiduals | PointNoise::FromShares | PointNoise::Unrepeated { .. } => Some(freedom),
        PointNoise::Measured { degrees_of_freedom } => Some(degrees_of_freedom as usize),
        PointNoise::Stated => None,
    };
    if freedom == 0 || noise_freedom == Some(0) {
        // every law with two parameters goes through two points: nothing shows which of them is right, nor whether a point is wrong
        return Vec::new();
    }
    let of = |estimate: Estimate, prior: ParameterPrior| {
        let std = estimate.std_uncertainty.filter(|std| *std > 0.0)?;
        Some(log_evidence_ratio(estimate.value, std, prior, noise_freedom))
    };
    let intercept = with_intercept
        .and_then(|law| of(law.intercept_n, ParameterPrior { null: 0.0, std: intercept_prior_std_n(points) }));
    let power =
        power_law.and_then(|law| of(law.exponent, ParameterPrior { null: SQUARE_EXPONENT, std: EXPONENT_PRIOR_STD }));
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

/// The law with the largest evidence among those that exceed the square law by [`PREFERRED_ODDS`], else the square law.
pub(super) fn preferred(laws: &[LawProbability]) -> ForceLaw {
    laws.iter()
        .filter(|law| law.log_evidence_ratio > PREFERRED_ODDS.ln())
        .max_by(|a, b| a.log_evidence_ratio.total_cmp(&b.log_evidence_ratio))
        .map_or(ForceLaw::Square, |law| law.law)
}
