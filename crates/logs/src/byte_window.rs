//! The bytes of a stream, as many at once as a message needs.

use crate::loss::{Loss, LostPlace};
use std::io::{self, ErrorKind, Read};

/// Bytes held at most. The longest message of all formats has 65 538 bytes.
const WINDOW_BYTES: usize = 1 << 19;

/// A window that moves over a stream.
pub(crate) struct ByteWindow<R> {
    source: R,
    buffer: Vec<u8>,
    from: usize,
    to: usize,
    /// Position of `from` in the stream.
    offset: u64,
    is_at_end: bool,
}

impl<R: Read> ByteWindow<R> {
    pub(crate) fn new(source: R) -> Self {
        Self { source, buffer: vec![0; WINDOW_BYTES], from: 0, to: 0, offset: 0, is_at_end: false }
    }

    /// The bytes ahead: at least `wanted` of them, or all up to the end of the stream. `wanted` is at most half of the window.
    pub(crate) fn ahead(&mut self, wanted: usize) -> io::Result<&[u8]> {
        if self.to - self.from < wanted && !self.is_at_end {
            self.fill()?;
        }
        Ok(&self.buffer[self.from..self.to])
    }

    /// Moves the bytes ahead to the front of the buffer, and fills the rest.
    fn fill(&mut self) -> io::Result<()> {
        self.buffer.copy_within(self.from..self.to, 0);
        self.to -= self.from;
        self.from = 0;
        while self.to < self.buffer.len() {
            match self.source.read(&mut self.buffer[self.to..]) {
                Ok(0) => {
                    self.is_at_end = true;
                    break;
                }
                Ok(count) => self.to += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// Leaves bytes behind.
    pub(crate) fn consume(&mut self, count: usize) {
        let count = count.min(self.to - self.from);
        self.from += count;
        self.offset += count as u64;
    }

    /// Number of bytes that lie behind.
    pub(crate) fn offset(&self) -> u64 {
        self.offset
    }

    /// Goes to the next place, behind the present one, at which `goes_on` holds, or to the end. `lookahead` is the number of bytes that
    /// `goes_on` needs to decide. The bytes in between are lost.
    pub(crate) fn skip_damage(
        &mut self,
        lookahead: usize,
        after_s: Option<f64>,
        loss: &mut Loss,
        goes_on: impl Fn(&[u8]) -> bool,
    ) -> io::Result<()> {
        let from_byte = self.offset;
        self.consume(1);
        loop {
            self.ahead(WINDOW_BYTES / 2)?;
            let searched = if self.is_at_end { self.to - self.from } else { (self.to - self.from) - lookahead };
            let ahead = &self.buffer[self.from..self.to];
            let found = (0..searched).find(|&at| goes_on(&ahead[at..]));
            self.consume(found.unwrap_or(searched));
            if found.is_some() || self.is_at_end && self.from == self.to {
                break;
            }
        }
        loss.add(LostPlace { from_byte, bytes: self.offset - from_byte, after_s });
        Ok(())
    }
}

/// A window as a source of bytes, for readers that need no lookahead.
impl<R: Read> Read for ByteWindow<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let ahead = self.ahead(1)?;
        let count = ahead.len().min(into.len());
        into[..count].copy_from_slice(&ahead[..count]);
        self.consume(count);
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A source that gives few bytes at once.
    struct Slow<'a>(&'a [u8]);

    impl Read for Slow<'_> {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            let count = self.0.len().min(into.len()).min(4099);
            into[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    #[test]
    fn all_bytes_pass_in_their_sequence() {
        let bytes: Vec<u8> = (0..3 * WINDOW_BYTES + 17).map(|at| (at % 251) as u8).collect();
        let mut window = ByteWindow::new(Slow(&bytes));
        let mut passed = 0;
        loop {
            let ahead = window.ahead(1000).unwrap();
            if ahead.is_empty() {
                break;
            }
            let count = ahead.len().min(777);
            assert_eq!(ahead[..count], bytes[passed..passed + count]);
            passed += count;
            window.consume(count);
        }
        assert_eq!((passed, window.offset()), (bytes.len(), bytes.len() as u64));
    }

    #[test]
    fn damage_ends_where_reading_goes_on_however_long_it_is() {
        let mut bytes = vec![0; 2 * WINDOW_BYTES];
        bytes.extend([1, 2, 3]);
        let mut window = ByteWindow::new(Slow(&bytes));
        let mut loss = Loss::default();
        window.skip_damage(2, None, &mut loss, |ahead| ahead.starts_with(&[1, 2])).unwrap();
        assert_eq!(window.ahead(1).unwrap(), [1, 2, 3]);
        assert_eq!((loss.lost_bytes, loss.place_count), (2 * WINDOW_BYTES as u64, 1));
        window.skip_damage(2, None, &mut loss, |ahead| ahead.starts_with(&[1, 2])).unwrap();
        assert!(window.ahead(1).unwrap().is_empty());
    }
}
