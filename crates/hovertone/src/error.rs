//! What can go wrong. "No rotor tone here" is not among it: that is an answer.

use crate::signal::SourceError;
use hovertone_vehicle::{Order, QuantityError};

/// A setting that means nothing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConfigError {
    /// A number outside its limits.
    #[error("{name} = {value}, allowed {min} to {max}")]
    OutOfRange {
        /// Name of the setting, as in files and flags.
        name: &'static str,
        /// What was given.
        value: f64,
        /// Smallest allowed.
        min: f64,
        /// Largest allowed.
        max: f64,
    },
    /// A band that holds nothing.
    #[error("the band {low_hz}:{high_hz} Hz holds nothing, its end must be above its start")]
    EmptyBand {
        /// Lower edge.
        low_hz: f64,
        /// Upper edge.
        high_hz: f64,
    },
    /// A span that holds nothing.
    #[error("the span from {from_s} s to {to_s} s holds nothing, its end must be after its start")]
    EmptySpan {
        /// Start.
        from_s: f64,
        /// End.
        to_s: f64,
    },
}

/// An analysis that could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A setting that means nothing.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A quantity that is not what its name says.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
    /// The source could not deliver its samples.
    #[error("the sound could not be read to its end: {0}")]
    Source(#[from] SourceError),
    /// The source has an impossible sample rate.
    #[error("a sample rate of {sample_rate_hz} Hz means nothing, allowed 1000 to 1000000 Hz")]
    SampleRate {
        /// What the source says.
        sample_rate_hz: f64,
    },
    /// A band above what the recording can hold.
    #[error(
        "the band {low_hz:.0} to {high_hz:.0} Hz cannot be heard: sound sampled at {sample_rate_hz:.0} Hz holds nothing \
         above {:.0} Hz; record at a higher rate, or follow a tone of lower order",
        sample_rate_hz / 2.0
    )]
    BandAboveNyquist {
        /// Lower edge of the band.
        low_hz: f64,
        /// Upper edge.
        high_hz: f64,
        /// Rate of the recording.
        sample_rate_hz: f64,
    },
    /// A tone that no rotor could make low enough for the recording.
    #[error(
        "a tone of order {order} cannot be heard: sound sampled at {sample_rate_hz:.0} Hz holds nothing above {:.0} Hz; \
         record at a higher rate, or follow a tone of lower order",
        sample_rate_hz / 2.0
    )]
    ToneAboveNyquist {
        /// Order of the tone.
        order: Order,
        /// Rate of the recording.
        sample_rate_hz: f64,
    },
}
