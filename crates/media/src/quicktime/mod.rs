//! The parts of QuickTime and MP4 (ISO/IEC 14496-12) that the sound needs.
//!
//! Symphonia decodes the packets of these files. This module reads what Symphonia does not provide: the start of the sound and the
//! priming frames (edit lists), whether an AAC track plays at half rate, whether the file is shorter than its tables state. It reads
//! uncompressed tracks completely: Symphonia delivers them one frame per packet (a thirtieth of the speed) and takes big-endian `in24`
//! for little-endian.
//!
//! [`read_movie`] finds the index (`boxes`) and reads each sound track in it (`track`, `sound_description`, `aac_config`, `edits`,
//! `sample_table`); `pcm` reads the frames.

use std::io::{self, Read, Seek, SeekFrom};

mod aac_config;
mod boxes;
mod edits;
mod pcm;
mod sample_table;
mod sound_description;
mod track;

#[cfg(test)]
mod movie_builder;
#[cfg(test)]
mod tests;

pub(crate) use aac_config::HalfRateAac;
pub(crate) use pcm::PcmReader;
pub(crate) use sample_table::PacketPosition;
pub(crate) use track::AudioTrack;

use boxes::{Boxes, TopLevel, find, find_moov};

/// The sound of a QuickTime or MP4 file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Movie {
    /// The sound tracks in the order of the file.
    pub(crate) tracks: Vec<AudioTrack>,
    /// The samples are in fragments (`mvex`, `moof`), and the tables are mostly empty.
    pub(crate) is_fragmented: bool,
    /// There are tracks other than sound: video, text, time code.
    pub(crate) has_other_tracks: bool,
    /// Length of the file when it was read.
    file_len: u64,
}

impl Movie {
    /// End of the last byte of sound by the tables. It lies beyond the end of a truncated file.
    #[allow(dead_code, reason = "part of the module's interface; the media crate compares frames instead so far")]
    pub(crate) fn tables_end(&self) -> u64 {
        self.tracks.iter().map(AudioTrack::tables_end).max().unwrap_or(0)
    }

    /// Bytes by which the file is shorter than its sound tables state.
    #[allow(dead_code, reason = "part of the module's interface; the media crate compares frames instead so far")]
    pub(crate) fn missing_bytes(&self) -> u64 {
        self.tables_end().saturating_sub(self.file_len)
    }
}

/// Reads the index of a QuickTime or MP4 file. `None` for any other file.
///
/// # Errors
/// A file of this kind without a usable index; see [`QuicktimeError`].
pub(crate) fn read_movie<R: Read + Seek>(reader: &mut R) -> Result<Option<Movie>, QuicktimeError> {
    let file_len = reader.seek(SeekFrom::End(0))?;
    let moov = match find_moov(reader, file_len)? {
        TopLevel::NotThisFormat => return Ok(None),
        TopLevel::Moov(payload) => payload,
    };
    if find(&moov, b"cmov")?.is_some() {
        return Err(QuicktimeError::CompressedMoov);
    }
    let movie_timescale_hz = track::movie_timescale_hz(&moov)?;
    let is_fragmented = find(&moov, b"mvex")?.is_some();
    let mut movie = Movie { tracks: Vec::new(), is_fragmented, has_other_tracks: false, file_len };
    for item in Boxes::new(&moov) {
        let (kind, content) = item?;
        if &kind != b"trak" {
            continue;
        }
        match track::track_from_trak(content, movie_timescale_hz, is_fragmented, file_len)? {
            Some(track) => movie.tracks.push(track),
            None => movie.has_other_tracks = true,
        }
    }
    Ok(Some(movie))
}

/// HE-AAC by an AudioSpecificConfig from another container (Matroska), in a track whose header has `container_rate_hz`.
pub(crate) fn half_rate_from_config(config: &[u8], container_rate_hz: f64) -> Option<HalfRateAac> {
    aac_config::audio_specific_config(config)?.half_rate(container_rate_hz)
}

/// Reason why the index of a QuickTime or MP4 file cannot be used.
#[derive(Debug, thiserror::Error)]
pub(crate) enum QuicktimeError {
    /// Reading failed.
    #[error("the file cannot be read")]
    Io(#[from] io::Error),
    /// Most recorders write the index last, so it is missing in a truncated recording.
    #[error("it has no index (moov box){}: {NO_MOOV_WHY}", cut_in_text(*cut_in))]
    NoMoov {
        /// The box that continues beyond the end of the file.
        cut_in: Option<[u8; 4]>,
    },
    /// The file ends inside its index.
    #[error("it ends inside its index: the moov box takes {size} bytes and {room} are left")]
    MoovCut {
        /// Stated size of the box in bytes.
        size: u64,
        /// Remaining bytes of the file.
        room: u64,
    },
    /// An index that is too large for any recording.
    #[error("its index (moov box) takes {size} bytes, more than the {max} that are read")]
    MoovTooLarge {
        /// Stated size of the box in bytes.
        size: u64,
        /// The limit.
        max: u64,
    },
    /// QuickTime's compressed index.
    #[error(
        "the MOV file has a compressed index (cmov box), which is not supported: save it again with another program"
    )]
    CompressedMoov,
    /// A box that is smaller than its header or larger than its container.
    #[error("its {} box takes {size} bytes where {room} are left", name(*kind))]
    BoxSize {
        /// Type of the box.
        kind: [u8; 4],
        /// Stated size of the box in bytes.
        size: u64,
        /// Remaining bytes at its position.
        room: u64,
    },
    /// A mandatory box is missing.
    #[error("a sound track has no {} box", name(*kind))]
    MissingBox {
        /// Type of the box.
        kind: [u8; 4],
    },
    /// A part of the index is damaged.
    #[error("{what} cannot be read")]
    Damaged {
        /// The part.
        what: &'static str,
    },
    /// A compressed track in the reader of uncompressed ones.
    #[error("the codec {} is not uncompressed sound", name(*codec))]
    NotPcm {
        /// Name of the codec in the sample description.
        codec: [u8; 4],
    },
}

const NO_MOOV_WHY: &str =
    "the recording was cut off before the index was written, or the file was not copied to its end";

fn cut_in_text(kind: Option<[u8; 4]>) -> String {
    kind.map(|kind| format!(" and ends inside its {} box", name(kind))).unwrap_or_default()
}

/// A four-character code as text. Bytes that are no letters are the mark of damage, and no name.
fn name(kind: [u8; 4]) -> String {
    let is_text = kind.iter().all(|byte| byte.is_ascii_graphic() || *byte == b' ');
    if is_text { format!("'{}'", kind.escape_ascii()) } else { "nameless".to_owned() }
}
