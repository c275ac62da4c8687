//! Whether an Ogg file ends in the middle of a page. Page layout: RFC 3533, 6.

use std::io::{self, Read, Seek, SeekFrom};

/// Bytes of the longest page: 27 bytes, 255 segment lengths, 255 segments of 255 bytes.
const PAGE_BYTES_MAX: u64 = 27 + 255 + 255 * 255;

/// Whether the last page is incomplete.
pub(crate) fn last_page_is_cut<R: Read + Seek>(reader: &mut R) -> io::Result<bool> {
    let file_bytes = reader.seek(SeekFrom::End(0))?;
    reader.seek(SeekFrom::Start(file_bytes.saturating_sub(PAGE_BYTES_MAX)))?;
    let mut tail = Vec::new();
    reader.by_ref().take(PAGE_BYTES_MAX).read_to_end(&mut tail)?;
    let Some(at) = tail.windows(4).rposition(|window| window == b"OggS") else { return Ok(false) };
    let page = &tail[at..];
    let Some(&segment_count) = page.get(26) else { return Ok(true) };
    let segments_end = 27 + usize::from(segment_count);
    let Some(segments) = page.get(27..segments_end) else { return Ok(true) };
    let body_len: usize = segments.iter().map(|len| usize::from(*len)).sum();
    Ok(page.len() < segments_end + body_len)
}
