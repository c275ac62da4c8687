//! The terms of a speed's uncertainty.

use serde::Serialize;

/// Where an uncertainty comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum UncertaintySource {
    /// Noise, and what the method makes of it.
    Sound,
    /// The sampling clock of the recorder: `n Δ / √3` for a clock that is off by up to ±Δ.
    Clock,
    /// A vehicle that moves along the line to the microphone by up to ±v all the time: `n v / (c √3)`.
    Doppler,
    /// A hover that is up to ±d nearer to the microphone at the end of a stretch T than at its beginning: `n d / (c T √3)`.
    Drift,
    /// The mean of all rotors is not that of those that were heard apart: one ridge stands for all of them, and their mean lies about it as
    /// their speeds scatter; or some of them were not told from others.
    Rotors,
}

/// One term of the uncertainty of a speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct UncertaintyTerm {
    /// Where it comes from.
    pub source: UncertaintySource,
    /// Standard uncertainty (GUM, type B terms from rectangular distributions).
    pub std_uncertainty_rev_s: f64,
}
