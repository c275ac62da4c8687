//! Why an analysis cannot be made. "No rotor tone" is not among the reasons: it is an answer.

use hovertone_signal::SignalError;
use hovertone_vehicle::{ConfigError, Order, QuantityError};

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
    /// The sound could not be read.
    #[error(transparent)]
    Signal(#[from] SignalError),
    /// A band above what the recording can hold.
    #[error(
        "the band {low_hz:.0} to {high_hz:.0} Hz cannot be heard: a recording with a sample rate of {sample_rate_hz:.0} Hz has no sound \
        above {:.0} Hz; record at a higher sample rate, or follow a lower tone",
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
        "a tone at {order} times the rotor speed cannot be heard: a recording with a sample rate of \
        {sample_rate_hz:.0} Hz has no sound above {:.0} Hz; record at a higher sample rate, or follow a lower tone",
        sample_rate_hz / 2.0
    )]
    ToneAboveNyquist {
        /// Order of the tone.
        order: Order,
        /// Rate of the recording.
        sample_rate_hz: f64,
    },
}
