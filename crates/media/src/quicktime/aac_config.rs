//! Content of an `esds` box about an AAC stream, and whether a decoder without SBR plays it at half rate.
//!
//! The box holds MPEG-4 descriptors (ISO/IEC 14496-1 section 7.2.6) around the AudioSpecificConfig (ISO/IEC 14496-3
//! section 1.6.2.1). HE-AAC stores a core at half the rate of the sound and the upper half of the band as side
//! information (SBR, spectral band replication). It is signalled in three ways: an object type of its own (5 for SBR, 29
//! for SBR with parametric stereo), an extension behind a plain AAC configuration (sync word 0x2b7), or not at all.

use super::boxes::be_u16;

/// An HE-AAC track. A decoder that ignores SBR produces `core_rate_hz` and nothing above half of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HalfRateAac {
    /// Rate of the AAC core, the output rate of a decoder without SBR.
    pub(crate) core_rate_hz: f64,
    /// Rate of the recorded sound, the output rate of a decoder with SBR.
    pub(crate) output_rate_hz: f64,
    /// Parametric stereo: two channels from one coded channel. A decoder without it produces one channel.
    pub(crate) has_parametric_stereo: bool,
}

/// The audio descriptors of an `esds` box.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Esds {
    /// objectTypeIndication: 0x40 MPEG-4 AAC, 0x66 to 0x68 MPEG-2 AAC, 0x69 and 0x6b MP3.
    pub(super) object_type: u8,
    /// DecoderSpecificInfo, for AAC the AudioSpecificConfig.
    pub(super) specific: Vec<u8>,
}

/// The fields of an AudioSpecificConfig that matter here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct AudioSpecificConfig {
    pub(super) core_rate_hz: u32,
    /// Channel configuration 1 to 8, or 0 where the stream itself defines it.
    pub(super) channel_count: u16,
    pub(super) spectral_band: SpectralBand,
    pub(super) has_parametric_stereo: bool,
}

/// Signalling of SBR in the configuration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SpectralBand {
    /// Not mentioned: the track can still use it.
    Unsaid,
    /// Stated to be absent.
    Absent,
    /// Present, with the rate of the decoded sound.
    Present { output_rate_hz: u32 },
}

impl AudioSpecificConfig {
    /// The half-rate reading of this configuration in a track whose sample entry says `container_rate_hz`.
    ///
    /// `None` for plain AAC and for SBR that keeps the core's rate.
    pub(super) fn half_rate(&self, container_rate_hz: f64) -> Option<HalfRateAac> {
        let core_rate_hz = f64::from(self.core_rate_hz);
        let output_rate_hz = match self.spectral_band {
            SpectralBand::Present { output_rate_hz } => f64::from(output_rate_hz),
            SpectralBand::Unsaid if (container_rate_hz - 2.0 * core_rate_hz).abs() < 1.0 => container_rate_hz,
            SpectralBand::Unsaid | SpectralBand::Absent => core_rate_hz,
        };
        (output_rate_hz > core_rate_hz).then_some(HalfRateAac {
            core_rate_hz,
            output_rate_hz,
            has_parametric_stereo: self.has_parametric_stereo,
        })
    }
}

/// Reads the payload of an `esds` box (version and flags first). `None` where the descriptors are damaged.
pub(super) fn esds_from_payload(payload: &[u8]) -> Option<Esds> {
    let es = descriptor(payload.get(4..)?, 0x03)?;
    let flags = *es.get(2)?;
    let mut at = 3_usize;
    if flags & 0x80 != 0 {
        at += 2; // dependsOn_ES_ID
    }
    if flags & 0x40 != 0 {
        at += 1 + usize::from(*es.get(at)?); // URL
    }
    if flags & 0x20 != 0 {
        at += 2; // OCR_ES_Id
    }
    let decoder = descriptor(es.get(at..)?, 0x04)?;
    let object_type = *decoder.first()?;
    // Stream type, buffer size and two bit rates take 12 bytes. MP3 in MP4 has no specific part.
    let specific = decoder.get(13..).and_then(|rest| descriptor(rest, 0x05)).unwrap_or_default().to_vec();
    Some(Esds { object_type, specific })
}

/// The body of the descriptor with tag `wanted` that `bytes` starts with. Its size takes one to four bytes of 7 bits.
fn descriptor(bytes: &[u8], wanted: u8) -> Option<&[u8]> {
    if *bytes.first()? != wanted {
        return None;
    }
    let mut len = 0_usize;
    for at in 1..=4 {
        let byte = *bytes.get(at)?;
        len = len << 7 | usize::from(byte & 0x7f);
        if byte & 0x80 == 0 {
            let body = &bytes[at + 1..];
            return Some(&body[..len.min(body.len())]);
        }
    }
    None
}

