//! From Opus packets to samples: the adapter to `opus-pure`, which has packets instead of Symphonia's traits.

use opus_pure::{OpusDecoder, OpusMSDecoder};

/// Every Opus stream decodes at this rate.
pub(crate) const OPUS_RATE_HZ: u32 = 48_000;

/// The longest packet: 120 ms.
const PACKET_FRAMES_MAX: usize = 5760;

/// Decodes the packets of one stream, mono, stereo or surround.
pub(crate) struct OpusPackets {
    decoder: Decoder,
    channel_count: usize,
    gain: f32,
}

enum Decoder {
    Plain(Box<OpusDecoder>),
    Surround(Box<OpusMSDecoder>),
}

/// Facts from the identification header (RFC 7845, 5.1).
#[derive(Clone, Copy, Debug)]
pub(crate) struct OpusHead {
    pub(crate) channel_count: usize,
    pub(crate) pre_skip_frames: u64,
    gain_q8_db: i16,
    mapping_family: u8,
}

impl OpusHead {
    /// Reads `OpusHead` of Ogg and Matroska (version 1, little-endian). Symphonia puts the same magic before the `dOps` box of MP4
    /// (version 0, big-endian) without a change of its byte order.
    pub(crate) fn from_extra_data(extra: &[u8]) -> Option<Self> {
        let &[version, channels, s0, s1, _, _, _, _, g0, g1, family, ..] = extra.strip_prefix(b"OpusHead")? else {
            return None;
        };
        let (pre_skip, gain_q8_db) = match version {
            0 => (u16::from_be_bytes([s0, s1]), i16::from_be_bytes([g0, g1])),
            _ => (u16::from_le_bytes([s0, s1]), i16::from_le_bytes([g0, g1])),
        };
        Some(Self {
            channel_count: usize::from(channels),
            pre_skip_frames: u64::from(pre_skip),
            gain_q8_db,
            mapping_family: family,
        })
    }
}

impl OpusPackets {
    pub(crate) fn new(head: OpusHead) -> Result<Self, String> {
        let rate = OPUS_RATE_HZ as i32;
        let decoder = if head.mapping_family == 0 || head.channel_count <= 2 {
            OpusDecoder::new(rate, head.channel_count).map(|decoder| Decoder::Plain(Box::new(decoder)))
        } else {
            OpusMSDecoder::new(rate, head.channel_count, head.mapping_family)
                .map(|decoder| Decoder::Surround(Box::new(decoder)))
        };
        let decoder = decoder.map_err(|error| error.to_string())?;
        // RFC 7845, 5.1: the gain is in 1/256 dB.
        let gain = 10_f32.powf(f32::from(head.gain_q8_db) / (20.0 * 256.0));
        Ok(Self { decoder, channel_count: head.channel_count, gain })
    }

    pub(crate) fn channel_count(&self) -> usize {
        self.channel_count
    }

    /// Decodes one packet to interleaved samples, which replace the content of `out`.
    pub(crate) fn decode(&mut self, packet: &[u8], out: &mut Vec<f32>) -> Result<(), String> {
        out.clear();
        if packet.is_empty() {
            return Err("an empty packet".to_owned());
        }
        out.resize(PACKET_FRAMES_MAX * self.channel_count, 0.0);
        let frames = match &mut self.decoder {
            Decoder::Plain(decoder) => decoder.decode(packet, PACKET_FRAMES_MAX, out),
            Decoder::Surround(decoder) => decoder.decode(packet, PACKET_FRAMES_MAX, out),
        };
        match frames {
            Ok(frames) => {
                out.truncate(frames * self.channel_count);
                if self.gain != 1.0 {
                    out.iter_mut().for_each(|sample| *sample *= self.gain);
                }
                Ok(())
            }
            Err(error) => {
                out.clear();
                Err(error.to_string())
            }
        }
    }
}

/// Number of frames in a packet (RFC 6716, 3.1), for silence in place of a damaged one.
pub(crate) fn packet_frames(packet: &[u8]) -> u64 {
    opus_pure::packet::samples_48k(packet).map_or(0, |frames| frames.min(PACKET_FRAMES_MAX) as u64)
}
