//! Positions of the samples of a track in the file: the tables of `stbl`.
//!
//! ISO/IEC 14496-12 sections 8.6.1.2 (`stts`, durations), 8.7.3 (`stsz` and `stz2`, sizes), 8.7.4 (`stsc`, samples per chunk) and 8.7.5
//! (`stco` and `co64`, chunk offsets). A sample is the object of one table entry: a compressed packet, or in QuickTime's uncompressed
//! tracks one frame of PCM. A chunk is a run of samples without gaps.
//!
//! The tables stay run-length coded as in the file and are evaluated lazily: a constant sample size with a count of four billion needs no
//! memory.

use std::sync::Arc;

use super::QuicktimeError;
use super::boxes::{be_u16, be_u32, be_u64, find};

/// The tables of one track.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct SampleTable {
    chunk_offsets: Vec<u64>,
    chunk_runs: Vec<ChunkRun>,
    sizes: SampleSizes,
    sample_count: u64,
    durations: Vec<DurationRun>,
    /// Chunks refer to more than one sample description: the codec changes within the track.
    pub(super) has_mixed_descriptions: bool,
}

/// From `first_chunk` (counted from 1) on, every chunk holds `samples_per_chunk`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ChunkRun {
    first_chunk: u32,
    samples_per_chunk: u32,
}

/// `count` samples that last `ticks` each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct DurationRun {
    count: u32,
    ticks: u32,
}

/// Sizes of the samples.
#[derive(Debug, Clone, PartialEq, Eq)]
enum SampleSizes {
    /// Every `group_samples` samples have `group_bytes` bytes. There is more than one sample in a group where QuickTime's version 1
    /// descriptions count the frames of a compressed packet as samples.
    Constant { group_bytes: u64, group_samples: u64 },
    /// One size for each sample.
    Each(Vec<u32>),
}

impl Default for SampleSizes {
    fn default() -> Self {
        Self::Each(Vec::new())
    }
}

/// A run of samples without gaps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Chunk {
    pub(super) offset: u64,
    pub(super) byte_len: u64,
    pub(super) sample_count: u64,
}

/// Position of one compressed packet of a track in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PacketPosition {
    pub(crate) offset: u64,
    pub(crate) byte_len: u64,
    /// Duration in ticks of the track's timescale.
    pub(crate) duration_ticks: u64,
}

impl SampleTable {
    /// Reads the payload of `stbl`. Tables that are missing are empty: a fragmented file has none.
    pub(super) fn from_stbl(stbl: &[u8]) -> Result<Self, QuicktimeError> {
        let mut table = Self::default();
        if let Some(payload) = find(stbl, b"stco")? {
            table.chunk_offsets =
                rows(payload, 8, 4, be_u32(payload, 4)).filter_map(|r| be_u32(r, 0)).map(u64::from).collect();
        } else if let Some(payload) = find(stbl, b"co64")? {
            table.chunk_offsets = rows(payload, 8, 8, be_u32(payload, 4)).filter_map(|r| be_u64(r, 0)).collect();
        }
        if let Some(payload) = find(stbl, b"stsc")? {
            let mut first_description = None;
            for row in rows(payload, 8, 12, be_u32(payload, 4)) {
                let fields = (be_u32(row, 0), be_u32(row, 4), be_u32(row, 8));
                let (Some(first_chunk), Some(samples_per_chunk), Some(description)) = fields else { break };
                table.chunk_runs.push(ChunkRun { first_chunk, samples_per_chunk });
                table.has_mixed_descriptions |= *first_description.get_or_insert(description) != description;
            }
        }
        if let Some(payload) = find(stbl, b"stsz")? {
            let count = be_u32(payload, 8);
            match be_u32(payload, 4) {
                Some(0) | None => table.set_sizes(rows(payload, 12, 4, count).filter_map(|r| be_u32(r, 0)).collect()),
                Some(bytes) => {
                    table.sizes = SampleSizes::Constant { group_bytes: u64::from(bytes), group_samples: 1 };
                    table.sample_count = u64::from(count.unwrap_or(0));
                }
            }
        } else if let Some(payload) = find(stbl, b"stz2")? {
            table.set_sizes(compact_sizes(payload));
        }
        if let Some(payload) = find(stbl, b"stts")? {
            let runs = rows(payload, 8, 8, be_u32(payload, 4));
            table.durations = runs
                .filter_map(|row| Some(DurationRun { count: be_u32(row, 0)?, ticks: be_u32(row, 4)? }))
                .filter(|run| run.count > 0)
                .collect();
        }
        Ok(table)
    }

