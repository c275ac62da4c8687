//! The packets of sound that this crate cannot decode, for a decoder of the program around it, such as that of a browser.

use std::io;

use symphonia::core::units::TimeBase;

use crate::container::{Container, Sniffed};
use crate::file_access::FileAccess;
use crate::frames::Incidents;
use crate::iso::TablePackets;
use crate::matroska::Matroska;
use crate::native::{self, seconds_from_ticks};
use crate::packets::PacketSource;
use crate::quicktime::Movie;
use crate::source::Patch;

/// Object type of MPEG-4 audio in MP4 (ISO/IEC 14496-1, 7.2.6.6).
const MPEG_4_AUDIO: u8 = 0x40;

/// What a decoder has to know of a track.
#[derive(Clone, Debug, PartialEq)]
pub struct CodedFormat {
    /// The codec by its name in RFC 6381, such as `mp4a.40.2`.
    pub codec: String,
    /// Configuration of the decoder. AAC: AudioSpecificConfig.
    pub description: Vec<u8>,
    /// Samples per second and channel, by the header.
    pub sample_rate_hz: f64,
    /// Number of channels, by the header.
    pub channel_count: usize,
}

/// A packet of coded sound.
#[derive(Clone, Debug, PartialEq)]
pub struct CodedPacket {
    /// Time of its first sample on the clock of the track.
    pub at_s: f64,
    /// Its bytes.
    pub data: Box<[u8]>,
}

/// The packets of a track that this crate cannot decode, one after the other: memory does not grow with their number.
pub struct CodedSound {
    format: CodedFormat,
    packets: PacketSource,
    time_base: Option<TimeBase>,
}

impl CodedSound {
    pub(crate) fn of_iso(file: &dyn FileAccess, container: Container, movie: &Movie) -> Option<Self> {
        let track = movie.tracks.first().filter(|track| track.mp4_object_type == Some(MPEG_4_AUDIO))?;
        let format = CodedFormat {
            codec: aac_name(&track.codec_config)?,
            description: track.codec_config.clone(),
            sample_rate_hz: track.sample_rate_hz,
            channel_count: usize::from(track.channel_count),
        };
        if movie.is_fragmented {
            return Self::of_demuxer(file, container, &[], track.track_id, format);
        }
        let packets = PacketSource::IsoTable(TablePackets::open(file, track).ok()?);
        Some(Self { format, packets, time_base: TimeBase::try_from_recip(track.timescale_hz) })
    }

    pub(crate) fn of_matroska(file: &dyn FileAccess, container: Container, matroska: &Matroska) -> Option<Self> {
        let track = matroska.audio_tracks.first().filter(|track| track.codec_id == "A_AAC")?;
        let format = CodedFormat {
            codec: aac_name(&track.codec_private)?,
            description: track.codec_private.clone(),
            sample_rate_hz: track.output_rate_hz,
            channel_count: track.channel_count,
        };
        Self::of_demuxer(file, container, &matroska.patches, u32::try_from(track.number).ok()?, format)
    }

    pub(crate) fn of_adts(file: &dyn FileAccess, sniffed: &Sniffed, track_id: u32) -> Option<Self> {
        let description = sniffed.mpeg.as_ref()?.aac_config?.to_vec();
        let reader = native::open_demuxer(file, sniffed.container, sniffed.base, &[]).ok()?;
        let track = reader.tracks().iter().find(|track| track.id == track_id)?;
        let parameters = native::audio_parameters(track)?;
        let format = CodedFormat {
            codec: aac_name(&description)?,
            description,
            sample_rate_hz: f64::from(parameters.sample_rate?),
            channel_count: parameters.channels.as_ref()?.count(),
        };
        let time_base = track.time_base;
        Some(Self { format, packets: PacketSource::of_demuxer(reader, track_id), time_base })
    }

    fn of_demuxer(
        file: &dyn FileAccess,
        container: Container,
        patches: &[Patch],
        track_id: u32,
        format: CodedFormat,
    ) -> Option<Self> {
        let reader = native::open_demuxer(file, container, 0, patches).ok()?;
        let time_base = reader.tracks().iter().find(|track| track.id == track_id)?.time_base;
        Some(Self { format, packets: PacketSource::of_demuxer(reader, track_id), time_base })
    }

    /// What the decoder has to know.
    pub fn format(&self) -> &CodedFormat {
        &self.format
    }

    /// The next packet; `None` after the last one.
    ///
    /// # Errors
    /// The file cannot be read on.
    pub fn next_packet(&mut self) -> io::Result<Option<CodedPacket>> {
        let packet = self.packets.next_packet(&mut Incidents::default())?;
        Ok(packet.map(|packet| CodedPacket {
            at_s: seconds_from_ticks(packet.pts.get(), self.time_base),
            data: packet.data,
        }))
    }
}

/// Name of AAC in RFC 6381, by the object type in its AudioSpecificConfig (ISO/IEC 14496-3, 1.6.2.1).
fn aac_name(config: &[u8]) -> Option<String> {
    const ESCAPE: u8 = 31;
    let (first, second) = (*config.first()?, config.get(1).copied().unwrap_or_default());
    let object_type = match first >> 3 {
        ESCAPE => 32 + (((first & 7) << 3) | (second >> 5)),
        object_type => object_type,
    };
    Some(format!("mp4a.40.{object_type}"))
}
