//! The plan how to decode one audio track: made once when a file is opened, used in every pass over the sound.

use std::io::ErrorKind;
use std::path::PathBuf;

use symphonia::core::codecs::audio::AudioCodecId;
use symphonia::core::errors::Error as SymphoniaError;

use crate::container::Container;
use crate::decoded::{DecodedFrames, DecodedSound};
use crate::error::MediaError;
use crate::ffmpeg::{FfmpegError, FfmpegFrames, not_started};
use crate::file_access::FileAccess;
use crate::frames::{Frames, Trim};
use crate::iso::PcmFrames;
use crate::native::{self, NativeFrames};
use crate::pcm_layout::PcmLayout;
use crate::quicktime::AudioTrack;
use crate::samples::{SampleFrames, Samples};
use crate::source::Patch;
use crate::warning::MediaWarning;
use crate::wave::{WaveLayout, WavePcmFrames};

/// Sound shorter than this share of the length that the header estimates has lost a part. *Decision.*
const LOST_SHARE: f64 = 0.95;

/// Packets at the beginning that can fail to decode before a track counts as damaged.
const BAD_PACKETS_AT_START_MAX: u32 = 200;

/// How to decode one track.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) container: Container,
    pub(crate) codec: String,
    pub(crate) route: Route,
    /// Rate and channels, where decoding has shown that the header is wrong.
    pub(crate) format: Option<(u32, usize)>,
    pub(crate) trim: Trim,
    /// Time of the first frame that is kept.
    pub(crate) start_s: f64,
    /// Length of the kept sound, where the file states one.
    pub(crate) declared_s: Option<f64>,
    /// Approximate length of the sound, where the file has only an estimate (its picture, its last page).
    pub(crate) approximate_s: Option<f64>,
    /// Tolerance of the stated length for a complete file.
    pub(crate) declared_slack_s: f64,
    /// The sizes in the container show that the end is missing.
    pub(crate) is_cut_off: bool,
    /// The container has no length, so the end of the file is no sign of damage.
    pub(crate) has_open_end: bool,
    pub(crate) warnings: Vec<MediaWarning>,
}

/// The decoders of the track.
#[derive(Clone, Debug)]
pub(crate) enum Route {
    WavePcm { layout: WaveLayout, pcm: PcmLayout },
    WaveBlocks { layout: WaveLayout, codec: AudioCodecId },
    IsoPcm(Box<AudioTrack>),
    IsoTable(Box<AudioTrack>),
    Demuxer { base: u64, patches: Vec<Patch>, track_id: u32, has_gapless_packets: bool },
    Ffmpeg { program: PathBuf, path: PathBuf, audio_index: usize },
    Memory(Samples),
    Decoded(DecodedSound),
}

impl Plan {
    /// A plan without trims and stated lengths.
    pub(crate) fn new(container: Container, codec: impl Into<String>, route: Route) -> Self {
        Self {
            container,
            codec: codec.into(),
            route,
            format: None,
            trim: Trim::default(),
            start_s: 0.0,
            declared_s: None,
            approximate_s: None,
            declared_slack_s: 0.0,
            is_cut_off: false,
            has_open_end: false,
            warnings: Vec::new(),
        }
    }

    /// Opens the track at its beginning.
    pub(crate) fn open(&self, file: &dyn FileAccess) -> Result<Box<dyn Frames>, MediaError> {
        Ok(match &self.route {
            Route::WavePcm { layout, pcm } => {
                Box::new(WavePcmFrames::open(file, layout, *pcm).map_err(MediaError::Read)?)
            }
            Route::IsoPcm(track) => Box::new(PcmFrames::open(file, track).map_err(MediaError::Read)?),
            Route::Ffmpeg { program, path, audio_index } => {
                Box::new(FfmpegFrames::spawn(program, path, *audio_index).map_err(|error| self.ffmpeg_error(error))?)
            }
            Route::Memory(samples) => Box::new(SampleFrames::of(samples)),
            Route::Decoded(sound) => Box::new(DecodedFrames::open(sound).map_err(MediaError::Read)?),
            route => {
                let frames = native_frames(file, self.container, route);
                let frames = frames.map_err(|error| native_error(error, self.container))?;
                Box::new(match self.format {
                    Some((sample_rate_hz, channel_count)) => frames.with_format(sample_rate_hz, channel_count),
                    None => frames,
                })
            }
        })
    }

    /// The length of which a part is missing. An estimate alone proves no loss, but it shows how much a decoder lost that complained.
    pub(crate) fn short_of_s(&self, decoded_s: f64, has_complaint: bool) -> Option<f64> {
        let declared_s = self.declared_s.filter(|declared_s| decoded_s + self.declared_slack_s < *declared_s);
        let estimated_s = self.approximate_s.filter(|_| has_complaint && self.declared_s.is_none());
        declared_s.or(estimated_s.filter(|estimated_s| decoded_s < LOST_SHARE * estimated_s))
    }

    fn ffmpeg_error(&self, error: FfmpegError) -> MediaError {
        let (container, codec) = (self.container, self.codec.clone());
        match error {
            FfmpegError::NotFound(error) => MediaError::NeedsFfmpeg { container, codec, why: not_started(&error) },
            FfmpegError::Failed(message) => MediaError::FfmpegFailed { container, codec, message },
        }
    }
}

