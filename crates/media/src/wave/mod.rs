//! RIFF/WAVE, RF64 and Wave64: position and coding of the samples. The length of the file has priority over the header.
//!
//! Symphonia's own reader trusts the sizes in the header. They are wrong in files of recorders that lost power, of pipes and of truncated
//! copies.

mod blocks;

pub(crate) use blocks::{WaveBlocks, WavePcmFrames};

use std::io::{self, Read, Seek, SeekFrom};

use symphonia::core::audio::Channels;
use symphonia::core::codecs::audio::well_known::{CODEC_ID_ADPCM_IMA_WAV, CODEC_ID_ADPCM_MS};
use symphonia::core::codecs::audio::{AudioCodecId, AudioCodecParameters};

use crate::container::Container;
use crate::error::MediaError;
use crate::pcm_layout::{PcmKind, PcmLayout};

/// Approximate number of frames per read.
const PACKET_FRAMES: u64 = 4096;

/// Sizes from here on mean an unknown length: ffmpeg writes `0xffffffff`, sox and arecord a little below or at 2 GiB.
const UNKNOWN_SIZE_MIN: u64 = 0x7fff_0000;

const CHANNEL_COUNT_MAX: u64 = 256;
const SAMPLE_RATE_HZ_MAX: u64 = 16_000_000;

/// Facts from the header, corrected by the length of the file.
#[derive(Clone, Debug)]
pub(crate) struct WaveLayout {
    pub(crate) codec: WaveCodec,
    pub(crate) sample_rate_hz: u32,
    pub(crate) channel_count: u16,
    block_bytes: u64,
    block_frames: u64,
    data_at: u64,
    /// Existing bytes of samples.
    data_bytes: u64,
    /// Stated bytes of samples, unless the number is a placeholder.
    declared_bytes: Option<u64>,
    /// Stated and real size, where the sound continues behind the stated size or the size is a placeholder.
    pub(crate) wrong_size: Option<(u64, u64)>,
}

/// Coding of the samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WaveCodec {
    /// Uncompressed samples.
    Pcm(PcmLayout),
    /// Blocks that Symphonia decodes.
    Blocks(AudioCodecId, &'static str),
    /// A code that only ffmpeg can know.
    Foreign(u16),
}

impl WaveCodec {
    pub(crate) fn name(self) -> String {
        match self {
            Self::Pcm(layout) => layout.name().to_owned(),
            Self::Blocks(_, name) => name.to_owned(),
            Self::Foreign(code) => codec_name_from_code(code),
        }
    }
}

/// Name for people of a codec by its code in WAVE and AVI files.
pub(crate) fn codec_name_from_code(code: u16) -> String {
    let name = match code {
        0x0001 | 0x0003 => "PCM",
        0x0002 => "MS ADPCM",
        0x0006 => "A-law",
        0x0007 => "mu-law",
        0x0011 => "IMA ADPCM",
        0x0031 | 0x0032 => "GSM 6.10",
        0x0050 => "MPEG layer 2",
        0x0055 => "MP3",
        0x00ff | 0x1600..=0x1610 => "AAC",
        0x0161..=0x0163 => "WMA",
        0x2000 => "AC-3",
        0x2001 => "DTS",
        code => return format!("sound in an unknown codec (WAVE code 0x{code:04x})"),
    };
    name.to_owned()
}

impl WaveLayout {
    /// Number of frames that the header states, if it does.
    pub(crate) fn declared_frames(&self) -> Option<u64> {
        self.declared_bytes.map(|bytes| bytes / self.block_bytes * self.block_frames)
    }

    pub(crate) fn declared_duration_s(&self) -> f64 {
        let frames = self.declared_frames().unwrap_or(self.data_bytes / self.block_bytes * self.block_frames);
        frames as f64 / f64::from(self.sample_rate_hz)
    }

    /// Whether the file ends before the stated end of the sound.
    pub(crate) fn is_truncated(&self) -> bool {
        self.declared_bytes.is_some_and(|declared| self.data_bytes < declared)
    }

    pub(crate) fn codec_parameters(&self, codec: AudioCodecId) -> AudioCodecParameters {
        let mut parameters = AudioCodecParameters::new();
        parameters
            .for_codec(codec)
            .with_sample_rate(self.sample_rate_hz)
            .with_channels(Channels::Discrete(self.channel_count))
            .with_frames_per_block(self.block_frames)
            .with_max_frames_per_packet(self.packet_blocks() * self.block_frames);
        parameters
    }

    fn packet_blocks(&self) -> u64 {
        (PACKET_FRAMES / self.block_frames).max(1)
    }
}

