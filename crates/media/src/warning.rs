//! Warnings about a recording that could be decoded.

use std::fmt;
use std::mem::discriminant;

use crate::container::Container;
use crate::mix_loss::MixLoss;

/// Channels cancel each other where their mean has less than this share of the power that it would have if they had nothing in common. *Decision.*
const CANCELLED_SHARE: f64 = 0.1;

/// A warning. [`MediaWarning::hint`] has the advice.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MediaWarning {
    /// The file name has the extension of another format; the content was used.
    WrongExtension {
        /// Extension of the file name, without the dot.
        extension: String,
        /// Container of the content.
        container: Container,
    },
    /// The file ends before its sound does; only the beginning was decoded.
    Truncated {
        /// Length of the decoded sound.
        decoded_s: f64,
        /// Length by the header, where it has one.
        declared_s: Option<f64>,
    },
    /// The length in the header is wrong; the sound was read to the end of the file.
    WrongDataSize {
        /// Length by the header.
        declared_bytes: u64,
        /// Length by the file.
        actual_bytes: u64,
    },
    /// Damaged packets were replaced by silence, so that all times stay right.
    CorruptPackets {
        /// Number of packets.
        count: u64,
        /// Length of the silence.
        silence_s: f64,
    },
    /// NaN or infinite samples were replaced by zero.
    NonFiniteSamples {
        /// Number of samples.
        count: u64,
    },
    /// Many audio samples are at full scale: the recorder could not follow the sound.
    Overdriven {
        /// Their share of all.
        share: f64,
    },
    /// The channels have opposite signs, so that their mean has lost most of their power.
    ChannelsCancel {
        /// Loss against the mean power of the channels in dB; infinite where nothing is left.
        lost_db: f64,
    },
    /// The file has several audio tracks, and none was requested.
    SeveralAudioTracks {
        /// Number of the chosen track, counted from 1.
        chosen: usize,
        /// Number of tracks in the file.
        count: usize,
        /// Silent tracks before the chosen one, counted from 1.
        silent: Vec<usize>,
    },
    /// HE-AAC of which only the core was decoded: frequencies above half of the rate of the core are missing.
    HalfRateAac {
        /// Rate of the decoded core.
        core_rate_hz: f64,
        /// Whether the file states it. Otherwise its low sample rate makes it possible, since bare ADTS does not state it.
        is_certain: bool,
    },
    /// The sample rate or number of channels changes; the sound up to there was used.
    FormatChange {
        /// Time of the change.
        at_s: f64,
    },
    /// ffmpeg decoded the sound and reported an error.
    Ffmpeg {
        /// Its first error message.
        message: String,
    },
}

impl MediaWarning {
    /// That channels cancel each other, where they do.
    pub(crate) fn of_mix(loss: &MixLoss) -> Option<Self> {
        loss.lost_db(CANCELLED_SHARE).map(|lost_db| Self::ChannelsCancel { lost_db })
    }

    /// Advice to the user.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::WrongExtension { .. } => "you need to do nothing: hovertone does not use the extension",
            Self::Truncated { .. } => "copy the file again from the camera or recorder to have all of it",
            Self::WrongDataSize { .. } => {
                "you need to do nothing, nothing was lost: the recorder probably stopped without closing the file, or \
                wrote to a pipe"
            }
            Self::CorruptPackets { .. } => "copy the file again, or choose a part without damage with --from and --to",
            Self::NonFiniteSamples { .. } => {
                "check the program that wrote the file; the hover needs a part without such errors"
            }
            Self::Overdriven { .. } => "record again with less gain, or from further away",
            Self::ChannelsCancel { .. } => "use one channel: --channel 1",
            Self::SeveralAudioTracks { .. } => "to hear another audio track, give --audio-track N",
            Self::HalfRateAac { .. } => {
                "tones above half of this sample rate are missing; if you need them, record as AAC-LC or PCM"
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
                write!(f, "the file's name ends in .{extension}, but its content has another format: {container}")
            }
            Self::Truncated { decoded_s, declared_s: Some(declared_s) } => {
                write!(f, "the file ends early: {decoded_s:.3} s of {declared_s:.3} s could be decoded")
            }
            Self::Truncated { decoded_s, declared_s: None } => {
                write!(f, "the file ends in the middle of its sound: {decoded_s:.3} s could be decoded")
            }
            Self::WrongDataSize { declared_bytes, actual_bytes } => {
                write!(
                    f,
                    "the header of the file says {declared_bytes} bytes of sound, but the file holds {actual_bytes} \
                    bytes of sound"
                )
            }
            Self::CorruptPackets { count, silence_s } => {
                let pieces = if *count == 1 { "piece of sound was" } else { "pieces of sound were" };
                write!(f, "{count} damaged {pieces} replaced by {silence_s:.3} s of silence")
            }
            Self::NonFiniteSamples { count } => {
                let (samples, they) = if *count == 1 {
                    ("audio sample is no number", "it was")
                } else {
                    ("audio samples are no numbers", "they were")
                };
                write!(f, "{count} {samples} (NaN or infinite); {they} replaced by zero")
            }
            Self::Overdriven { share } => {
                write!(f, "the recording is overdriven: {:.0} % of its audio samples are at full scale", 100.0 * share)
            }
            Self::ChannelsCancel { lost_db } => {
                f.write_str("the channels cancel each other, because they have opposite signs: ")?;
                match lost_db.is_finite() {
                    true => write!(f, "their mean, which is used, has {lost_db:.0} dB less power than one channel"),
                    false => f.write_str("their mean, which is used, is silent"),
                }
            }
            Self::SeveralAudioTracks { chosen, count, silent } => {
                write!(f, "audio track {chosen} of {count} is used")?;
                if !silent.is_empty() {
                    let (tracks, are) = if silent.len() == 1 { ("track", "is") } else { ("tracks", "are") };
                    let silent: Vec<String> = silent.iter().map(usize::to_string).collect();
                    write!(f, ", because {tracks} {} {are} silent", silent.join(", "))?;
                }
                Ok(())
            }
            Self::HalfRateAac { core_rate_hz, is_certain: true } => {
                write!(
                    f,
                    "the sound is HE-AAC: only its lower frequencies (sample rate {core_rate_hz} Hz) were decoded"
                )
            }
            Self::HalfRateAac { core_rate_hz, is_certain: false } => {
                write!(
                    f,
                    "the sound may be HE-AAC, of which only the lower frequencies (sample rate {core_rate_hz} Hz) were decoded"
                )
            }
            Self::FormatChange { at_s } => {
                write!(f, "the sample rate or the number of channels changes after {at_s:.3} s; the rest was left out")
            }
            Self::Ffmpeg { message } => {
                write!(f, "ffmpeg could not decode all of the sound: it said \u{201c}{message}\u{201d}")
            }
        }
    }
}

/// Warnings of one recording: one of each kind, with the latest counts, for any number of passes.
#[derive(Debug, Default)]
pub(crate) struct Warnings(Vec<MediaWarning>);

impl Warnings {
    pub(crate) fn put(&mut self, warning: MediaWarning) {
        match self.0.iter_mut().find(|known| discriminant(*known) == discriminant(&warning)) {
            Some(known) => *known = warning,
            None => self.0.push(warning),
        }
    }

    /// Like [`put`](Self::put), but keeps the count of a more complete pass, since a new pass starts counting at zero.
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
