//! Files that end before the sizes in their headers do, and corrected sizes for a demuxer that would refuse them or not notice.

use std::io::{self, Read, Seek, SeekFrom};

use crate::container::Container;
use crate::source::Patch;

const CHUNKS_MAX: usize = 10_000;

/// Whether a file ends inside its sound by its own sizes, and the sizes with which a demuxer reads up to there.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Clipped {
    pub(crate) is_cut_off: bool,
    pub(crate) patches: Vec<Patch>,
}

/// Compares the sizes of AIFF, CAF and AVI files with the length of the file. Other containers are never clipped here.
pub(crate) fn clipped_from_sizes<R: Read + Seek>(reader: &mut R, container: Container) -> io::Result<Clipped> {
    let file_bytes = reader.seek(SeekFrom::End(0))?;
    match container {
        Container::Aiff => aiff(reader, file_bytes),
        Container::Caf => caf(reader, file_bytes),
        Container::Avi => {
            let declared = bytes_at::<4, _>(reader, 4)?.map_or(0, |size| u64::from(u32::from_le_bytes(size)));
            // Zero and all ones mean that the length was never written.
            let is_known = declared > 0 && declared < u64::from(u32::MAX);
            Ok(Clipped { is_cut_off: is_known && declared + 8 > file_bytes, patches: Vec::new() })
        }
        _ => Ok(Clipped::default()),
    }
}

fn aiff<R: Read + Seek>(reader: &mut R, file_bytes: u64) -> io::Result<Clipped> {
    let mut at = 12;
    for _ in 0..CHUNKS_MAX {
        let Some(head) = bytes_at::<8, _>(reader, at)? else { break };
        let size = u64::from(u32::from_be_bytes([head[4], head[5], head[6], head[7]]));
        if head.starts_with(b"SSND") && at + 8 + size > file_bytes {
            let clip = |at: u64, size: u64| Patch {
                at,
                bytes: u32::try_from(size).unwrap_or(u32::MAX).to_be_bytes().to_vec(),
            };
            let patches = vec![clip(4, file_bytes - 8), clip(at + 4, file_bytes - at - 8)];
            return Ok(Clipped { is_cut_off: true, patches });
        }
        at += 8 + size.next_multiple_of(2);
    }
    Ok(Clipped::default())
}

fn caf<R: Read + Seek>(reader: &mut R, file_bytes: u64) -> io::Result<Clipped> {
    let mut at: u64 = 8;
    for _ in 0..CHUNKS_MAX {
        let Some(head) = bytes_at::<12, _>(reader, at)? else { break };
        let mut size = [0; 8];
        size.copy_from_slice(&head[4..]);
        let end = u64::try_from(i64::from_be_bytes(size)).ok().and_then(|size| size.checked_add(at + 12));
        match end {
            Some(end) if head.starts_with(b"data") && end > file_bytes => {
                let rest = (file_bytes - at - 12).to_be_bytes().to_vec();
                return Ok(Clipped { is_cut_off: true, patches: vec![Patch { at: at + 4, bytes: rest }] });
            }
            Some(end) => at = end,
            None => break,
        }
    }
    Ok(Clipped::default())
}

fn bytes_at<const N: usize, R: Read + Seek>(reader: &mut R, at: u64) -> io::Result<Option<[u8; N]>> {
    let mut bytes = [0; N];
    reader.seek(SeekFrom::Start(at))?;
    match reader.read_exact(&mut bytes) {
        Ok(()) => Ok(Some(bytes)),
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(None),
        Err(error) => Err(error),
    }
}