/// Reads the chunks up to the samples.
pub(crate) fn layout_from_header<R: Read + Seek>(
    reader: &mut R,
    container: Container,
) -> Result<WaveLayout, MediaError> {
    let file_bytes = reader.seek(SeekFrom::End(0)).map_err(MediaError::Read)?;
    let is_w64 = container == Container::W64;
    let (mut at, id_bytes, head_bytes) = if is_w64 { (40_u64, 16_usize, 24_u64) } else { (12, 4, 8) };
    let mut format = None;
    let mut long_data_bytes = None;

    while at.checked_add(head_bytes).is_some_and(|end| end <= file_bytes) {
        reader.seek(SeekFrom::Start(at)).map_err(MediaError::Read)?;
        let mut head = vec![0; head_bytes as usize];
        reader.read_exact(&mut head).map_err(MediaError::Read)?;
        let mut id = [0; 4];
        id.copy_from_slice(&head[..4]);
        let size = if is_w64 {
            // the size in Wave64 includes the header of the chunk
            u64_le(&head, id_bytes).unwrap_or(0).saturating_sub(head_bytes)
        } else {
            u64::from(u32_le(&head, 4).unwrap_or(0))
        };
        let body_at = at + head_bytes;
        match &id {
            b"fmt " => {
                let mut body = Vec::new();
                reader.by_ref().take(size.min(64)).read_to_end(&mut body).map_err(MediaError::Read)?;
                format = Some(Format::from_chunk(&body, container)?);
            }
            b"ds64" => {
                let mut body = Vec::new();
                reader.by_ref().take(size.min(28)).read_to_end(&mut body).map_err(MediaError::Read)?;
                long_data_bytes = u64_le(&body, 8);
            }
            b"data" => {
                let Some(format) = format else {
                    return Err(damaged(container, "its sound comes before the description of its format"));
                };
                let declared = match long_data_bytes {
                    Some(long) if size == 0xffff_ffff => long,
                    _ => size,
                };
                let rest = file_bytes - body_at;
                return layout_from_data(format, body_at, declared, rest, reader, container);
            }
            _ => {}
        }
        // chunks are padded: to 2 bytes in RIFF, to 8 in Wave64
        let align = if is_w64 { 8 } else { 2 };
        at = match size.checked_next_multiple_of(align).and_then(|size| body_at.checked_add(size)) {
            Some(next) => next,
            None => break,
        };
    }
    Err(match format {
        Some(_) => MediaError::NoSamples { container, why: "it ends before its data chunk".to_owned() },
        None => damaged(container, "it has no description of its sample format"),
    })
}

fn layout_from_data<R: Read + Seek>(
    format: Format,
    data_at: u64,
    declared: u64,
    rest: u64,
    reader: &mut R,
    container: Container,
) -> Result<WaveLayout, MediaError> {
    if rest == 0 || (declared == 0 && next_chunk_is_known(reader, data_at)) {
        return Err(MediaError::NoSamples { container, why: "its data chunk is empty".to_owned() });
    }
    let is_placeholder =
        declared == 0 || (declared >= UNKNOWN_SIZE_MIN && declared <= u64::from(u32::MAX) && declared > rest);
    let layout = WaveLayout {
        codec: format.codec,
        sample_rate_hz: format.sample_rate_hz,
        channel_count: format.channel_count,
        block_bytes: format.block_bytes,
        block_frames: format.block_frames,
        data_at,
        data_bytes: if is_placeholder { rest } else { declared.min(rest) },
        declared_bytes: (!is_placeholder).then_some(declared),
        wrong_size: is_placeholder.then_some((declared, rest)),
    };
    if layout.data_bytes < layout.block_bytes {
        let follow = if layout.data_bytes == 1 { "byte follows" } else { "bytes follow" };
        let why = format!("only {} {follow} the header, less than one audio sample", layout.data_bytes);
        return Err(MediaError::NoSamples { container, why });
    }
    Ok(layout)
}

/// Whether an empty data chunk is followed by another chunk, and is therefore really empty.
fn next_chunk_is_known<R: Read + Seek>(reader: &mut R, at: u64) -> bool {
    let mut id = [0; 4];
    reader.seek(SeekFrom::Start(at)).and_then(|_| reader.read_exact(&mut id)).is_ok()
        && matches!(
            &id,
            b"LIST" | b"id3 " | b"ID3 " | b"bext" | b"iXML" | b"fact" | b"cue " | b"smpl" | b"_PMX" | b"JUNK"
        )
}

#[derive(Clone, Copy)]
struct Format {
    codec: WaveCodec,
    sample_rate_hz: u32,
    channel_count: u16,
    block_bytes: u64,
    block_frames: u64,
}

