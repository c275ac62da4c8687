//! One sound track: its description, its edits and its tables together.

use std::sync::Arc;

use super::QuicktimeError;
use super::aac_config::{HalfRateAac, opus_pre_skip_frames};
use super::boxes::{Boxes, FourCc, be_u16, be_u32, be_u64, find, require};
use super::edits::{Edits, edits_from_elst};
use super::sample_table::{Packets, SampleTable};
use super::sound_description::{SoundDescription, description_from_stsd};
use crate::pcm_layout::PcmLayout;

/// Largest number of channels of a PCM track.
const PCM_CHANNELS_MAX: u16 = 256;

/// A sound track of a movie.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AudioTrack {
    pub(crate) track_id: u32,
    /// Type of the sample entry: `mp4a`, `sowt`, `alac` and so on.
    pub(crate) codec: [u8; 4],
    /// The object type of `mp4a`: 0x40 MPEG-4 AAC, 0x66 to 0x68 MPEG-2 AAC, 0x69 and 0x6b MP3.
    pub(crate) mp4_object_type: Option<u8>,
    /// Rate of the recorded sound. For HE-AAC this is the rate with SBR: see `half_rate_aac`.
    pub(crate) sample_rate_hz: f64,
    pub(crate) channel_count: u16,
    /// Whether the track is switched on (`tkhd` flag 1).
    pub(crate) is_enabled: bool,
    /// Time of the first kept frame on the clock of the movie: the length of the empty edits.
    pub(crate) start_s: f64,
    /// Frames at the start of the decoder's output that are not played (priming), at `sample_rate_hz`.
    pub(crate) skip_frames: u64,
    /// Frames to keep after the priming frames, at `sample_rate_hz`, if the decoder produces as many. `None` for all.
    pub(crate) kept_frames: Option<u64>,
    /// The edit list plays more than one part, or at another speed; `skip_frames` and `kept_frames` describe the first part.
    pub(crate) has_more_edits: bool,
    /// Frames by the tables, priming included, at `sample_rate_hz`. `None` where the tables are empty.
    pub(crate) declared_frames: Option<u64>,
    /// The track is HE-AAC, and a decoder without SBR produces another rate.
    pub(crate) half_rate_aac: Option<HalfRateAac>,
    /// The layout of uncompressed samples, where `PcmReader` reads them.
    pub(crate) pcm: Option<PcmLayout>,
    /// Configuration of the decoder. AAC: AudioSpecificConfig. Opus: payload of `dOps`, big endian, without "OpusHead". ALAC: the 24
    /// bytes of ALACSpecificConfig. FLAC: the 34 bytes of STREAMINFO. AC-3, AMR: payload of their box.
    pub(crate) codec_config: Vec<u8>,
    /// The samples are in another file (a reference movie), which is not read.
    pub(crate) is_data_elsewhere: bool,
    /// Ticks per second of `PacketPosition::duration_ticks`.
    pub(crate) timescale_hz: u32,
    pub(super) table: Arc<SampleTable>,
    pub(super) file_len: u64,
}

impl AudioTrack {
    /// The packets of the track that lie completely in the file, in the order of the table. They are computed during the iteration:
    /// collect them only where their number is known to be small, since a malicious file can have one for every byte.
    pub(crate) fn packets(&self) -> Packets {
        Arc::clone(&self.table).packets(if self.is_data_elsewhere { 0 } else { self.file_len })
    }

    /// Position of the last byte of the track by its tables.
    pub(crate) fn tables_end(&self) -> u64 {
        if self.is_data_elsewhere { 0 } else { self.table.end_offset() }
    }
}

/// Ticks per second of the movie's clock (`mvhd`).
pub(super) fn movie_timescale_hz(moov: &[u8]) -> Result<u32, QuicktimeError> {
    let timescale_hz = find(moov, b"mvhd")?.and_then(timescale_and_duration).map(|(timescale_hz, _)| timescale_hz);
    timescale_hz.ok_or(QuicktimeError::Damaged { what: "its movie header (mvhd)" })
}