    fn set_sizes(&mut self, sizes: Vec<u32>) {
        self.sample_count = sizes.len() as u64;
        self.sizes = SampleSizes::Each(sizes);
    }

    /// The constant sample size the table states, if it states one.
    pub(super) fn constant_size_bytes(&self) -> Option<u64> {
        match self.sizes {
            SampleSizes::Constant { group_bytes, group_samples: 1 } => Some(group_bytes),
            _ => None,
        }
    }

    /// Replaces a constant sample size: every `group_samples` samples have `group_bytes` bytes. A list of sizes is not changed.
    pub(super) fn correct_constant_size(&mut self, group_bytes: u64, group_samples: u64) {
        if let SampleSizes::Constant { .. } = self.sizes {
            self.sizes = SampleSizes::Constant { group_bytes, group_samples: group_samples.max(1) };
        }
    }

    /// Whether the tables are empty.
    pub(super) fn is_empty(&self) -> bool {
        self.chunk_offsets.is_empty() || self.sample_count == 0
    }

    /// Sum of the durations in ticks of the track's timescale.
    pub(super) fn duration_ticks(&self) -> u64 {
        self.durations
            .iter()
            .fold(0, |sum: u64, run| sum.saturating_add(u64::from(run.count).saturating_mul(u64::from(run.ticks))))
    }

    /// Duration of the first sample.
    pub(super) fn first_duration_ticks(&self) -> Option<u32> {
        self.durations.first().map(|run| run.ticks)
    }

    /// Whether the last sample is shorter than most: then the table cuts the output of the decoder at the end.
    pub(super) fn is_last_sample_short(&self) -> bool {
        let most = self.durations.iter().max_by_key(|run| run.count);
        most.zip(self.durations.last()).is_some_and(|(most, last)| last.ticks < most.ticks)
    }

    /// Position of the last byte of the track.
    pub(super) fn end_offset(&self) -> u64 {
        let mut cursor = ChunkCursor::default();
        let mut end = 0;
        while let Some(chunk) = cursor.next(self) {
            end = end.max(chunk.offset.saturating_add(chunk.byte_len));
        }
        end
    }

    /// Whole frames of `frame_bytes` in all chunks.
    pub(super) fn whole_frames(&self, frame_bytes: u64) -> u64 {
        let mut cursor = ChunkCursor::default();
        let mut frames = 0_u64;
        while let Some(chunk) = cursor.next(self) {
            frames = frames.saturating_add(chunk.byte_len / frame_bytes.max(1));
        }
        frames
    }

    /// The packets that lie completely within a file of `file_len` bytes, up to the first that does not.
    pub(super) fn packets(self: Arc<Self>, file_len: u64) -> Packets {
        Packets {
            table: self,
            cursor: ChunkCursor::default(),
            chunk: None,
            sample: 0,
            run: 0,
            run_used: 0,
            file_len,
            bytes_left: file_len,
        }
    }
}

/// `count` rows of `row_len` bytes from `start` on, limited by the payload, since a count can be wrong.
fn rows(payload: &[u8], start: usize, row_len: usize, count: Option<u32>) -> impl Iterator<Item = &[u8]> {
    let count = count.and_then(|count| usize::try_from(count).ok()).unwrap_or(0);
    payload.get(start..).unwrap_or_default().chunks_exact(row_len).take(count)
}

/// `stz2`: sizes of 4, 8 or 16 bits.
fn compact_sizes(payload: &[u8]) -> Vec<u32> {
    let count = be_u32(payload, 8).and_then(|count| usize::try_from(count).ok()).unwrap_or(0);
    let bytes = payload.get(12..).unwrap_or_default();
    match payload.get(7) {
        Some(4) => bytes.iter().flat_map(|b| [u32::from(b >> 4), u32::from(b & 15)]).take(count).collect(),
        Some(8) => bytes.iter().map(|b| u32::from(*b)).take(count).collect(),
        Some(16) => bytes.chunks_exact(2).filter_map(|r| be_u16(r, 0)).map(u32::from).take(count).collect(),
        _ => Vec::new(),
    }
}

