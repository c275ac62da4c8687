//! The sample description of a sound track: codec, rate, channels, and the layout of uncompressed samples.
//!
//! ISO/IEC 14496-12 section 12.2.3 (AudioSampleEntry) and QuickTime File Format, "Sound sample descriptions", whose
//! versions 1 and 2 put more fields in front of the extensions. After the 8 bytes of the box header an entry holds, with
//! offsets from there: reserved (0), data reference index (6), version (8), revision and vendor (10), channels (16), bits
//! (18), compression id (20), packet size (22), rate as 16.16 (24); version 1 adds four 32-bit numbers (28), version 2 a
//! 64-bit float rate (32), a 32-bit channel count (40) and the stream description of `lpcm` (48).

use super::QuicktimeError;
use super::aac_config::{AudioSpecificConfig, Esds, audio_specific_config, esds_from_payload};
use super::boxes::{Boxes, FourCc, be_u16, be_u32, be_u64};
use crate::pcm_layout::{PcmKind, PcmLayout};

/// Fields in front of the extensions in version 0 and in an ISO entry.
const FIXED_LEN: usize = 28;

/// Content of a sound sample description.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct SoundDescription {
    pub(super) codec: FourCc,
    /// Index into the data references, from 1.
    pub(super) data_reference: u16,
    /// Sample rate; zero where the entry has no room for it (from 65 536 Hz on).
    pub(super) rate_hz: f64,
    pub(super) channel_count: u16,
    pub(super) pcm: Option<PcmLayout>,
    /// QuickTime version 1 with constant packets: frames and bytes (of all channels) of a packet.
    pub(super) packet: Option<(u32, u32)>,
    pub(super) esds: Option<Esds>,
    pub(super) aac: Option<AudioSpecificConfig>,
    /// Configuration of the decoder: see `AudioTrack::codec_config`.
    pub(super) codec_config: Vec<u8>,
}

/// Reads the first entry of `stsd`.
pub(super) fn description_from_stsd(stsd: &[u8]) -> Result<SoundDescription, QuicktimeError> {
    let damaged = QuicktimeError::Damaged { what: "the sample description of a sound track (stsd)" };
    let Some(entry) = Boxes::new(stsd.get(8..).unwrap_or_default()).next() else { return Err(damaged) };
    let (codec, entry) = entry?;
    let stsd_version = stsd.first().copied().unwrap_or(0);
    description_from_entry(codec, entry, stsd_version).ok_or(damaged)
}

fn description_from_entry(codec: FourCc, entry: &[u8], stsd_version: u8) -> Option<SoundDescription> {
    // Version 1 of ISO (for rates above 65 535 Hz) adds no fields; the version of `stsd` identifies it.
    let version = if stsd_version == 0 { be_u16(entry, 8)? } else { 0 };
    let mut found = SoundDescription {
        codec,
        data_reference: be_u16(entry, 6)?,
        channel_count: be_u16(entry, 16)?,
        // 16.16 fixed point.
        rate_hz: f64::from(be_u32(entry, 24)?) / 65_536.0,
        ..SoundDescription::default()
    };
    let bits = be_u16(entry, 18)?;
    let is_variable = be_u16(entry, 20)? == 0xfffe;
    let mut stream = None;
    let extensions_at = match version {
        1 => {
            let packet = (be_u32(entry, 28)?, be_u32(entry, 36)?);
            found.packet = (!is_variable && packet.0 > 0 && packet.1 > 0).then_some(packet);
            FIXED_LEN + 16
        }
        2 => {
            found.rate_hz = f64::from_bits(be_u64(entry, 32)?);
            found.channel_count = u16::try_from(be_u32(entry, 40)?).unwrap_or(u16::MAX);
            stream = Some(StreamDescription {
                bits: be_u32(entry, 48)?,
                flags: be_u32(entry, 52)?,
                packet_bytes: be_u32(entry, 56)?,
                packet_frames: be_u32(entry, 60)?,
            });
            // sizeOfStructOnly counts from the start of the box, its header of 8 included.
            let stated = usize::try_from(be_u32(entry, 28)?).ok()?.checked_sub(8)?;
            if (FIXED_LEN + 36..=entry.len()).contains(&stated) { stated } else { FIXED_LEN + 36 }
        }
        _ => FIXED_LEN,
    };
    if !found.rate_hz.is_finite() || found.rate_hz < 0.0 {
        found.rate_hz = 0.0;
    }
    let extensions = Extensions::read(entry.get(extensions_at..).unwrap_or_default());
    if let Some(rate_hz) = extensions.rate_hz {
        found.rate_hz = f64::from(rate_hz);
    }
    found.pcm = match (&codec, stream) {
        (b"lpcm", Some(stream)) => stream.layout(found.channel_count),
        _ => layout_of_codec(codec, bits, &extensions),
    };
    found.take_codec_config(extensions);
    Some(found)
}