/// Reads an AudioSpecificConfig. `None` where it ends early or names a reserved rate.
pub(super) fn audio_specific_config(bytes: &[u8]) -> Option<AudioSpecificConfig> {
    let mut bits = Bits { bytes, at: 0 };
    let object_type = object_type(&mut bits)?;
    let core_rate_hz = sampling_frequency(&mut bits)?;
    let channel_count = match bits.take(4)? {
        7 => 8,
        11 => 7,
        12 | 14 => 8,
        count @ 0..=6 => u16::try_from(count).unwrap_or(0),
        _ => 0,
    };
    let mut config = AudioSpecificConfig {
        core_rate_hz,
        channel_count,
        spectral_band: SpectralBand::Unsaid,
        has_parametric_stereo: object_type == 29,
    };
    if object_type == 5 || object_type == 29 {
        config.spectral_band = SpectralBand::Present { output_rate_hz: sampling_frequency(&mut bits)? };
        return Some(config);
    }
    // The sync extension stands behind the GASpecificConfig, whose length depends on the object type and, for channel
    // configuration 0, on a whole channel map. FFmpeg searches for the 11 bits instead of parsing all of it; so do we.
    while let Some(word) = bits.peek(11) {
        if word != 0x2b7 {
            bits.at += 1;
            continue;
        }
        bits.at += 11;
        if bits.take(5) == Some(5) {
            match bits.take(1) {
                Some(1) => {
                    if let Some(output_rate_hz) = sampling_frequency(&mut bits) {
                        config.spectral_band = SpectralBand::Present { output_rate_hz };
                        config.has_parametric_stereo = bits.take(11) == Some(0x548) && bits.take(1) == Some(1);
                    }
                }
                Some(_) => config.spectral_band = SpectralBand::Absent,
                None => {}
            }
        }
        break;
    }
    Some(config)
}

fn object_type(bits: &mut Bits<'_>) -> Option<u32> {
    match bits.take(5)? {
        31 => Some(32 + bits.take(6)?),
        kind => Some(kind),
    }
}

/// ISO/IEC 14496-3 table 1.18; index 15 is followed by the rate itself.
fn sampling_frequency(bits: &mut Bits<'_>) -> Option<u32> {
    const RATES_HZ: [u32; 13] =
        [96_000, 88_200, 64_000, 48_000, 44_100, 32_000, 24_000, 22_050, 16_000, 12_000, 11_025, 8_000, 7_350];
    let rate_hz = match bits.take(4)? {
        15 => bits.take(24)?,
        index => *RATES_HZ.get(usize::try_from(index).ok()?)?,
    };
    (rate_hz > 0).then_some(rate_hz)
}

/// Bits of a byte string, most significant first.
struct Bits<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Bits<'_> {
    fn peek(&self, count: usize) -> Option<u32> {
        if self.at + count > self.bytes.len() * 8 {
            return None;
        }
        let bit = |at: usize| u32::from(self.bytes[at / 8] >> (7 - at % 8) & 1);
        Some((self.at..self.at + count).fold(0, |value, at| value << 1 | bit(at)))
    }

    fn take(&mut self, count: usize) -> Option<u32> {
        let value = self.peek(count)?;
        self.at += count;
        Some(value)
    }
}

