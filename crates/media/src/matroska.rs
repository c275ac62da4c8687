//! Facts of Matroska that Symphonia does not provide: whether the file is complete, and codec name and delay of each audio track. Element
//! numbers: RFC 9559.

use std::io::{self, Read, Seek, SeekFrom};

use crate::source::Patch;

/// Headers and track descriptions are small; no more bytes than this are read.
const TRACKS_BYTES_MAX: u64 = 4 << 20;

const ELEMENTS_BEFORE_CLUSTERS_MAX: usize = 1000;

/// Facts from the beginning of the file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Matroska {
    pub(crate) audio_tracks: Vec<MatroskaTrack>,
    /// Length of the whole recording with its picture.
    pub(crate) duration_s: Option<f64>,
    /// The segment is longer than the file.
    pub(crate) is_truncated: bool,
    /// The segment has no length: a live recording, which can end anywhere.
    pub(crate) has_open_end: bool,
    /// For a truncated file: patches that make the size of the segment unknown and hide the list of elements beyond its end, for which
    /// Symphonia refuses the file.
    pub(crate) patches: Vec<Patch>,
}

/// One audio track.
#[derive(Clone, Debug, Default)]
pub(crate) struct MatroskaTrack {
    pub(crate) number: u64,
    pub(crate) codec_id: String,
    /// Delay that the decoder must drop at the beginning.
    pub(crate) codec_delay_s: f64,
    pub(crate) codec_private: Vec<u8>,
    /// Rate of the decoded sound; 0 where the header has none.
    pub(crate) output_rate_hz: f64,
    pub(crate) channel_count: usize,
}

impl MatroskaTrack {
    pub(crate) fn codec_name(&self) -> String {
        let name = match self.codec_id.as_str() {
            "A_AC3" => "AC-3",
            "A_EAC3" => "E-AC-3",
            "A_DTS" => "DTS",
            "A_TRUEHD" => "TrueHD",
            "A_MPEG/L2" => "MPEG layer 2",
            "A_MPEG/L3" => "MP3",
            "A_OPUS" => "Opus",
            "A_VORBIS" => "Vorbis",
            "A_FLAC" => "FLAC",
            "A_ALAC" => "ALAC",
            "A_TTA1" => "TTA",
            "A_WAVPACK4" => "WavPack",
            id if id.starts_with("A_AAC") => "AAC",
            id if id.starts_with("A_PCM") => "PCM",
            id => return format!("the codec {id}"),
        };
        name.to_owned()
    }
}

/// Reads up to the track descriptions. From a damaged file it returns the facts up to the damage.
pub(crate) fn matroska_from_head<R: Read + Seek>(reader: &mut R) -> io::Result<Matroska> {
    let mut found = Matroska::default();
    let file_bytes = reader.seek(SeekFrom::End(0))?;
    let mut at = 0;
    for _ in 0..ELEMENTS_BEFORE_CLUSTERS_MAX {
        let Some((id, size, body_at)) = element_at(reader, at)? else { break };
        match id {
            SEGMENT => {
                found.is_truncated = size.is_some_and(|size| body_at.saturating_add(size) > file_bytes);
                found.has_open_end = size.is_none();
                found.patches.push(unknown_size_patch(at + SEGMENT_ID_BYTES, body_at));
                at = body_at;
                continue;
            }
            INFO => {
                let body = element_body(reader, body_at, size)?;
                let ticks = children(&body).find(|(id, _)| *id == 0x4489).and_then(|(_, ticks)| float(ticks));
                let scale =
                    children(&body).find(|(id, _)| *id == 0x2ad7b1).map_or(1_000_000, |(_, scale)| unsigned(scale));
                found.duration_s = ticks.map(|ticks| ticks * scale as f64 / 1e9).filter(|seconds| *seconds > 0.0);
            }
            SEEK_HEAD => found.patches.extend(size.map(|size| void_patch(at, body_at, size))),
            TRACKS => {
                let body = element_body(reader, body_at, size)?;
                found.audio_tracks = children(&body)
                    .filter(|(id, _)| *id == TRACK_ENTRY)
                    .filter_map(|(_, entry)| audio_track(entry))
                    .collect();
                break;
            }
            _ => {}
        }
        at = match size.and_then(|size| body_at.checked_add(size)) {
            Some(next) if next < file_bytes => next,
            _ => break,
        };
    }
    if !found.is_truncated {
        found.patches.clear();
    }
    Ok(found)
}

fn element_body<R: Read + Seek>(reader: &mut R, body_at: u64, size: Option<u64>) -> io::Result<Vec<u8>> {
    let mut body = Vec::new();
    reader.seek(SeekFrom::Start(body_at))?;
    reader.by_ref().take(size.unwrap_or(0).min(TRACKS_BYTES_MAX)).read_to_end(&mut body)?;
    Ok(body)
}