impl Format {
    /// The `fmt ` chunk: WAVEFORMAT, WAVEFORMATEX or WAVEFORMATEXTENSIBLE.
    fn from_chunk(body: &[u8], container: Container) -> Result<Self, MediaError> {
        let (Some(tag), Some(channel_count), Some(sample_rate_hz), Some(block_bytes), Some(bits)) =
            (u16_le(body, 0), u16_le(body, 2), u32_le(body, 4), u16_le(body, 12), u16_le(body, 14))
        else {
            return Err(damaged(container, "the description of its sample format is too short"));
        };
        let tag = match (tag, u16_le(body, 24)) {
            (0xfffe, Some(sub_format)) => sub_format,
            _ => tag,
        };
        let bad = |field, value: u64, limit| Err(MediaError::BadHeader { container, field, value, limit });
        if channel_count == 0 || u64::from(channel_count) > CHANNEL_COUNT_MAX {
            return bad("the number of channels", channel_count.into(), "1 to 256");
        }
        if sample_rate_hz == 0 || u64::from(sample_rate_hz) > SAMPLE_RATE_HZ_MAX {
            return bad("the sample rate", sample_rate_hz.into(), "1 Hz to 16 MHz");
        }
        let channels = u64::from(channel_count);
        let block_bytes = u64::from(block_bytes);
        // The container of a sample is the block divided by the channels. Its bits can be fewer (12 of 16), and stand at the top.
        let sample_bytes = match block_bytes / channels {
            0 => u64::from(bits.div_ceil(8)),
            bytes => bytes,
        };
        let pcm = match (tag, u8::try_from(sample_bytes).unwrap_or(u8::MAX)) {
            (1, 1) => Some(PcmLayout::unsigned_8()),
            (1, bytes) => PcmLayout::signed(bytes, true),
            (3, bytes) => PcmLayout::float(bytes, true),
            (6, _) => Some(PcmLayout::companded(PcmKind::ALaw)),
            (7, _) => Some(PcmLayout::companded(PcmKind::MuLaw)),
            _ => None,
        };
        if let Some(pcm) = pcm {
            let block_bytes = u64::from(pcm.sample_bytes) * channels;
            return Ok(Self {
                codec: WaveCodec::Pcm(pcm),
                sample_rate_hz,
                channel_count,
                block_bytes,
                block_frames: 1,
            });
        }
        match tag {
            1 | 3 => bad(
                "the number of bytes of an audio sample",
                sample_bytes,
                "1 to 4 for whole numbers, or 4 or 8 for floating point",
            ),
            2 | 0x11 if channel_count <= 2 && bits == 4 => {
                let (id, name, head, head_frames) = if tag == 2 {
                    (CODEC_ID_ADPCM_MS, "MS ADPCM", 7, 2)
                } else {
                    (CODEC_ID_ADPCM_IMA_WAV, "IMA ADPCM", 4, 1)
                };
                let Some(coded) = block_bytes.checked_sub(head * channels) else {
                    return bad("the number of bytes of a block", block_bytes, "enough for the header of a block");
                };
                let block_frames = coded * 2 / channels + head_frames;
                Ok(Self {
                    codec: WaveCodec::Blocks(id, name),
                    sample_rate_hz,
                    channel_count,
                    block_bytes,
                    block_frames,
                })
            }
            _ => Ok(Self {
                codec: WaveCodec::Foreign(tag),
                sample_rate_hz,
                channel_count,
                block_bytes: block_bytes.max(1),
                block_frames: 1,
            }),
        }
    }
}

/// Sample rate and channels from the header of a 32-bit float WAVE in a pipe. Afterwards the reader is at the samples.
pub(crate) fn float_stream_header<R: Read>(reader: &mut R) -> io::Result<Option<(u32, u16)>> {
    let mut head = [0; 12];
    reader.read_exact(&mut head)?;
    let mut found = None;
    loop {
        let mut chunk = [0; 8];
        reader.read_exact(&mut chunk)?;
        let size = u64::from(u32_le(&chunk, 4).unwrap_or(0));
        if chunk.starts_with(b"data") {
            return Ok(found);
        }
        let mut body = Vec::new();
        reader.by_ref().take(size.min(1 << 20)).read_to_end(&mut body)?;
        if chunk.starts_with(b"fmt ") {
            found = Format::from_chunk(&body, Container::Wav)
                .ok()
                .map(|format| (format.sample_rate_hz, format.channel_count));
        }
    }
}

fn damaged(container: Container, why: &str) -> MediaError {
    MediaError::Damaged { container, why: why.to_owned() }
}

fn u16_le(bytes: &[u8], at: usize) -> Option<u16> {
    bytes.get(at..)?.first_chunk().map(|bytes| u16::from_le_bytes(*bytes))
}

fn u32_le(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().map(|bytes| u32::from_le_bytes(*bytes))
}

fn u64_le(bytes: &[u8], at: usize) -> Option<u64> {
    bytes.get(at..)?.first_chunk().map(|bytes| u64::from_le_bytes(*bytes))
}
