//! The samples of a WAVE file, block by block.

use std::io::{self, BufReader, Read, Seek, SeekFrom};

use symphonia::core::packet::Packet;
use symphonia::core::units::{Duration, Timestamp};

use super::WaveLayout;
use crate::file_access::{FileAccess, OpenFile};
use crate::frames::{Frames, Incidents};
use crate::pcm_layout::PcmLayout;

/// Blocks of samples from the data chunk.
pub(crate) struct WaveBlocks {
    reader: BufReader<OpenFile>,
    layout: WaveLayout,
    left_bytes: u64,
    next_frame: u64,
}

impl WaveBlocks {
    pub(crate) fn open(file: &dyn FileAccess, layout: WaveLayout) -> io::Result<Self> {
        let mut reader = BufReader::with_capacity(128 * 1024, file.open()?);
        reader.seek(SeekFrom::Start(layout.data_at))?;
        Ok(Self { reader, left_bytes: layout.data_bytes, next_frame: 0, layout })
    }

    /// Replaces `data` by the next whole blocks and returns their number, 0 after the last.
    fn read_blocks(&mut self, data: &mut Vec<u8>) -> io::Result<u64> {
        let blocks = (self.left_bytes / self.layout.block_bytes).min(self.layout.packet_blocks());
        let wanted = blocks * self.layout.block_bytes;
        data.clear();
        data.reserve(usize::try_from(wanted).unwrap_or(0));
        self.reader.by_ref().take(wanted).read_to_end(data)?;
        // fewer bytes if the file becomes shorter while it is read
        let blocks = data.len() as u64 / self.layout.block_bytes;
        data.truncate((blocks * self.layout.block_bytes) as usize);
        self.left_bytes -= data.len() as u64;
        Ok(blocks)
    }

    /// The next whole blocks; `None` after the last.
    pub(crate) fn next_packet(&mut self) -> io::Result<Option<Packet>> {
        let mut data = Vec::new();
        let blocks = self.read_blocks(&mut data)?;
        if blocks == 0 {
            return Ok(None);
        }
        let frames = blocks * self.layout.block_frames;
        let at = Timestamp::new(i64::try_from(self.next_frame).unwrap_or(i64::MAX));
        self.next_frame += frames;
        Ok(Some(Packet::new(0, at, Duration::new(frames), data)))
    }
}

/// The frames of an uncompressed WAVE file. No decoder is needed; packets of one frame would be four times slower.
pub(crate) struct WavePcmFrames {
    blocks: WaveBlocks,
    pcm: PcmLayout,
    bytes: Vec<u8>,
}

impl WavePcmFrames {
    pub(crate) fn open(file: &dyn FileAccess, layout: &WaveLayout, pcm: PcmLayout) -> io::Result<Self> {
        Ok(Self { blocks: WaveBlocks::open(file, layout.clone())?, pcm, bytes: Vec::new() })
    }
}

impl Frames for WavePcmFrames {
    fn sample_rate_hz(&self) -> f64 {
        f64::from(self.blocks.layout.sample_rate_hz)
    }

    fn channel_count(&self) -> usize {
        usize::from(self.blocks.layout.channel_count)
    }

    fn next_frames(&mut self, out: &mut Vec<f32>, _: &mut Incidents) -> io::Result<bool> {
        let blocks = self.blocks.read_blocks(&mut self.bytes)?;
        out.clear();
        self.pcm.decode(&self.bytes, out);
        Ok(blocks > 0)
    }
}