/// A size with all bits set: unknown.
fn unknown_size_patch(at: u64, end: u64) -> Patch {
    let size_bytes = end.saturating_sub(at).clamp(1, 8);
    let mut bytes = vec![0xff; size_bytes as usize];
    bytes[0] = 0xff >> (size_bytes - 1);
    Patch { at, bytes }
}

/// A `Void` element of the same length. Its identifier is shorter, so its size field is longer.
fn void_patch(at: u64, body_at: u64, body_bytes: u64) -> Patch {
    let head_bytes = body_at.saturating_sub(at).clamp(2, 12);
    let size_bytes = (head_bytes - 1).min(8);
    let size = body_bytes.saturating_add(head_bytes - 1 - size_bytes);
    let marker = 1_u64 << (7 * size_bytes);
    let field = (marker | (size & (marker - 1))).to_be_bytes();
    let mut bytes = vec![VOID];
    bytes.extend_from_slice(&field[8 - size_bytes as usize..]);
    Patch { at, bytes }
}

const SEGMENT_ID_BYTES: u64 = 4;
const VOID: u8 = 0xec;
const SEEK_HEAD: u64 = 0x114d_9b74;
const SEGMENT: u64 = 0x1853_8067;
const INFO: u64 = 0x1549_a966;
const TRACKS: u64 = 0x1654_ae6b;
const TRACK_ENTRY: u64 = 0xae;

fn audio_track(entry: &[u8]) -> Option<MatroskaTrack> {
    let mut track = MatroskaTrack::default();
    let mut kind = 0;
    for (id, body) in children(entry) {
        match id {
            0xd7 => track.number = unsigned(body),
            0x83 => kind = unsigned(body),
            0x86 => track.codec_id = String::from_utf8_lossy(body).trim_end_matches('\0').to_owned(),
            0x56aa => track.codec_delay_s = unsigned(body) as f64 / 1e9,
            0xe1 => {
                // SamplingFrequency, and OutputSamplingFrequency where HE-AAC doubles it.
                let rates =
                    children(body).filter(|(id, _)| matches!(id, 0xb5 | 0x78b5)).filter_map(|(_, rate)| float(rate));
                track.output_rate_hz = rates.fold(0.0, f64::max);
                let channels = children(body).find(|(id, _)| *id == 0x9f).map_or(1, |(_, count)| unsigned(count));
                track.channel_count = usize::try_from(channels).unwrap_or_default();
            }
            0x63a2 => track.codec_private = body.to_vec(),
            _ => {}
        }
    }
    (kind == 2).then_some(track)
}

fn unsigned(body: &[u8]) -> u64 {
    body.iter().take(8).fold(0, |value, byte| (value << 8) | u64::from(*byte))
}

fn float(body: &[u8]) -> Option<f64> {
    match body.len() {
        4 => body.first_chunk().map(|bytes| f64::from(f32::from_be_bytes(*bytes))),
        8 => body.first_chunk().map(|bytes| f64::from_be_bytes(*bytes)),
        _ => None,
    }
}

/// Identifier, size (`None`: unknown) and position of the content of the element at `at`.
fn element_at<R: Read + Seek>(reader: &mut R, at: u64) -> io::Result<Option<(u64, Option<u64>, u64)>> {
    let mut head = Vec::new();
    reader.seek(SeekFrom::Start(at))?;
    reader.by_ref().take(12).read_to_end(&mut head)?;
    Ok(element_head(&head).map(|(id, size, len)| (id, size, at + len as u64)))
}

fn element_head(bytes: &[u8]) -> Option<(u64, Option<u64>, usize)> {
    let id_len = bytes.first()?.leading_zeros() as usize + 1;
    let id = (id_len <= 4).then(|| bytes.get(..id_len)).flatten()?;
    let id = unsigned(id);
    let size_head = *bytes.get(id_len)?;
    let size_len = size_head.leading_zeros() as usize + 1;
    let size = (size_len <= 8).then(|| bytes.get(id_len..id_len + size_len)).flatten()?;
    let mask = (1_u64 << (7 * size_len)) - 1;
    let value = unsigned(size) & mask;
    Some((id, (value != mask).then_some(value), id_len + size_len))
}

/// The elements inside another one; ends at the first that does not fit.
fn children(mut body: &[u8]) -> impl Iterator<Item = (u64, &[u8])> {
    std::iter::from_fn(move || {
        let (id, size, head_len) = element_head(body)?;
        let rest = body.get(head_len..)?;
        let size = usize::try_from(size?).ok()?;
        let content = rest.get(..size)?;
        body = rest.get(size..)?;
        Some((id, content))
    })
}