/// Reads a track. `None` for one that is not sound.
pub(super) fn track_from_trak(
    trak: &[u8],
    movie_timescale_hz: u32,
    is_fragmented: bool,
    file_len: u64,
) -> Result<Option<AudioTrack>, QuicktimeError> {
    let Some(mdia) = find(trak, b"mdia")? else { return Ok(None) };
    let handler: Option<FourCc> = find(mdia, b"hdlr")?.and_then(|hdlr| super::boxes::four_cc(hdlr, 8));
    if handler != Some(*b"soun") {
        return Ok(None);
    }
    let (timescale_hz, media_ticks) = timescale_and_duration(require(mdia, b"mdhd")?)
        .ok_or(QuicktimeError::Damaged { what: "the header of a sound track (mdhd)" })?;
    let minf = require(mdia, b"minf")?;
    let stbl = require(minf, b"stbl")?;
    let mut description = description_from_stsd(require(stbl, b"stsd")?)?;
    description.rate_hz = rate_hz(&description, timescale_hz);
    let half_rate_aac = half_rate_aac(&mut description, timescale_hz);

    let mut table = SampleTable::from_stbl(stbl)?;
    let is_data_elsewhere = is_data_elsewhere(minf, description.data_reference)?;
    let is_readable = !is_fragmented && !is_data_elsewhere && !table.has_mixed_descriptions;
    let pcm = description.pcm.filter(|_| is_readable && (1..=PCM_CHANNELS_MAX).contains(&description.channel_count));
    let frame_bytes = pcm.map(|pcm| u64::from(description.channel_count) * u64::from(pcm.sample_bytes));
    correct_sample_size(&mut table, &description, frame_bytes, timescale_hz);

    let clock = Clock { rate_hz: description.rate_hz, timescale_hz, movie_timescale_hz };
    let edits = match find(trak, b"edts")? {
        Some(edts) => find(edts, b"elst")?.map(edits_from_elst).unwrap_or_default(),
        None => Edits::default(),
    };
    let declared_frames = match frame_bytes {
        _ if table.is_empty() => (media_ticks > 0 && !is_fragmented).then(|| clock.frames(media_ticks)),
        Some(frame_bytes) => Some(table.whole_frames(frame_bytes)),
        None => Some(clock.frames(table.duration_ticks())),
    };
    let skip_frames = skip_frames(&edits, &description, &clock);
    let tkhd = find(trak, b"tkhd")?.unwrap_or_default();
    Ok(Some(AudioTrack {
        track_id: be_u32(tkhd, if tkhd.first() == Some(&1) { 20 } else { 12 }).unwrap_or(0),
        codec: description.codec,
        mp4_object_type: description.esds.as_ref().map(|esds| esds.object_type),
        sample_rate_hz: description.rate_hz,
        channel_count: description.channel_count,
        is_enabled: tkhd.get(3).is_none_or(|flags| flags & 1 == 1),
        start_s: edits.wait_movie_ticks as f64 / f64::from(movie_timescale_hz),
        skip_frames,
        kept_frames: kept_frames(&edits, &clock, declared_frames, skip_frames, table.is_last_sample_short()),
        has_more_edits: edits.has_more,
        declared_frames,
        half_rate_aac,
        pcm,
        codec_config: description.codec_config,
        is_data_elsewhere,
        timescale_hz,
        table: Arc::new(table),
        file_len,
    }))
}

/// Timescale and duration of `mvhd` and `mdhd`, which start alike. `None` where damaged or 0 ticks per second.
fn timescale_and_duration(payload: &[u8]) -> Option<(u32, u64)> {
    let (timescale_hz, duration) = match payload.first()? {
        1 => (be_u32(payload, 20)?, be_u64(payload, 24)?),
        _ => (be_u32(payload, 12)?, u64::from(be_u32(payload, 16)?)),
    };
    // All ones: unknown.
    let is_unknown = duration == u64::MAX || (payload.first() != Some(&1) && duration == u64::from(u32::MAX));
    (timescale_hz > 0).then_some((timescale_hz, if is_unknown { 0 } else { duration }))
}

/// The rate of the entry. Its 16 integer bits cannot hold 96 000 Hz: then the timescale is the rate.
fn rate_hz(description: &SoundDescription, timescale_hz: u32) -> f64 {
    let timescale = f64::from(timescale_hz);
    let is_wrapped = timescale_hz > 65_535 && description.rate_hz == f64::from(timescale_hz % 65_536);
    if description.rate_hz < 1.0 || is_wrapped { timescale } else { description.rate_hz }
}

/// Detects HE-AAC and sets the rate of the description to the rate of the sound.
fn half_rate_aac(description: &mut SoundDescription, timescale_hz: u32) -> Option<HalfRateAac> {
    let aac = description.aac?;
    let half = aac.half_rate(description.rate_hz).or_else(|| aac.half_rate(f64::from(timescale_hz)));
    description.rate_hz = half.map_or(f64::from(aac.core_rate_hz), |half| half.output_rate_hz);
    half
}

