//! Sound that another decoder has decoded, such as that of a browser: its samples, in the place of a decoder of this crate.

use std::fmt;
use std::io::{self, Read};
use std::sync::Arc;

use crate::file_access::{FileAccess, OpenFile};
use crate::frames::{Frames, Incidents};

/// Frames that are read at once.
const FRAMES_AT_ONCE: usize = 4096;

/// Bytes of a sample.
const SAMPLE_BYTES: usize = size_of::<f32>();

/// All that another decoder made of the packets of [`crate::CodedSound`].
#[derive(Clone)]
pub struct DecodedSound {
    /// Interleaved samples of all channels as 32-bit floats, little-endian, full scale 1.
    pub samples: Arc<dyn FileAccess>,
    /// Number of channels.
    pub channel_count: usize,
    /// Samples per second and channel.
    pub sample_rate_hz: f64,
    /// Time of the first packet on the clock of the recording.
    pub first_packet_s: f64,
}

impl fmt::Debug for DecodedSound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { channel_count, sample_rate_hz, .. } = self;
        f.debug_struct("DecodedSound")
            .field("channel_count", channel_count)
            .field("sample_rate_hz", sample_rate_hz)
            .finish_non_exhaustive()
    }
}

/// One pass through decoded samples.
pub(crate) struct DecodedFrames {
    file: OpenFile,
    channel_count: usize,
    sample_rate_hz: f64,
    bytes: Vec<u8>,
}

impl DecodedFrames {
    pub(crate) fn open(sound: &DecodedSound) -> io::Result<Self> {
        let &DecodedSound { channel_count, sample_rate_hz, .. } = sound;
        Ok(Self { file: sound.samples.open()?, channel_count, sample_rate_hz, bytes: Vec::new() })
    }
}

impl Frames for DecodedFrames {
    fn sample_rate_hz(&self) -> f64 {
        self.sample_rate_hz
    }

    fn channel_count(&self) -> usize {
        self.channel_count
    }

    fn next_frames(&mut self, out: &mut Vec<f32>, _: &mut Incidents) -> io::Result<bool> {
        let frame_bytes = SAMPLE_BYTES * self.channel_count.max(1);
        let wanted = FRAMES_AT_ONCE * frame_bytes;
        self.bytes.clear();
        self.file.by_ref().take(wanted as u64).read_to_end(&mut self.bytes)?;
        let whole = self.bytes.len() - self.bytes.len() % frame_bytes;
        out.clear();
        out.extend(self.bytes[..whole].as_chunks::<SAMPLE_BYTES>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)));
        Ok(self.bytes.len() == wanted)
    }
}
