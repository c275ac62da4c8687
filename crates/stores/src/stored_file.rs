//! A file in a store, read as one on a disk: blocks are fetched as they are asked for.

use crate::blocks::{BLOCK_BYTES, Blocks, range_of};
use crate::error::StoreError;
use crate::opened::Patience;
use bytes::Bytes;
use hovertone_media::{FileAccess, OpenFile};
use object_store::path::Path as Key;
use object_store::{GetOptions, GetRange, ObjectStore};
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};
use tokio::runtime::Runtime;

/// A file in a store, with its length. All that open it share the blocks that are kept.
#[derive(Debug)]
pub struct StoredFile {
    shared: Arc<Shared>,
}

/// What a stored file is made of.
#[derive(Debug)]
pub(crate) struct Shared {
    /// Its address as text.
    pub(crate) name: PathBuf,
    pub(crate) store: Arc<dyn ObjectStore>,
    pub(crate) key: Key,
    /// Its length, when it was found.
    pub(crate) size: u64,
    /// What tells it from another file of its name, where the store says so.
    pub(crate) tag: Option<String>,
    pub(crate) runtime: Arc<Runtime>,
    pub(crate) patience: Patience,
    pub(crate) blocks: Mutex<Blocks>,
    /// The first failure, which stays.
    pub(crate) failure: OnceLock<StoreError>,
}

impl StoredFile {
    pub(crate) fn of(shared: Shared) -> Self {
        Self { shared: Arc::new(shared) }
    }
}

impl FileAccess for StoredFile {
    fn open(&self) -> io::Result<OpenFile> {
        Ok(Box::new(Reader { shared: Arc::clone(&self.shared), position: 0 }))
    }

    fn name(&self) -> &Path {
        &self.shared.name
    }

    fn failure(&self) -> Option<io::Error> {
        self.shared.failure.get().cloned().map(io::Error::from)
    }
}

impl Shared {
    /// A block, fetched where it is not kept.
    fn block(&self, number: u64) -> Result<Bytes, StoreError> {
        let blocks = || self.blocks.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(bytes) = blocks().get(number) {
            return Ok(bytes);
        }
        let fetched = self.runtime.block_on(self.fetched(range_of(number, self.size)));
        let bytes = fetched.inspect_err(|error| {
            // the first failure is kept where there is one already
            let _ = self.failure.set(error.clone());
        })?;
        blocks().keep(number, bytes.clone());
        Ok(bytes)
    }

    /// A range of bytes, whole. `object_store` repeats requests without an answer, and goes on where an answer with a tag broke off; those
    /// without a tag are repeated here.
    async fn fetched(&self, range: Range<u64>) -> Result<Bytes, StoreError> {
        let mut pause = Duration::from_secs_f64(self.patience.pause_s);
        let until = Instant::now() + Duration::from_secs_f64(self.patience.answer_s_max);
        let mut retries = 0;
        loop {
            let error = match self.attempt(range.clone()).await {
                Ok(bytes) if bytes.len() as u64 == range.end - range.start => return Ok(bytes),
                Ok(_) => StoreError::CutShort,
                Err(error) => error,
            };
            let may_repeat = self.tag.is_none() && error.is_broken_off();
            if !may_repeat || retries == self.patience.retries_max || Instant::now() > until {
                return Err(error);
            }
            retries += 1;
            tokio::time::sleep(pause).await;
            pause *= 2;
        }
    }

    async fn attempt(&self, range: Range<u64>) -> Result<Bytes, StoreError> {
        let options = GetOptions { range: Some(GetRange::Bounded(range)), ..GetOptions::default() };
        let answer = self.store.get_opts(&self.key, options).await?;
        if answer.meta.size != self.size || (self.tag.is_some() && answer.meta.e_tag != self.tag) {
            return Err(StoreError::Changed);
        }
        Ok(answer.bytes().await?)
    }
}

/// An open file with its position.
#[derive(Debug)]
struct Reader {
    shared: Arc<Shared>,
    position: u64,
}

impl Read for Reader {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.position >= self.shared.size || buffer.is_empty() {
            return Ok(0);
        }
        let block = self.shared.block(self.position / BLOCK_BYTES)?;
        let from = usize::try_from(self.position % BLOCK_BYTES).map_err(io::Error::other)?;
        let there = block.get(from..).unwrap_or_default();
        let count = there.len().min(buffer.len());
        let (filled, there) = (buffer.get_mut(..count), there.get(..count));
        if let (Some(filled), Some(there)) = (filled, there) {
            filled.copy_from_slice(there);
        }
        self.position += count as u64;
        Ok(count)
    }
}

impl Seek for Reader {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let target = match to {
            SeekFrom::Start(position) => Some(position),
            SeekFrom::Current(step) => self.position.checked_add_signed(step),
            SeekFrom::End(step) => self.shared.size.checked_add_signed(step),
        };
        let outside = || io::Error::new(io::ErrorKind::InvalidInput, "a position outside of the file");
        self.position = target.ok_or_else(outside)?;
        Ok(self.position)
    }
}
