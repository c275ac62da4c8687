//! Reading the frames of an uncompressed track, whole chunks at a time.
//!
//! A MOV of 30 minutes has tens of thousands of chunks between the pictures. They are read with as few calls as their positions allow,
//! directly into one buffer, and converted to `f32` on output.

use std::io::{self, Read, Seek, SeekFrom};
use std::sync::Arc;

use super::sample_table::{Chunk, ChunkCursor, SampleTable};
use super::{AudioTrack, QuicktimeError};
use crate::pcm_layout::PcmLayout;

/// Frames of one block.
const BLOCK_FRAMES: u64 = 8192;

/// Bytes of one block, for tracks of many channels.
const BLOCK_BYTES_MAX: u64 = 1 << 20;

/// Reads the frames of an uncompressed track in order, from the first in its table. The caller handles priming and edits
/// (`AudioTrack::skip_frames`, `AudioTrack::kept_frames`).
#[derive(Debug)]
pub(crate) struct PcmReader<R> {
    reader: R,
    layout: PcmLayout,
    table: Arc<SampleTable>,
    frame_bytes: u64,
    declared_frames: u64,
    file_len: u64,
    cursor: ChunkCursor,
    /// Remaining part of the current run of bytes.
    run: Run,
    /// The chunk after the run, already read from the table.
    ahead: Option<Run>,
    delivered_frames: u64,
    is_at_end: bool,
    bytes: Vec<u8>,
}

/// Bytes without a gap.
#[derive(Debug, Clone, Copy, Default)]
struct Run {
    offset: u64,
    byte_len: u64,
}

impl<R: Read + Seek> PcmReader<R> {
    /// A reader of `track`, whose table was read from the same file. The position of the file does not matter.
    ///
    /// # Errors
    /// `NotPcm` for a track without `AudioTrack::pcm`.
    pub(crate) fn new(reader: R, track: &AudioTrack) -> Result<Self, QuicktimeError> {
        let Some(layout) = track.pcm else { return Err(QuicktimeError::NotPcm { codec: track.codec }) };
        Ok(Self {
            reader,
            layout,
            table: Arc::clone(&track.table),
            frame_bytes: u64::from(track.channel_count.max(1)) * u64::from(layout.sample_bytes),
            declared_frames: track.declared_frames.unwrap_or(0),
            file_len: track.file_len,
            cursor: ChunkCursor::default(),
            run: Run::default(),
            ahead: None,
            delivered_frames: 0,
            is_at_end: false,
            bytes: Vec::new(),
        })
    }

    /// Replaces the content of `out` by the next interleaved frames and returns their number, 0 at the end.
    ///
    /// Of a truncated file it returns the existing frames; see [`Self::missing_frames`].
    ///
    /// # Errors
    /// Errors of reading the file.
    pub(crate) fn next_block(&mut self, out: &mut Vec<f32>) -> Result<u64, QuicktimeError> {
        out.clear();
        self.bytes.clear();
        let wanted = BLOCK_FRAMES.min((BLOCK_BYTES_MAX / self.frame_bytes).max(1)) * self.frame_bytes;
        while !self.is_at_end && (self.bytes.len() as u64) < wanted {
            if self.run.byte_len == 0 {
                match self.next_run() {
                    Some(run) => self.run = run,
                    None => {
                        self.is_at_end = true;
                        break;
                    }
                }
            }
            self.read_from_run(wanted)?;
        }
        let frames = self.bytes.len() as u64 / self.frame_bytes;
        self.delivered_frames += frames;
        self.layout.decode(&self.bytes, out);
        Ok(frames)
    }

    /// Number of frames in the table that are missing in the file. It is final when [`Self::next_block`] has returned 0.
    pub(crate) fn missing_frames(&self) -> u64 {
        if self.is_at_end { self.declared_frames.saturating_sub(self.delivered_frames) } else { 0 }
    }

    /// Back to the first frame.
    #[allow(dead_code, reason = "part of the module's interface; the media crate opens the file again so far")]
    pub(crate) fn rewind(&mut self) {
        self.cursor = ChunkCursor::default();
        self.run = Run::default();
        self.ahead = None;
        self.delivered_frames = 0;
        self.is_at_end = false;
    }

    /// The next chunks that follow each other without a gap.
    fn next_run(&mut self) -> Option<Run> {
        let mut run = self.ahead.take().or_else(|| self.next_chunk())?;
        while let Some(next) = self.next_chunk() {
            if run.offset.checked_add(run.byte_len) != Some(next.offset) {
                self.ahead = Some(next);
                break;
            }
            run.byte_len = run.byte_len.saturating_add(next.byte_len);
        }
        Some(run)
    }

    /// The next chunk with a whole frame in it, without the part of a frame at its end.
    fn next_chunk(&mut self) -> Option<Run> {
        loop {
            let Chunk { offset, byte_len, .. } = self.cursor.next(&self.table)?;
            let byte_len = byte_len / self.frame_bytes * self.frame_bytes;
            if byte_len > 0 {
                return Some(Run { offset, byte_len });
            }
        }
    }

    /// Reads from the current run until the block has `wanted` bytes, or the run or the file ends.
    fn read_from_run(&mut self, wanted: u64) -> Result<(), QuicktimeError> {
        let delivered_bytes = self.delivered_frames.saturating_mul(self.frame_bytes);
        let buffered = self.bytes.len() as u64;
        let in_file = self.file_len.saturating_sub(self.run.offset);
        // Overlapping chunks with more bytes than the file are damage; reading them could take very long.
        let honest = self.file_len.saturating_sub(delivered_bytes.saturating_add(buffered));
        let asked = self.run.byte_len.min(wanted - buffered);
        let there = asked.min(in_file).min(honest) / self.frame_bytes * self.frame_bytes;
        let from = self.bytes.len();
        if there > 0 {
            self.reader.seek(SeekFrom::Start(self.run.offset))?;
            // Bounded by BLOCK_BYTES_MAX or one frame of PCM_CHANNELS_MAX channels.
            self.bytes.resize(from + usize::try_from(there).unwrap_or(0), 0);
            let got = read_fully(&mut self.reader, &mut self.bytes[from..])?;
            let whole = got as u64 / self.frame_bytes * self.frame_bytes;
            self.bytes.truncate(from + usize::try_from(whole).unwrap_or(0));
            self.run.offset += whole;
            self.run.byte_len -= whole;
        }
        if self.bytes.len() as u64 - buffered < asked {
            self.is_at_end = true;
        }
        Ok(())
    }
}

/// Reads until `buffer` is full or the file ends.
fn read_fully<R: Read>(reader: &mut R, buffer: &mut [u8]) -> io::Result<usize> {
    let mut filled = 0;
    while filled < buffer.len() {
        match reader.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(count) => filled += count,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
}

#[cfg(test)]
#[path = "pcm_tests.rs"]
mod tests;
