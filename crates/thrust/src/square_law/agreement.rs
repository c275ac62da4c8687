//! How well points agree with a law, and how far their scatter exceeds their stated uncertainties.

use super::point::PointNoise;
use crate::regression::Agreement;
use crate::statistics::student_factor;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Points disagree with a law where chance alone would give such a deviation with less than this probability.
/// 5 % is the usual level of a significance test (Fisher 1925). *Decision.*
pub(super) const DISAGREEMENT_CHANCE: f64 = 0.05;

/// How well a law agrees with the points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LawAgreement {
    /// Sum of the squared residuals, each in units of its standard uncertainty.
    pub chi_square: f64,
    /// Number of points minus number of parameters.
    pub degrees_of_freedom: usize,
    /// Probability of a disagreement at least this large if the law is right: from the chi-square distribution where uncertainties
    /// are stated, from the F distribution where they were measured.
    pub p_value: f64,
}

impl LawAgreement {
    /// Whether the points disagree with the law.
    pub fn is_disagreement(&self) -> bool {
        self.p_value < DISAGREEMENT_CHANCE
    }
}

/// The agreement with its p-value; `None` where the uncertainties come from the residuals themselves, or without degrees of freedom.
pub(crate) fn agreement_of(agreement: Agreement, noise: PointNoise) -> Option<LawAgreement> {
    let freedom = agreement.degrees_of_freedom as f64;
    let p_value = match noise {
        PointNoise::FromResiduals | PointNoise::FromShares | PointNoise::Unrepeated { .. } => None,
        PointNoise::Stated => agreement.p_value(),
        PointNoise::Measured { degrees_of_freedom } => {
            let distribution = FisherSnedecor::new(freedom, degrees_of_freedom).ok()?;
            Some(distribution.sf(agreement.chi_square / freedom))
        }
    }?;
    Some(LawAgreement { chi_square: agreement.chi_square, degrees_of_freedom: agreement.degrees_of_freedom, p_value })
}

/// Factor from stated to real uncertainties: Birge's ratio (Birge 1932) where the points disagree with the law or state no
/// uncertainty, else 1. `None` where the ratio is needed and there are no degrees of freedom.
pub(crate) fn scatter_factor(agreement: Agreement, noise: PointNoise) -> Option<f64> {
    let disagrees = || agreement_of(agreement, noise).is_some_and(|law| law.is_disagreement());
    if noise.is_by_residuals() || disagrees() { agreement.scatter_factor() } else { Some(1.0) }
}

/// The same factor for a ±: where the scatter of few points shows their uncertainty, Student's factor is part of it. That is so, too, where they
/// scatter more than stated. Measured uncertainties have the factor of their own degrees of freedom already: with another one, 97 % of simulated
/// campaigns would be covered.
pub(crate) fn covering_factor(agreement: Agreement, noise: PointNoise) -> Option<f64> {
    let scatter = scatter_factor(agreement, noise)?;
    let is_by_scatter = noise.is_by_residuals() || noise == PointNoise::Stated && scatter > 1.0;
    let few = if is_by_scatter { student_factor(agreement.degrees_of_freedom as f64) } else { 1.0 };
    Some(few * scatter)
}
