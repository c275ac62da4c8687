//! Facts about a recording for its record.

use hovertone_media::{Decoder, Recording};
use hovertone_report::RecordingFacts;

/// What is known of an open recording.
pub(crate) fn facts_of(recording: &Recording, sha256: Option<String>) -> RecordingFacts {
    let info = recording.info();
    RecordingFacts {
        sha256,
        container: info.container.to_string(),
        codec: info.codec.clone(),
        decoder: match info.decoder {
            Decoder::Native => "hovertone",
            Decoder::Ffmpeg => "ffmpeg",
            _ => "other",
        }
        .to_owned(),
        sample_rate_hz: info.sample_rate_hz,
        channel_count: info.channel_count,
        channel: info.channel,
        audio_track: info.audio_track,
        audio_track_count: info.audio_track_count,
        is_prefix: recording.is_prefix(),
    }
}
