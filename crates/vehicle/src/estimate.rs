//! A number with its uncertainty and its origin.

use serde::{Deserialize, Serialize};

/// Coverage factor k of the expanded uncertainty, for a probability of about 95 % (JCGM 100:2008, 6.3.3). *Decision.*
pub const COVERAGE_FACTOR: f64 = 2.0;

/// How an estimate was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Ending {
    /// From several observations, whose scatter gives the uncertainty.
    Solved,
    /// From a single observation: the uncertainty contains no scatter.
    SingleObservation,
}

/// A value with its standard uncertainty, in the unit of the name of the field that holds it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Standard uncertainty (one standard deviation); absent where it is unknown.
    pub std_uncertainty: Option<f64>,
    /// How it was made.
    pub ending: Ending,
}

impl Estimate {
    /// The estimate and its uncertainty times a factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            std_uncertainty: self.std_uncertainty.map(|std_uncertainty| std_uncertainty * factor.abs()),
            ..self
        }
    }
}
