//! Bare MPEG audio and AAC frames: their start, and the number of frames that the first frame of an MP3 states.
//!
//! Layout of the MPEG audio header: ISO/IEC 11172-3, 2.4.1.3; of ADTS: ISO/IEC 13818-7, 6.2. The Xing/Info frame and
//! LAME's delay and padding are conventions of those encoders.

/// Delay of a decoder, which LAME's number does not contain, in frames.
const DECODER_DELAY_FRAMES: u64 = 528 + 1;

/// Number of consecutive valid frames that identify MPEG audio.
const CHAIN_FRAMES: usize = 4;

/// Facts from the first frames of a bare stream.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MpegAudio {
    pub(crate) is_adts: bool,
    /// AudioSpecificConfig (ISO/IEC 14496-3, 1.6.2.1) of what the header of an ADTS frame says.
    pub(crate) aac_config: Option<[u8; 2]>,
    /// Layer 1, 2 or 3 of MPEG audio.
    pub(crate) layer: u8,
    pub(crate) sample_rate_hz: u32,
    /// From a Xing/Info frame: sample frames of the whole stream, delay and padding included.
    pub(crate) total_frames: Option<u64>,
    /// From LAME's tag: sample frames to drop at the beginning and at the end.
    pub(crate) delay_and_padding: Option<(u64, u64)>,
}

/// Length of the ID3v2 tags at the beginning.
pub(crate) fn id3v2_len(head: &[u8]) -> u64 {
    match head {
        [b'I', b'D', b'3', major, _, flags, a, b, c, d, ..]
            if *major < 0xff && [a, b, c, d].iter().all(|s| **s < 0x80) =>
        {
            let len = [a, b, c, d].iter().fold(0_u64, |len, byte| (len << 7) | u64::from(**byte));
            let footer = if flags & 0x10 != 0 { 10 } else { 0 };
            10 + len + footer
        }
        _ => 0,
    }
}

/// Offset and content of the first frame with enough valid frames behind it.
pub(crate) fn first_frame(head: &[u8]) -> Option<(usize, MpegAudio)> {
    for offset in 0..head.len().saturating_sub(4) {
        let Some(first) = frame_at(head, offset) else { continue };
        let mut next = offset + first.frame_bytes;
        let mut chained = 1;
        while chained < CHAIN_FRAMES {
            match frame_at(head, next) {
                Some(frame) if frame.is_like(&first) => next += frame.frame_bytes,
                _ => break,
            }
            chained += 1;
        }
        // A file with fewer frames than the chain needs is accepted if its frames fill it.
        if chained == CHAIN_FRAMES || (offset == 0 && chained >= 2 && next >= head.len()) {
            let (total_frames, delay_and_padding) = first.info_tag(head.get(offset..offset + first.frame_bytes)?);
            let mpeg = MpegAudio {
                is_adts: first.is_adts,
                aac_config: first.aac_config,
                layer: first.layer,
                sample_rate_hz: first.sample_rate_hz,
                total_frames,
                delay_and_padding,
            };
            return Some((offset, mpeg));
        }
    }
    None
}

#[derive(Clone, Copy)]
struct Frame {
    is_adts: bool,
    aac_config: Option<[u8; 2]>,
    layer: u8,
    is_mpeg1: bool,
    is_mono: bool,
    sample_rate_hz: u32,
    frame_bytes: usize,
    frame_samples: u64,
}

impl Frame {
    fn is_like(&self, other: &Self) -> bool {
        self.is_adts == other.is_adts && self.layer == other.layer && self.sample_rate_hz == other.sample_rate_hz
    }

