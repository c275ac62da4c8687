//! What is known of an open recording.

use crate::container::Container;
use crate::plan::Route;

/// The decoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Decoder {
    /// This crate.
    Native,
    /// An ffmpeg in another process.
    Ffmpeg,
    /// The program around this crate, such as a browser.
    Caller,
}

impl Decoder {
    pub(crate) fn of(route: &Route) -> Self {
        match route {
            Route::Ffmpeg { .. } => Self::Ffmpeg,
            Route::Decoded(_) => Self::Caller,
            _ => Self::Native,
        }
    }
}

/// Facts about a recording from its headers and first frames.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RecordingInfo {
    /// Recognised by the content.
    pub container: Container,
    /// Name of the codec for people.
    pub codec: String,
    /// Samples per second: the rate in the file, with the correction of the recorder's clock.
    pub sample_rate_hz: f64,
    /// That correction, in millionths; positive for a clock that runs fast.
    pub clock_correction_ppm: f64,
    /// Channels of the track.
    pub channel_count: usize,
    /// Number of the selected channel, counted from 1; `None` for the mean of all.
    pub channel: Option<usize>,
    /// Number of the selected track, counted from 1.
    pub audio_track: usize,
    /// Number of audio tracks in the file.
    pub audio_track_count: usize,
    /// Length of the sound in the header, where it has one; it can be wrong.
    pub declared_duration_s: Option<f64>,
    /// Time of the first sample on the clock of the recording.
    pub start_s: f64,
    /// The decoder.
    pub decoder: Decoder,
}
