//! Why sound cannot be read.

use crate::SourceError;

/// A pass over a source could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SignalError {
    /// The source failed.
    #[error("the sound could not be read to its end: {0}")]
    Source(#[from] SourceError),
    /// The source has an impossible sample rate.
    #[error("a sample rate of {sample_rate_hz} Hz means nothing, allowed 1000 to 1000000 Hz")]
    SampleRate {
        /// The rate that the source gives.
        sample_rate_hz: f64,
    },
}
