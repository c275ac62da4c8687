//! Iteration over boxes: the records of length and name that every QuickTime and MP4 file consists of.
//!
//! ISO/IEC 14496-12 section 4.2 calls them boxes, the QuickTime File Format calls them atoms. The header is a big-endian
//! 32-bit size that includes the header, then a four-character type. Size 1 means that a 64-bit size follows the type,
//! size 0 that the box runs to the end of what holds it.

use std::io::{Read, Seek, SeekFrom};

use super::QuicktimeError;

/// The name of a box, a codec or a handler: four bytes, mostly ASCII.
pub(super) type FourCc = [u8; 4];

/// Largest movie index that is read into memory, bytes. Two hours of video at 60 frames per second with sound need about 10 MB; a larger
/// index belongs to no recording.
const MOOV_BYTES_MAX: u64 = 256 << 20;

/// Largest number of boxes before `moov`. A fragmented file has a few per second of video, but it starts with `moov`; a malicious file
/// can have one for every eight bytes.
const TOP_LEVEL_BOXES_MAX: usize = 100_000;

/// The top level of the file.
pub(super) enum TopLevel {
    /// The first bytes are no box with which a file of this family starts.
    NotThisFormat,
    /// The payload of `moov`.
    Moov(Vec<u8>),
}

/// The types with which a QuickTime or MP4 file can start. Files from before 2001 have no `ftyp`.
fn may_start_a_file(kind: FourCc) -> bool {
    matches!(
        &kind,
        b"ftyp"
            | b"moov"
            | b"mdat"
            | b"wide"
            | b"free"
            | b"skip"
            | b"pnot"
            | b"uuid"
            | b"styp"
            | b"moof"
            | b"sidx"
            | b"pdin"
    )
}

/// Reads the top level of a file of `file_len` bytes up to the first `moov`, wherever it is, and returns its payload.
pub(super) fn find_moov<R: Read + Seek>(reader: &mut R, file_len: u64) -> Result<TopLevel, QuicktimeError> {
    let mut offset = 0_u64;
    for index in 0..TOP_LEVEL_BOXES_MAX {
        let room = file_len.saturating_sub(offset);
        if room < 8 {
            return match index {
                0 => Ok(TopLevel::NotThisFormat),
                _ => Err(QuicktimeError::NoMoov { cut_in: None }),
            };
        }
        reader.seek(SeekFrom::Start(offset))?;
        let mut header = [0_u8; 16];
        reader.read_exact(&mut header[..8])?;
        let (size_32, kind) = size_and_kind(&header);
        let mut header_len = 8_u64;
        let size = match size_32 {
            0 => room,
            1 if room >= 16 => {
                reader.read_exact(&mut header[8..])?;
                header_len = 16;
                be_u64(&header, 8).unwrap_or(0)
            }
            1 => 0,
            size => u64::from(size),
        };
        if index == 0 {
            let plausible = size >= header_len && (size <= room || matches!(&kind, b"mdat" | b"moov" | b"ftyp"));
            if !may_start_a_file(kind) || (!plausible && &kind != b"ftyp") {
                return Ok(TopLevel::NotThisFormat);
            }
        }
        if size < header_len {
            return Err(QuicktimeError::BoxSize { kind, size, room });
        }
        if &kind == b"moov" {
            let payload_len = size - header_len;
            if size > room {
                return Err(QuicktimeError::MoovCut { size, room });
            }
            if payload_len > MOOV_BYTES_MAX {
                return Err(QuicktimeError::MoovTooLarge { size, max: MOOV_BYTES_MAX });
            }
            let len =
                usize::try_from(payload_len).map_err(|_| QuicktimeError::MoovTooLarge { size, max: MOOV_BYTES_MAX })?;
            // The length is inside the file and below the limit, which bounds this allocation.
            let mut payload = vec![0_u8; len];
            reader.read_exact(&mut payload)?;
            return Ok(TopLevel::Moov(payload));
        }
        if size > room {
            return Err(QuicktimeError::NoMoov { cut_in: Some(kind) });
        }
        offset += size;
    }
    Err(QuicktimeError::NoMoov { cut_in: None })
}

/// The boxes inside a payload, in order. Ends after the first damaged one.
pub(super) struct Boxes<'a> {
    rest: &'a [u8],
}

impl<'a> Boxes<'a> {
    /// The boxes of `payload`.
    pub(super) fn new(payload: &'a [u8]) -> Self {
        Self { rest: payload }
    }
}

impl<'a> Iterator for Boxes<'a> {
    type Item = Result<(FourCc, &'a [u8]), QuicktimeError>;

    fn next(&mut self) -> Option<Self::Item> {
        // Fewer bytes than a header are padding; QuickTime ends some lists with four zero bytes.
        if self.rest.len() < 8 {
            return None;
        }
        let (size_32, kind) = size_and_kind(self.rest);
        let room = self.rest.len();
        let (size, header_len) = match size_32 {
            0 => (room as u64, 8),
            1 => (be_u64(self.rest, 8).unwrap_or(0), 16),
            size => (u64::from(size), 8),
        };
        let size_in_room = usize::try_from(size).ok().filter(|size| (header_len..=room).contains(size));
        let Some(size_in_room) = size_in_room else {
            self.rest = &[];
            return Some(Err(QuicktimeError::BoxSize { kind, size, room: room as u64 }));
        };
        let (whole, rest) = self.rest.split_at(size_in_room);
        self.rest = rest;
        Some(Ok((kind, &whole[header_len..])))
    }
}

/// The payload of the first box of type `kind` directly inside `payload`.
pub(super) fn find<'a>(payload: &'a [u8], kind: &FourCc) -> Result<Option<&'a [u8]>, QuicktimeError> {
    for item in Boxes::new(payload) {
        let (found, content) = item?;
        if &found == kind {
            return Ok(Some(content));
        }
    }
    Ok(None)
}

/// [`find`] for a mandatory box.
pub(super) fn require<'a>(payload: &'a [u8], kind: &FourCc) -> Result<&'a [u8], QuicktimeError> {
    find(payload, kind)?.ok_or(QuicktimeError::MissingBox { kind: *kind })
}

fn size_and_kind(header: &[u8]) -> (u32, FourCc) {
    (be_u32(header, 0).unwrap_or(0), four_cc(header, 4).unwrap_or_default())
}

/// `N` bytes at `at`, if they exist.
fn bytes_at<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..at.checked_add(N)?)?.try_into().ok()
}

/// The four-character code at `at`.
pub(super) fn four_cc(bytes: &[u8], at: usize) -> Option<FourCc> {
    bytes_at(bytes, at)
}

/// Big-endian unsigned 16-bit number at `at`.
pub(super) fn be_u16(bytes: &[u8], at: usize) -> Option<u16> {
    bytes_at(bytes, at).map(u16::from_be_bytes)
}

/// Big-endian unsigned 32-bit number at `at`.
pub(super) fn be_u32(bytes: &[u8], at: usize) -> Option<u32> {
    bytes_at(bytes, at).map(u32::from_be_bytes)
}

/// Big-endian unsigned 64-bit number at `at`.
pub(super) fn be_u64(bytes: &[u8], at: usize) -> Option<u64> {
    bytes_at(bytes, at).map(u64::from_be_bytes)
}