fn native_frames(file: &dyn FileAccess, container: Container, route: &Route) -> Result<NativeFrames, SymphoniaError> {
    match route {
        Route::WaveBlocks { layout, codec } => NativeFrames::from_wave(file, layout, *codec),
        Route::IsoTable(track) => NativeFrames::from_iso_table(file, track),
        Route::Demuxer { base, patches, track_id, has_gapless_packets } => {
            let reader = native::open_demuxer(file, container, *base, patches)?;
            let frames = NativeFrames::from_demuxer(reader, *track_id, *has_gapless_packets)?;
            Ok(frames.with_gap_s_min(gap_s_min(container)))
        }
        Route::WavePcm { .. } | Route::IsoPcm(_) | Route::Ffmpeg { .. } | Route::Memory(_) | Route::Decoded(_) => {
            Err(SymphoniaError::Unsupported("not a route of packets"))
        }
    }
}

/// Smallest jump of the packet times that means missing sound. FLAC numbers its frames. The times of Matroska are rounded to
/// milliseconds, and live recorders let them jitter by a packet or two. In other containers the demuxer invents the times.
fn gap_s_min(container: Container) -> Option<f64> {
    match container {
        Container::Flac => Some(0.001),
        Container::Matroska | Container::WebM => Some(0.15),
        _ => None,
    }
}

/// A plan whose first packets decode, with the start time of the first.
pub(crate) struct Settled {
    pub(crate) plan: Plan,
    pub(crate) sample_rate_hz: f64,
    pub(crate) first_packet_s: f64,
}

/// Decodes the first packets of a track, so that the format in the plan is correct.
pub(crate) fn settle(file: &dyn FileAccess, plan: Plan) -> Result<Settled, NotNative> {
    if let Route::Decoded(DecodedSound { sample_rate_hz, first_packet_s, .. }) = plan.route {
        return Ok(Settled { plan, sample_rate_hz, first_packet_s });
    }
    let container = plan.container;
    let mut frames =
        native_frames(file, container, &plan.route).map_err(|error| NotNative::from_symphonia(error, container))?;
    let first_packet_s = frames
        .settle_format(BAD_PACKETS_AT_START_MAX)
        .map_err(|error| NotNative::Error(MediaError::Read(error)))?
        .ok_or_else(|| {
            let why = "none of the first pieces of its sound can be decoded".to_owned();
            NotNative::Error(MediaError::Damaged { container, why })
        })?;
    let format = Some(frames.format());
    Ok(Settled { plan: Plan { format, ..plan }, sample_rate_hz: frames.sample_rate_hz(), first_packet_s })
}

/// Reason why hovertone does not decode a track itself.
#[derive(Debug)]
pub(crate) enum NotNative {
    /// No decoder; ffmpeg can have one.
    Unsupported,
    /// Damage.
    Error(MediaError),
}

impl NotNative {
    pub(crate) fn from_symphonia(error: SymphoniaError, container: Container) -> Self {
        match error {
            SymphoniaError::Unsupported(_) => Self::Unsupported,
            error => Self::Error(native_error(error, container)),
        }
    }
}

pub(crate) fn native_error(error: SymphoniaError, container: Container) -> MediaError {
    match error {
        SymphoniaError::IoError(error) if error.raw_os_error().is_some() => MediaError::Read(error),
        error => MediaError::Damaged { container, why: damage_in_words(&error).to_owned() },
    }
}

/// What is wrong with a file, in place of the words of the decoder, which are for its programmers. Reads that fail for another reason
/// than the content have an error of their own (`FileAccess::failure`, `native_error`).
pub(crate) fn damage_in_words(error: &SymphoniaError) -> &'static str {
    match error {
        SymphoniaError::IoError(error) => match error.kind() {
            ErrorKind::UnexpectedEof => "its header is incomplete",
            ErrorKind::InvalidInput => "it points to a place outside of the file",
            ErrorKind::OutOfMemory => "a size in its header is impossible",
            _ => "its bytes do not follow the format",
        },
        SymphoniaError::Unsupported(_) => "it has a part that hovertone cannot read",
        SymphoniaError::LimitError(_) => "a size in its header is impossible",
        _ => "its bytes do not follow the format",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io;

    #[test]
    fn damage_has_its_own_reason_for_each_kind_of_read_that_fails() {
        let told = |kind: ErrorKind| damage_in_words(&SymphoniaError::IoError(io::Error::from(kind)));
        assert_eq!(told(ErrorKind::UnexpectedEof), "its header is incomplete");
        assert_eq!(told(ErrorKind::InvalidInput), "it points to a place outside of the file");
        assert_eq!(told(ErrorKind::OutOfMemory), "a size in its header is impossible");
        assert_eq!(told(ErrorKind::Other), "its bytes do not follow the format");
        let damaged = native_error(SymphoniaError::IoError(ErrorKind::InvalidInput.into()), Container::Mp4);
        assert!(damaged.to_string().contains("is damaged: it points to"), "{damaged}");
    }
}
