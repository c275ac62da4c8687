//! Conversion of panics of other libraries on damaged data to errors.

use std::panic::{AssertUnwindSafe, catch_unwind};

use symphonia::core::errors::Error as SymphoniaError;

/// The error in place of a panic.
pub(crate) const PANICKED: &str = "its content broke the decoder";

/// Runs a demuxer or decoder of another library on data that can be damaged.
///
/// Symphonia 0.6.1 does panic: a fragmented MP4 with damaged offsets fails an assertion of `MediaSourceStream::seek_buffered`, and its
/// CAF reader multiplies without a check for overflow. A demuxer is not called again after a panic. For a decoder a panic is one damaged
/// packet, and the decoder is reset.
pub(crate) fn guarded<T>(work: impl FnOnce() -> Result<T, SymphoniaError>) -> Result<T, SymphoniaError> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or(Err(SymphoniaError::DecodeError(PANICKED)))
}