impl SoundDescription {
    /// Sets the configuration of the decoder, and corrects rate and channels by it: muxers write 2 channels into every entry.
    fn take_codec_config(&mut self, extensions: Extensions<'_>) {
        let esds = extensions.esds.and_then(esds_from_payload);
        match (&self.codec, extensions.config) {
            (b"Opus", Some(config)) => {
                self.codec_config = config.to_vec();
                self.rate_hz = 48_000.0;
                self.correct_channels(config.get(1).map(|count| u16::from(*count)));
            }
            (b"alac", Some(config)) => {
                // Version and flags, then the 24 bytes of ALACSpecificConfig.
                let cookie = config.get(4..28).unwrap_or_default();
                self.codec_config = cookie.to_vec();
                self.correct_rate(be_u32(cookie, 20));
                self.correct_channels(cookie.get(9).map(|count| u16::from(*count)));
            }
            (b"fLaC", Some(config)) => {
                // Version and flags, the header of the first metadata block, the 34 bytes of STREAMINFO.
                let stream_info = config.get(8..42).unwrap_or_default();
                self.codec_config = stream_info.to_vec();
                // 20 bits of rate, 3 bits of channels less one.
                self.correct_rate(be_u32(stream_info, 10).map(|word| word >> 12));
                self.correct_channels(stream_info.get(12).map(|byte| u16::from(byte >> 1 & 7) + 1));
            }
            (_, Some(config)) => self.codec_config = config.to_vec(),
            (_, None) => {
                if let Some(esds) = &esds {
                    self.codec_config.clone_from(&esds.specific);
                }
            }
        }
        if let Some(esds) = &esds
            && matches!(esds.object_type, 0x40 | 0x66..=0x68)
        {
            self.aac = audio_specific_config(&esds.specific);
            let count = self.aac.map(|aac| if aac.has_parametric_stereo { 2 } else { aac.channel_count });
            self.correct_channels(count);
        }
        self.esds = esds;
    }

    fn correct_rate(&mut self, rate_hz: Option<u32>) {
        if let Some(rate_hz) = rate_hz.filter(|rate_hz| *rate_hz > 0) {
            self.rate_hz = f64::from(rate_hz);
        }
    }

    fn correct_channels(&mut self, count: Option<u16>) {
        if let Some(count) = count.filter(|count| *count > 0) {
            self.channel_count = count;
        }
    }
}

/// The boxes behind the fields of an entry, those inside `wave` included.
#[derive(Default)]
struct Extensions<'a> {
    /// `srat`: the rate of an ISO version 1 entry.
    rate_hz: Option<u32>,
    /// `enda`: 1 for little endian.
    is_little_endian: Option<bool>,
    /// `pcmC`: little endian, bits of a sample.
    pcm: Option<(bool, u8)>,
    esds: Option<&'a [u8]>,
    config: Option<&'a [u8]>,
}

impl<'a> Extensions<'a> {
    /// Stops at the first damaged box: old writers leave other bytes behind the last one.
    fn read(bytes: &'a [u8]) -> Self {
        let mut found = Self::default();
        for (kind, content) in Boxes::new(bytes).map_while(Result::ok) {
            if &kind == b"wave" {
                for (kind, content) in Boxes::new(content).map_while(Result::ok) {
                    found.take(kind, content);
                }
            } else {
                found.take(kind, content);
            }
        }
        found
    }

