//! The blocks of a file that were read last.

use bytes::Bytes;
use std::collections::VecDeque;
use std::ops::Range;

/// Bytes of a block: a recording of minutes is some requests, and of a film little more than its sound is fetched.
pub(crate) const BLOCK_BYTES: u64 = 1 << 20;
/// Blocks that are kept: a recording of up to 16 MiB is fetched once, however often it is heard.
const BLOCKS_MAX: usize = 16;

/// Blocks by their number, the last one used last.
#[derive(Debug, Default)]
pub(crate) struct Blocks {
    kept: VecDeque<(u64, Bytes)>,
}

impl Blocks {
    /// A block that is there.
    pub(crate) fn get(&mut self, number: u64) -> Option<Bytes> {
        let place = self.kept.iter().position(|(kept, _)| *kept == number)?;
        let block = self.kept.remove(place)?;
        let bytes = block.1.clone();
        self.kept.push_back(block);
        Some(bytes)
    }

    /// Keeps a block, and forgets the one that was not used for the longest time.
    pub(crate) fn keep(&mut self, number: u64, bytes: Bytes) {
        if self.kept.len() == BLOCKS_MAX {
            self.kept.pop_front();
        }
        self.kept.push_back((number, bytes));
    }
}

/// The bytes of a block in a file of this size.
pub(crate) fn range_of(number: u64, size: u64) -> Range<u64> {
    let start = number.saturating_mul(BLOCK_BYTES);
    start..start.saturating_add(BLOCK_BYTES).min(size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_blocks_used_last_are_kept() {
        let mut blocks = Blocks::default();
        for number in 0..BLOCKS_MAX as u64 {
            blocks.keep(number, Bytes::from(vec![number as u8]));
        }
        assert!(blocks.get(0).is_some());
        blocks.keep(99, Bytes::new());
        assert!(blocks.get(0).is_some() && blocks.get(1).is_none() && blocks.get(99).is_some());
    }

    #[test]
    fn the_last_block_ends_with_the_file() {
        assert_eq!(range_of(1, BLOCK_BYTES + 3), BLOCK_BYTES..BLOCK_BYTES + 3);
        assert_eq!(range_of(0, 5 * BLOCK_BYTES), 0..BLOCK_BYTES);
    }
}
