//! What was odd about a recording that could be heard all the same.

use std::fmt;
use std::mem::discriminant;

use crate::container::Container;

/// Something the listener should know. [`MediaWarning::hint`] says what to do about it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MediaWarning {
    /// The name says one format, the content another; the content was believed.
    WrongExtension {
        /// Of the file name, without the dot.
        extension: String,
        /// What the content is.
        container: Container,
    },
    /// The file ends before its sound does: only the beginning was heard.
    Truncated {
        /// Heard.
        decoded_s: f64,
        /// What the header promised, where it did.
        declared_s: Option<f64>,
    },
    /// The header's length of the sound is wrong; the sound was read to the end of the file.
    WrongDataSize {
        /// As the header has it.
        declared_bytes: u64,
        /// As the file has it.
        actual_bytes: u64,
    },
    /// Pieces that could not be decoded were replaced by silence, so that time stays right.
    CorruptPackets {
        /// How many.
        count: u64,
        /// Silence put in their place.
        silence_s: f64,
    },
    /// NaN or infinite samples were replaced by zero.
    NonFiniteSamples {
        /// How many.
        count: u64,
    },
    /// There are several audio tracks, and nobody said which.
    SeveralAudioTracks {
        /// The one that was taken, counted from 1.
        chosen: usize,
        /// In the file.
        count: usize,
        /// Tracks before it that hold only silence, counted from 1.
        silent: Vec<usize>,
    },
    /// HE-AAC, of which only the core was decoded: nothing above half of the core's rate is heard.
    HalfRateAac {
        /// Of the decoded core.
        core_rate_hz: f64,
        /// Whether the file says so; otherwise its low sample rate makes it possible (bare ADTS does not tell).
        is_certain: bool,
    },
    /// The sample rate or number of channels changes in the middle; the sound up to there was taken.
    FormatChange {
        /// Where.
        at_s: f64,
    },
    /// The sound had to be decoded by ffmpeg, and it complained.
    Ffmpeg {
        /// Its first complaint.
        message: String,
    },
}

impl MediaWarning {
    /// What to do about it.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::WrongExtension { .. } => "rename the file, or leave it: the extension is not used",
            Self::Truncated { .. } => "copy the file again from the camera or recorder to have all of it",
            Self::WrongDataSize { .. } => {
                "the recorder was probably stopped hard, or wrote to a pipe; nothing was lost"
            }
            Self::CorruptPackets { .. } => "leave the damaged part out, or copy the file again",
            Self::NonFiniteSamples { .. } => "look at the program that wrote the file; a hover needs a clean stretch",
            Self::SeveralAudioTracks { .. } => "choose another with --audio-track N",
            Self::HalfRateAac { .. } => {
                "tones above half the rate are missing; record as AAC-LC or PCM if you need them"
            }
            Self::FormatChange { .. } => "split the file there, or convert it to WAV",
            Self::Ffmpeg { .. } => "check that the file plays to its end",
        }
    }
}

impl fmt::Display for MediaWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WrongExtension { extension, container } => {
                write!(
                    f,
                    "the file's name ends in .{extension}, and its content is that of another format: {container}"
                )
            }
            Self::Truncated { decoded_s, declared_s: Some(declared_s) } => {
                write!(f, "the file ends early: {decoded_s:.3} s of {declared_s:.3} s could be decoded")
            }
            Self::Truncated { decoded_s, declared_s: None } => {
                write!(f, "the file ends in the middle of its sound: {decoded_s:.3} s could be decoded")
            }
            Self::WrongDataSize { declared_bytes, actual_bytes } => {
                write!(f, "the header says {declared_bytes} bytes of sound, and the file holds {actual_bytes}")
            }
            Self::CorruptPackets { count, silence_s } => {
                write!(f, "{count} damaged pieces of sound were replaced by {silence_s:.3} s of silence")
            }
            Self::NonFiniteSamples { count } => {
                write!(f, "{count} samples were NaN or infinite and were replaced by zero")
            }
            Self::SeveralAudioTracks { chosen, count, silent } => {
                write!(f, "of {count} audio tracks, number {chosen} was taken")?;
                if !silent.is_empty() {
                    let silent: Vec<String> = silent.iter().map(usize::to_string).collect();
                    write!(f, ", because silence is all that is in number {}", silent.join(", "))?;
                }
                Ok(())
            }
            Self::HalfRateAac { core_rate_hz, is_certain: true } => {
                write!(f, "the sound is HE-AAC: only its core at {core_rate_hz} Hz was decoded")
            }
            Self::HalfRateAac { core_rate_hz, is_certain: false } => {
                write!(f, "the sound may be HE-AAC, of which only the core at {core_rate_hz} Hz was decoded")
            }
            Self::FormatChange { at_s } => {
                write!(f, "the sample rate or the channels change after {at_s:.3} s; the rest was left out")
            }
            Self::Ffmpeg { message } => write!(f, "ffmpeg complained: {message}"),
        }
    }
}

/// Warnings of one recording: each kind once, the latest counts kept, however often the sound is heard.
#[derive(Debug, Default)]
pub(crate) struct Warnings(Vec<MediaWarning>);

impl Warnings {
    pub(crate) fn put(&mut self, warning: MediaWarning) {
        match self.0.iter_mut().find(|known| discriminant(*known) == discriminant(&warning)) {
            Some(known) => *known = warning,
            None => self.0.push(warning),
        }
    }

    /// As [`put`](Self::put), but keeps the count of a fuller pass: hearing the sound again starts counting at zero.
    pub(crate) fn put_larger(&mut self, warning: MediaWarning) {
        let is_known = self.0.iter().any(|known| match (known, &warning) {
            (MediaWarning::CorruptPackets { count: known, .. }, MediaWarning::CorruptPackets { count, .. })
            | (MediaWarning::NonFiniteSamples { count: known }, MediaWarning::NonFiniteSamples { count }) => {
                known >= count
            }
            _ => false,
        });
        if !is_known {
            self.put(warning);
        }
    }

    pub(crate) fn as_slice(&self) -> &[MediaWarning] {
        &self.0
    }
}