    fn take(&mut self, kind: FourCc, content: &'a [u8]) {
        match &kind {
            b"srat" => self.rate_hz = be_u32(content, 4),
            // Two bytes; some writers put the 1 into the first.
            b"enda" => self.is_little_endian = be_u16(content, 0).map(|value| value != 0),
            b"pcmC" => self.pcm = content.get(4).map(|flags| flags & 1 == 1).zip(content.get(5).copied()),
            b"esds" => self.esds = Some(content),
            // `alac` is both a codec and the box of its configuration; inside `wave` it may also be an empty marker.
            b"alac" | b"dOps" | b"dfLa" | b"dac3" | b"dec3" | b"damr" if content.len() > 4 => {
                self.config = Some(content)
            }
            _ => {}
        }
    }
}

/// Core Audio's description of linear PCM, as version 2 entries carry it.
#[derive(Clone, Copy)]
struct StreamDescription {
    bits: u32,
    flags: u32,
    packet_bytes: u32,
    packet_frames: u32,
}

impl StreamDescription {
    /// Flags: 1 float, 2 big endian, 4 signed, 8 packed, 16 aligned high, 32 a plane per channel (not read).
    fn layout(self, channel_count: u16) -> Option<PcmLayout> {
        let is_little_endian = self.flags & 2 == 0;
        let frame_bytes = self.packet_bytes / self.packet_frames.max(1);
        let stated = frame_bytes / u32::from(channel_count).max(1);
        let least = self.bits.div_ceil(8);
        let sample_bytes = u8::try_from(if stated >= least { stated } else { least }).ok()?;
        if self.flags & 32 != 0 || self.bits == 0 {
            return None;
        }
        if self.flags & 1 != 0 {
            return PcmLayout::float(sample_bytes, is_little_endian);
        }
        if self.flags & 4 == 0 {
            // Unsigned is only known at 8 bits.
            return (sample_bytes == 1).then(PcmLayout::unsigned_8);
        }
        let layout = PcmLayout::signed(sample_bytes, is_little_endian)?;
        let is_low = self.flags & (8 | 16) == 0;
        let spare = u8::try_from(u32::from(sample_bytes) * 8 - self.bits).unwrap_or(0);
        Some(PcmLayout { empty_high_bits: if is_low { spare } else { 0 }, ..layout })
    }
}

/// The layout that the name of a codec stands for. `bits` is the field of the entry, which is 16 for wider samples too.
fn layout_of_codec(codec: FourCc, bits: u16, extensions: &Extensions<'_>) -> Option<PcmLayout> {
    let little = extensions.is_little_endian.unwrap_or(false);
    let integer_bytes =
        |least: u8| u8::try_from(bits / 8).ok().filter(|bytes| (1..=4).contains(bytes)).unwrap_or(least);
    match &codec {
        b"sowt" => PcmLayout::signed(integer_bytes(2), true),
        b"twos" => PcmLayout::signed(integer_bytes(2), little),
        b"raw " | b"NONE" | [0, 0, 0, 0] if bits <= 8 => Some(PcmLayout::unsigned_8()),
        b"raw " | b"NONE" | [0, 0, 0, 0] => PcmLayout::signed(integer_bytes(2), little),
        b"in24" => PcmLayout::signed(3, little),
        b"in32" => PcmLayout::signed(4, little),
        b"fl32" => PcmLayout::float(4, little),
        b"fl64" => PcmLayout::float(8, little),
        b"lpcm" => PcmLayout::signed(integer_bytes(2), little),
        b"ulaw" => Some(PcmLayout::companded(PcmKind::MuLaw)),
        b"alaw" => Some(PcmLayout::companded(PcmKind::ALaw)),
        b"ipcm" => extensions.pcm.and_then(|(little, bits)| PcmLayout::signed(bits.div_ceil(8), little)),
        b"fpcm" => extensions.pcm.and_then(|(little, bits)| PcmLayout::float(bits.div_ceil(8), little)),
        _ => None,
    }
}

#[cfg(test)]
#[path = "sound_description_tests.rs"]
mod tests;
