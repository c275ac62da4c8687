//! A number that says how sure it is and how it came about.

use serde::{Deserialize, Serialize};

/// How an estimate came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Ending {
    /// From enough observations for its uncertainty to be measured from their scatter.
    Solved,
    /// From a single observation: the value stands, its uncertainty covers only what one observation can tell.
    SingleObservation,
}

/// A value with its standard uncertainty, in the unit that the field's name says.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// One standard deviation of what the value could be off; absent where nothing tells it.
    pub std_uncertainty: Option<f64>,
    /// How it came about.
    pub ending: Ending,
}

impl Estimate {
    /// The same estimate in another unit, `factor` of the old one.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            std_uncertainty: self.std_uncertainty.map(|std_uncertainty| std_uncertainty * factor.abs()),
            ..self
        }
    }
}