/// Whether the data reference (`dref`) of the entry points to another file: flag 1 means this file.
fn is_data_elsewhere(minf: &[u8], index: u16) -> Result<bool, QuicktimeError> {
    let Some(dinf) = find(minf, b"dinf")? else { return Ok(false) };
    let Some(dref) = find(dinf, b"dref")? else { return Ok(false) };
    let entry = Boxes::new(dref.get(8..).unwrap_or_default()).nth(usize::from(index.saturating_sub(1))).transpose()?;
    // Version, then 24 bits of flags. QuickTime writes `alis` entries for the file itself with the flag set, too.
    Ok(entry.is_some_and(|(_, content)| be_u16(content, 2).is_some_and(|flags| flags & 1 == 0)))
}

/// Corrects the constant sample size that QuickTime writes for tracks whose "samples" are single frames.
///
/// Uncompressed: 1, or the bytes of one channel, where a frame has more. Version 1 with constant packets: the size of an uncompressed
/// sample, where the file has packets.
fn correct_sample_size(
    table: &mut SampleTable,
    description: &SoundDescription,
    frame_bytes: Option<u64>,
    timescale_hz: u32,
) {
    let Some(stated) = table.constant_size_bytes() else { return };
    match (frame_bytes, description.packet) {
        (Some(frame_bytes), _) => {
            let ticks = f64::from(table.first_duration_ticks().unwrap_or(1));
            let frames = (ticks * description.rate_hz / f64::from(timescale_hz)).round();
            // A sample can be a block of frames (ISO/IEC 23003-5); its duration is then that of the block.
            let is_block = stated > frame_bytes && stated % frame_bytes == 0 && frames > 1.0;
            table.correct_constant_size(if is_block { stated } else { frame_bytes }, 1);
        }
        (None, Some((packet_frames, packet_bytes))) if stated <= 4 && packet_frames > 1 => {
            table.correct_constant_size(u64::from(packet_bytes), u64::from(packet_frames));
        }
        _ => {}
    }
}

/// The clocks of a track.
struct Clock {
    rate_hz: f64,
    timescale_hz: u32,
    movie_timescale_hz: u32,
}

impl Clock {
    /// Ticks of the track's timescale as frames.
    fn frames(&self, media_ticks: u64) -> u64 {
        to_frames(media_ticks, self.rate_hz, self.timescale_hz)
    }

    /// Ticks of the movie's timescale as frames.
    fn frames_of_movie_ticks(&self, movie_ticks: u64) -> u64 {
        to_frames(movie_ticks, self.rate_hz, self.movie_timescale_hz)
    }

    /// Frames of one movie tick, rounded up: the tolerance of a length in movie ticks.
    fn movie_tick_frames(&self) -> u64 {
        (self.rate_hz / f64::from(self.movie_timescale_hz)).ceil() as u64
    }
}

/// Exact where timescale and rate are equal, else rounded to a frame. A float beyond the range of `u64` saturates.
fn to_frames(ticks: u64, rate_hz: f64, timescale_hz: u32) -> u64 {
    if rate_hz == f64::from(timescale_hz) {
        return ticks;
    }
    (ticks as f64 * rate_hz / f64::from(timescale_hz)).round() as u64
}

/// Frames before the first played one in the output of the decoder.
///
/// The edit list states them. Opus states the same frames in its own header, which is used where the list is missing or starts earlier.
fn skip_frames(edits: &Edits, description: &SoundDescription, clock: &Clock) -> u64 {
    let by_edit = edits.played.map_or(0, |played| clock.frames(played.start_media_ticks));
    let by_header = match &description.codec {
        b"Opus" => opus_pre_skip_frames(&description.codec_config).unwrap_or(0),
        _ => 0,
    };
    by_edit.max(by_header)
}

/// Frames to keep after the skipped ones, where the decoder produces more.
///
/// Two facts cut the end: the length of the edit, with a tolerance of one movie tick, and a last sample with a shorter duration than its
/// packet has frames. Where both agree within the tick, the second is exact.
fn kept_frames(
    edits: &Edits,
    clock: &Clock,
    declared_frames: Option<u64>,
    skip_frames: u64,
    is_last_sample_short: bool,
) -> Option<u64> {
    let by_table = declared_frames?.saturating_sub(skip_frames);
    let by_edit = edits.played.filter(|played| played.length_movie_ticks > 0).map(|played| {
        let end = clock
            .frames(played.start_media_ticks)
            .saturating_add(clock.frames_of_movie_ticks(played.length_movie_ticks));
        end.saturating_sub(skip_frames)
    });
    match by_edit {
        Some(by_edit) if by_edit.saturating_add(clock.movie_tick_frames()) < by_table => Some(by_edit),
        _ => is_last_sample_short.then_some(by_table),
    }
}

#[cfg(test)]
#[path = "track_tests.rs"]
mod tests;