/// A position in the list of chunks. It has no reference, so that a reader can store it beside the table.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ChunkCursor {
    chunk: usize,
    run: usize,
    sample: u64,
}

impl ChunkCursor {
    /// The next chunk, `None` after the last one or when the samples are used up.
    pub(super) fn next(&mut self, table: &SampleTable) -> Option<Chunk> {
        let offset = *table.chunk_offsets.get(self.chunk)?;
        let number = self.chunk as u64 + 1;
        while table.chunk_runs.get(self.run + 1).is_some_and(|next| u64::from(next.first_chunk) <= number) {
            self.run += 1;
        }
        let wanted = u64::from(table.chunk_runs.get(self.run)?.samples_per_chunk);
        let left = table.sample_count.saturating_sub(self.sample);
        if left == 0 {
            return None;
        }
        let sample_count = wanted.min(left);
        let byte_len = match &table.sizes {
            SampleSizes::Constant { group_bytes, group_samples } => {
                (sample_count / group_samples).saturating_mul(*group_bytes)
            }
            SampleSizes::Each(sizes) => {
                let from = usize::try_from(self.sample).ok()?;
                let to = usize::try_from(self.sample + sample_count).ok()?;
                sizes.get(from..to)?.iter().map(|size| u64::from(*size)).sum()
            }
        };
        self.chunk += 1;
        self.sample += sample_count;
        Some(Chunk { offset, byte_len, sample_count })
    }
}

/// The packets of a track in the order of its tables, computed one by one. See `SampleTable::packets`.
#[derive(Debug, Clone)]
pub(crate) struct Packets {
    table: Arc<SampleTable>,
    cursor: ChunkCursor,
    /// Remaining part of the current chunk.
    chunk: Option<Chunk>,
    sample: u64,
    run: usize,
    run_used: u64,
    file_len: u64,
    /// The packets have at most as many bytes as the file. Overlapping chunks with more are damage, and reading them could take very
    /// long.
    bytes_left: u64,
}

impl Packets {
    fn advance_ticks(&mut self, samples: u64) -> u64 {
        let mut ticks = 0_u64;
        let mut left = samples;
        while left > 0 {
            let Some(run) = self.table.durations.get(self.run) else { break };
            let used = left.min(u64::from(run.count).saturating_sub(self.run_used));
            ticks = ticks.saturating_add(used.saturating_mul(u64::from(run.ticks)));
            left -= used;
            self.run_used += used;
            if self.run_used >= u64::from(run.count) {
                self.run += 1;
                self.run_used = 0;
            }
        }
        ticks
    }
}

impl Iterator for Packets {
    type Item = PacketPosition;

    fn next(&mut self) -> Option<PacketPosition> {
        let samples = match self.table.sizes {
            SampleSizes::Constant { group_samples, .. } => group_samples,
            SampleSizes::Each(_) => 1,
        };
        let mut chunk = match self.chunk {
            Some(chunk) if chunk.sample_count >= samples => chunk,
            _ => loop {
                let chunk = self.cursor.next(&self.table)?;
                if chunk.sample_count >= samples {
                    break chunk;
                }
            },
        };
        let byte_len = match &self.table.sizes {
            SampleSizes::Constant { group_bytes, .. } => *group_bytes,
            SampleSizes::Each(sizes) => u64::from(*sizes.get(usize::try_from(self.sample).ok()?)?),
        };
        let offset = chunk.offset;
        let end = offset.checked_add(byte_len)?;
        if end > self.file_len || byte_len > self.bytes_left {
            // Ends the iteration: no packet behind a gap is read.
            self.bytes_left = 0;
            self.file_len = 0;
            return None;
        }
        self.bytes_left -= byte_len;
        chunk.offset = end;
        chunk.sample_count = chunk.sample_count.saturating_sub(samples);
        self.chunk = Some(chunk);
        self.sample += samples;
        Some(PacketPosition { offset, byte_len, duration_ticks: self.advance_ticks(samples) })
    }
}

#[cfg(test)]
#[path = "sample_table_tests.rs"]
mod tests;
