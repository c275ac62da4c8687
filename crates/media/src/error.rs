//! Reasons why a recording cannot be decoded: what happened, why, and what to do.

use std::io;

use thiserror::Error;

use crate::container::Container;

/// A file without usable sound. The message has three parts (what, why, what to do); the caller adds the name of the file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MediaError {
    /// The file cannot be opened.
    #[error("the file cannot be opened: {}", why_not_opened(.0))]
    CannotOpen(#[source] io::Error),

    /// A recording at an address that this program cannot read.
    #[error("{0}")]
    AtAddress(String),

    /// A directory, pipe or device.
    #[error(
        "this is a pipe or a device, but hovertone reads the sound more than once; give a file on disk, or - for the \
        standard input"
    )]
    NotAFile,

    /// An empty file.
    #[error("there is nothing in it (0 bytes); copy or record it again")]
    Empty,

    /// No known signature.
    #[error(
        "this is not an audio or video file that hovertone can read: its content matches no audio or video format \
         ({content}); give a video or audio file"
    )]
    UnknownFormat {
        /// What the file holds: text, or its first bytes as hexadecimal numbers.
        content: String,
    },

    /// A pipe that holds no sound of a known kind.
    #[error(
        "the pipe holds no sound that can be heard as it arrives ({why}); send WAVE, FLAC, Ogg, Matroska or MP3, as \
         `ffmpeg -i INPUT -f wav -` does"
    )]
    UnknownStream {
        /// The reason of the decoder.
        why: String,
    },

    /// A pipe with pictures only.
    #[error("the pipe holds no audio track: there is nothing to hear; record again with the microphone on")]
    NoAudioInStream,

    /// A picture without sound.
    #[error("the {container} has no audio track: there is nothing to hear; record again with the microphone on")]
    NoAudioTrack {
        /// The container.
        container: Container,
    },

    /// The requested track does not exist.
    #[error(
        "audio track {asked} does not exist: the file has {}; {}leave --audio-track out",
        numbered(*count, "audio track"), other_number(*count)
    )]
    NoSuchTrack {
        /// Number of the track, counted from 1.
        asked: usize,
        /// Audio tracks in the file.
        count: usize,
    },

    /// The requested channel does not exist.
    #[error(
        "channel {asked} does not exist: the audio track has {}; {}leave --channel out",
        numbered(*count, "channel"), other_number(*count)
    )]
    NoSuchChannel {
        /// Number of the channel, counted from 1.
        asked: usize,
        /// Channels in the track.
        count: usize,
    },

    /// Only ffmpeg decodes this file, and it is not available.
    #[error(
        "the {container} holds {codec}, which needs the program ffmpeg: hovertone has no decoder of its own for it, and \
         {why}, or convert the sound to WAV or FLAC"
    )]
    NeedsFfmpeg {
        /// The container.
        container: Container,
        /// Name of the codec for people.
        codec: String,
        /// Reason why ffmpeg was not used, and what to do.
        why: String,
    },

    /// ffmpeg was started and failed.
    #[error(
        "the {container} holds {codec}, which could not be decoded: ffmpeg said \u{201c}{message}\u{201d}; check that the file plays"
    )]
    FfmpegFailed {
        /// The container.
        container: Container,
        /// Name of the codec for people.
        codec: String,
        /// Its first error message.
        message: String,
    },

    /// The structure is broken before any sound.
    #[error("the {container} is damaged: {why}; copy it again from the camera or recorder, or try to repair it")]
    Damaged {
        /// The container.
        container: Container,
        /// The damage.
        why: String,
    },

    /// A header field with an impossible value.
    #[error("the header of the {container} is wrong: {field} = {value}, but it must be {limit}; export the file again")]
    BadHeader {
        /// The container.
        container: Container,
        /// The field.
        field: &'static str,
        /// Its value.
        value: u64,
        /// Allowed values.
        limit: &'static str,
    },

    /// A valid header without sound after it.
    #[error("the {container} holds no sound: {why}; copy it again, or record again")]
    NoSamples {
        /// The container.
        container: Container,
        /// Content after the header.
        why: String,
    },

    /// An array without a sample.
    #[error("the array has no audio samples: there is nothing to hear; give the audio samples of a recording")]
    NoSampleInArray,

    /// An array whose rate is none.
    #[error("rate_hz = {rate_hz}, but it must be 1 or more; give the number of audio samples per second")]
    RateOfArray {
        /// The rate.
        rate_hz: f64,
    },

    /// Reading the disk failed.
    #[error("the file could not be read to its end: {}{}", .0, advice_on(.0))]
    Read(#[source] io::Error),
}

impl MediaError {
    /// The kind of error in one word of files for programs.
    pub fn class(&self) -> &'static str {
        match self {
            Self::CannotOpen(error) if error.kind() == io::ErrorKind::NotFound => "not_found",
            Self::CannotOpen(_) | Self::Read(_) | Self::AtAddress(_) => "unreadable",
            Self::NotAFile => "not_a_file",
            Self::Empty => "empty",
            Self::UnknownFormat { .. } | Self::UnknownStream { .. } => "unknown_format",
            Self::NoAudioTrack { .. } | Self::NoAudioInStream => "no_audio_track",
            Self::NoSuchTrack { .. } => "no_such_track",
            Self::NoSuchChannel { .. } => "no_such_channel",
            Self::NeedsFfmpeg { .. } => "needs_ffmpeg",
            Self::FfmpegFailed { .. } | Self::Damaged { .. } | Self::BadHeader { .. } | Self::RateOfArray { .. } => {
                "damaged"
            }
            Self::NoSamples { .. } | Self::NoSampleInArray => "no_samples",
        }
    }
}

/// "only 1 channel", or "channels 1 to 4".
fn numbered(count: usize, noun: &str) -> String {
    match count {
        0 => format!("no {noun}"),
        1 => format!("only 1 {noun}"),
        _ => format!("{noun}s 1 to {count}"),
    }
}

/// Asks for another number where there is one.
fn other_number(count: usize) -> &'static str {
    if count > 1 { "give one of these numbers, or " } else { "" }
}

/// What to do about a read that failed. An error of a store, which is no error of the system, brings its own advice.
fn advice_on(error: &io::Error) -> &'static str {
    if error.get_ref().is_some() { "" } else { "; check the disk or the connection" }
}

/// Why a file cannot be opened and what to do, in plain words where they are known.
fn why_not_opened(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file; check its name and its folder".to_owned(),
        io::ErrorKind::PermissionDenied => {
            "you have no right to read it, or to open its folder; ask the owner for the right to read it, or for a copy"
                .to_owned()
        }
        io::ErrorKind::NotADirectory => {
            "a part of the path is a file and no folder; correct the path: behind the name of a file stands nothing"
                .to_owned()
        }
        io::ErrorKind::InvalidFilename => "the name is too long, or not allowed; check the name".to_owned(),
        _ if error.get_ref().is_some() => error.to_string(),
        _ => format!("{error}; check the file and its disk"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_asked_for_only_where_there_is_another() {
        let only = MediaError::NoSuchTrack { asked: 2, count: 1 }.to_string();
        assert_eq!(only, "audio track 2 does not exist: the file has only 1 audio track; leave --audio-track out");
        let several = MediaError::NoSuchChannel { asked: 5, count: 2 }.to_string();
        assert!(
            several.ends_with("has channels 1 to 2; give one of these numbers, or leave --channel out"),
            "{several}"
        );
    }
}