    /// Sample frames and (delay, padding) from a Xing/Info frame.
    fn info_tag(&self, frame: &[u8]) -> (Option<u64>, Option<(u64, u64)>) {
        if self.layer != 3 || self.is_adts {
            return (None, None);
        }
        let side_info_bytes = match (self.is_mpeg1, self.is_mono) {
            (true, false) => 32,
            (true, true) | (false, false) => 17,
            (false, true) => 9,
        };
        let Some(tag) = frame.get(4 + side_info_bytes..) else { return (None, None) };
        if !(tag.starts_with(b"Xing") || tag.starts_with(b"Info")) {
            return (None, None);
        }
        let u32_at = |at: usize| tag.get(at..at + 4).map(|b| u32::from_be_bytes([b[0], b[1], b[2], b[3]]));
        let Some(flags) = u32_at(4) else { return (None, None) };
        let total_frames = if flags & 1 != 0 { u32_at(8).map(|n| u64::from(n) * self.frame_samples) } else { None };

        let lame = 8 + [(1, 4), (2, 4), (4, 100), (8, 4)]
            .iter()
            .filter(|(bit, _)| flags & bit != 0)
            .map(|(_, n)| n)
            .sum::<usize>();
        let delay_and_padding = match (tag.get(lame..lame + 4), tag.get(lame + 21..lame + 24)) {
            (Some(encoder), Some(&[a, b, c])) if encoder.iter().any(|byte| *byte != 0) => {
                let delay = (u64::from(a) << 4) | (u64::from(b) >> 4);
                let padding = (u64::from(b & 0x0f) << 8) | u64::from(c);
                Some((delay + DECODER_DELAY_FRAMES, padding.saturating_sub(DECODER_DELAY_FRAMES)))
            }
            _ => None,
        };
        (total_frames, delay_and_padding)
    }
}

fn frame_at(head: &[u8], at: usize) -> Option<Frame> {
    let &[a, b, c, d] = head.get(at..at + 4)? else { return None };
    if a != 0xff || b & 0xe0 != 0xe0 {
        return None;
    }
    if b & 0xf6 == 0xf0 { adts_frame(c, d, *head.get(at + 4)?, *head.get(at + 5)?) } else { mpeg_frame(b, c, d) }
}

fn adts_frame(c: u8, d: u8, e: u8, f: u8) -> Option<Frame> {
    const RATES_HZ: [u32; 13] =
        [96000, 88200, 64000, 48000, 44100, 32000, 24000, 22050, 16000, 12000, 11025, 8000, 7350];
    let frame_bytes = (usize::from(d & 3) << 11) | (usize::from(e) << 3) | usize::from(f >> 5);
    (frame_bytes > 7).then_some(())?;
    let (object_type, rate, channels) = ((c >> 6) + 1, (c >> 2) & 0xf, ((c & 1) << 2) | (d >> 6));
    Some(Frame {
        is_adts: true,
        aac_config: Some([(object_type << 3) | (rate >> 1), (rate << 7) | (channels << 3)]),
        layer: 0,
        is_mpeg1: false,
        is_mono: false,
        sample_rate_hz: *RATES_HZ.get(usize::from(rate))?,
        frame_bytes,
        frame_samples: 1024,
    })
}

fn mpeg_frame(b: u8, c: u8, d: u8) -> Option<Frame> {
    const BIT_RATES_KBIT_S: [[usize; 14]; 5] = [
        [32, 64, 96, 128, 160, 192, 224, 256, 288, 320, 352, 384, 416, 448],
        [32, 48, 56, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320, 384],
        [32, 40, 48, 56, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320],
        [32, 48, 56, 64, 80, 96, 112, 128, 144, 160, 176, 192, 224, 256],
        [8, 16, 24, 32, 40, 48, 56, 64, 80, 96, 112, 128, 144, 160],
    ];
    let rate_divisor = match (b >> 3) & 3 {
        3 => 1,
        2 => 2,
        0 => 4,
        _ => return None,
    };
    let is_mpeg1 = rate_divisor == 1;
    let layer = match (b >> 1) & 3 {
        3 => 1,
        2 => 2,
        1 => 3,
        _ => return None,
    };
    let sample_rate_hz = [44100, 48000, 32000].get(usize::from((c >> 2) & 3))? / rate_divisor;
    let column = match (is_mpeg1, layer) {
        (true, 1) => 0,
        (true, 2) => 1,
        (true, _) => 2,
        (false, 1) => 3,
        (false, _) => 4,
    };
    let bit_rate = 1000 * BIT_RATES_KBIT_S[column].get(usize::from(c >> 4).checked_sub(1)?)?;
    let padding = usize::from((c >> 1) & 1);
    let rate = sample_rate_hz as usize;
    let (frame_bytes, frame_samples) = match (layer, is_mpeg1) {
        (1, _) => (4 * (12 * bit_rate / rate + padding), 384),
        (3, false) => (72 * bit_rate / rate + padding, 576),
        _ => (144 * bit_rate / rate + padding, 1152),
    };
    let is_mono = d >> 6 == 3;
    (frame_bytes > 4).then_some(Frame {
        is_adts: false,
        aac_config: None,
        layer,
        is_mpeg1,
        is_mono,
        sample_rate_hz,
        frame_bytes,
        frame_samples,
    })
}
