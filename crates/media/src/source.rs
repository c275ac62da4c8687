//! The file as the demuxers read it: from the start of its frames, and with corrected sizes in its header.

use std::io::{self, Read, Seek, SeekFrom};

use symphonia::core::io::{MediaSource, MediaSourceStream, MediaSourceStreamOptions};

use crate::file_access::{FileAccess, OpenFile};

/// Bytes that replace bytes of the file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Patch {
    pub(crate) at: u64,
    pub(crate) bytes: Vec<u8>,
}

/// A file whose first `base` bytes are hidden, since a demuxer would search for frames in tags. Patches replace header fields at which a
/// demuxer would fail.
pub(crate) struct FileView {
    file: OpenFile,
    base: u64,
    len: u64,
    position: u64,
    patches: Vec<Patch>,
}

impl FileView {
    pub(crate) fn open(access: &dyn FileAccess, base: u64, patches: &[Patch]) -> io::Result<Self> {
        let mut file = access.open()?;
        let len = file.seek(SeekFrom::End(0))?.saturating_sub(base);
        file.seek(SeekFrom::Start(base))?;
        Ok(Self { file, base, len, position: base, patches: patches.to_vec() })
    }

    pub(crate) fn into_stream(self) -> MediaSourceStream<'static> {
        // Symphonia needs a power of two above 32 KiB.
        MediaSourceStream::new(Box::new(self), MediaSourceStreamOptions { buffer_len: 128 * 1024 })
    }
}

impl Read for FileView {
    fn read(&mut self, buf: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buf)?;
        let (from, to) = (self.position, self.position + count as u64);
        for Patch { at, bytes } in self.patches.iter().filter(|patch| patch.at < to) {
            for (at, byte) in (*at..to).zip(bytes).filter(|(at, _)| *at >= from) {
                buf[(at - from) as usize] = *byte;
            }
        }
        self.position = to;
        Ok(count)
    }
}

impl Seek for FileView {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let target = match to {
            SeekFrom::Start(position) => position.checked_add(self.base),
            SeekFrom::Current(delta) => self.position.checked_add_signed(delta),
            SeekFrom::End(delta) => self.base.checked_add(self.len).and_then(|end| end.checked_add_signed(delta)),
        };
        let target = target
            .filter(|&target| target >= self.base && i64::try_from(target).is_ok())
            .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "a position outside of the file"))?;
        self.position = self.file.seek(SeekFrom::Start(target))?;
        Ok(self.position - self.base)
    }
}

impl MediaSource for FileView {
    fn is_seekable(&self) -> bool {
        true
    }

    fn byte_len(&self) -> Option<u64> {
        Some(self.len)
    }
}
