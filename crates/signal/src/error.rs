//! Errors of a pass over a sound.

use crate::SourceError;

/// A pass over a source could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SignalError {
    /// The source failed to deliver samples or to rewind.
    #[error("the sound could not be read to its end: {0}")]
    Source(#[from] SourceError),
    /// The sample rate of the source is outside 1 kHz to 1 MHz.
    #[error(
        "the sample rate is {sample_rate_hz} Hz, but it must be from 1000 to 1000000 Hz; give a recording with such a rate"
    )]
    SampleRate {
        /// Sample rate of the source, Hz.
        sample_rate_hz: f64,
    },
}
