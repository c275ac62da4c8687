//! Panics of foreign demuxers and decoders on damaged data, taken for errors.

use std::panic::{AssertUnwindSafe, catch_unwind};

use symphonia::core::errors::Error as SymphoniaError;

/// What a panic becomes.
pub(crate) const PANICKED: &str = "its content broke the decoder";

/// Runs a foreign demuxer or decoder on data that may be damaged.
///
/// Symphonia 0.6.1 does panic: a fragmented MP4 whose offsets are damaged runs into an assertion of
/// `MediaSourceStream::seek_buffered`; and its CAF reader multiplies unchecked. A demuxer that panicked is not asked
/// again; for a decoder it is one damaged packet, and it is reset.
pub(crate) fn guarded<T>(work: impl FnOnce() -> Result<T, SymphoniaError>) -> Result<T, SymphoniaError> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or(Err(SymphoniaError::DecodeError(PANICKED)))
}