/// Pre-skip of an Opus track: frames at 48 kHz to drop from the decoder's output. `payload` is that of `dOps`, whose
/// numbers are big endian, other than in the Ogg header (Encapsulation of Opus in ISO-BMFF, section 4.3.2).
pub(super) fn opus_pre_skip_frames(payload: &[u8]) -> Option<u64> {
    be_u16(payload, 2).map(u64::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The three-descriptor nest with one-byte sizes around `specific`.
    fn esds(specific: &[u8]) -> Vec<u8> {
        let specific_len = u8::try_from(specific.len()).unwrap();
        let mut payload = vec![0, 0, 0, 0, 0x03, 20 + specific_len, 0, 1, 0, 0x04, 15 + specific_len, 0x40, 0x15];
        payload.extend([0; 11]);
        payload.extend([0x05, specific_len]);
        payload.extend(specific);
        payload
    }

    #[test]
    fn the_specific_part_comes_out_of_the_nest_of_descriptors() {
        let found = esds_from_payload(&esds(&[0x12, 0x10])).unwrap();
        assert_eq!(found, Esds { object_type: 0x40, specific: vec![0x12, 0x10] });
        for len in 0..esds(&[0x12, 0x10]).len() {
            // Cut short anywhere it is damaged or has no whole specific part, and never panics.
            let cut = esds_from_payload(&esds(&[0x12, 0x10])[..len]);
            assert!(cut.is_none_or(|cut| cut.specific.len() < 2), "{len}");
        }
    }

    #[test]
    fn descriptor_sizes_of_four_bytes_and_optional_fields() {
        let mut payload = vec![0, 0, 0, 0, 0x03, 0x80, 0x80, 0x80, 0x25, 0, 2, 0xe0, 9, 9, 1, b'u', 7, 7];
        payload.extend([0x04, 0x80, 0x80, 0x80, 0x17, 0x40, 0x15, 0, 0, 0, 0, 1, 0x0d, 0x88, 0, 1, 0x0d, 0x88]);
        payload.extend([0x05, 0x80, 0x80, 0x80, 0x02, 0x11, 0x90]);
        assert_eq!(esds_from_payload(&payload).unwrap().specific, [0x11, 0x90]);
    }

    #[test]
    fn plain_aac() {
        // 00010 0100 0010 000: object type 2, rate index 4, 2 channels.
        let config = audio_specific_config(&[0x12, 0x10]).unwrap();
        assert_eq!((config.core_rate_hz, config.channel_count), (44_100, 2));
        assert_eq!(config.spectral_band, SpectralBand::Unsaid);
        assert_eq!(config.half_rate(44_100.0), None);
    }

    #[test]
    fn explicit_sbr() {
        // 00101 0110 0010 0011 00010 00: object type 5, core index 6, 2 channels, output index 3, core object type 2.
        let config = audio_specific_config(&[0x2b, 0x11, 0x88, 0x00]).unwrap();
        let half = config.half_rate(48_000.0).unwrap();
        assert_eq!((half.core_rate_hz, half.output_rate_hz, half.has_parametric_stereo), (24_000.0, 48_000.0, false));
        // The container may carry the core's rate: the configuration decides.
        assert_eq!(config.half_rate(24_000.0), Some(half));
    }

    #[test]
    fn explicit_parametric_stereo() {
        // 11101 0111 0001 0100 00010 00: object type 29, core index 7, 1 channel, output index 4, core object type 2.
        let config = audio_specific_config(&[0xeb, 0x8a, 0x08, 0x00]).unwrap();
        let half = config.half_rate(44_100.0).unwrap();
        assert_eq!((half.core_rate_hz, half.output_rate_hz, half.has_parametric_stereo), (22_050.0, 44_100.0, true));
        assert_eq!(config.channel_count, 1);
    }

    #[test]
    fn backward_compatible_sync_extension() {
        // 00010 0110 0010 000, then 01010110111 00101 1 0011: SBR at 48 kHz.
        let bytes = [0x13, 0x10, 0x56, 0xe5, 0x98];
        let config = audio_specific_config(&bytes).unwrap();
        assert_eq!(config.spectral_band, SpectralBand::Present { output_rate_hz: 48_000 });
        assert!(!config.has_parametric_stereo);
        // Followed by 10101001000 1: parametric stereo. 1 0011 101 01001000 1…
        let with_stereo = audio_specific_config(&[0x13, 0x08, 0x56, 0xe5, 0x9d, 0x48, 0x80]).unwrap();
        assert!(with_stereo.has_parametric_stereo);
    }

    #[test]
    fn sbr_said_to_be_absent_beats_a_container_of_twice_the_rate() {
        // FFmpeg's encoder writes the extension with the flag at 0.
        let config = audio_specific_config(&[0x12, 0x08, 0x56, 0xe5, 0x00]).unwrap();
        assert_eq!(config.spectral_band, SpectralBand::Absent);
        assert_eq!(config.half_rate(88_200.0), None);
    }

    #[test]
    fn implicit_sbr_is_seen_by_the_container_rate() {
        let config = audio_specific_config(&[0x13, 0x10]).unwrap();
        let half = config.half_rate(48_000.0).unwrap();
        assert_eq!((half.core_rate_hz, half.output_rate_hz), (24_000.0, 48_000.0));
    }

    #[test]
    fn a_rate_written_out_and_the_escape_object_type() {
        // 00010 1111 000000001010110001000100 0001 000: 44100 in 24 bits.
        let config = audio_specific_config(&[0x17, 0x80, 0x56, 0x22, 0x08]).unwrap();
        assert_eq!((config.core_rate_hz, config.channel_count), (44_100, 1));
        // 11111 001010 0100 0010 0: object type 32 + 10.
        assert_eq!(audio_specific_config(&[0xf9, 0x48, 0x40]).unwrap().core_rate_hz, 44_100);
        assert_eq!(audio_specific_config(&[0x16, 0x90]), None, "rate index 13 is reserved");
        assert_eq!(audio_specific_config(&[]), None);
    }
}
