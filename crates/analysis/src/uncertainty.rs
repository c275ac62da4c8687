//! The terms of the uncertainty of a speed.

use serde::Serialize;

/// Source of an uncertainty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum UncertaintySource {
    /// Noise, and errors of the method.
    Sound,
    /// Clock of the recorder: n Δ / √3 for a relative error of the clock within ±Δ.
    Clock,
    /// Doppler effect of a vehicle with a constant radial speed within ±v: n v / (c √3).
    Doppler,
    /// Doppler effect of a vehicle whose distance changes by up to ±d over a stretch T: n d / (c T √3).
    Drift,
    /// Difference between the mean of all rotors and the mean of the heard ones: a single ridge stands for all rotors, or not all rotors
    /// were separated.
    Rotors,
}

/// One term of the uncertainty of a speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct UncertaintyTerm {
    /// Source of the term.
    pub source: UncertaintySource,
    /// Standard uncertainty (JCGM 100:2008; type B terms have rectangular distributions).
    pub std_uncertainty_rev_s: f64,
}
