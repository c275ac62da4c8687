//! The stores of a run: what is in them, and the files to read.

use crate::address::{Address, Service};
use crate::blocks::Blocks;
use crate::error::StoreError;
use crate::opened::{Patience, store_of};
use crate::stored_file::{Shared, StoredFile};
use futures_util::TryStreamExt;
use object_store::{ObjectMeta, ObjectStore, ObjectStoreExt};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use tokio::runtime::{Builder, Runtime};

/// Threads that carry bytes; the threads that ask wait for them.
const CARRIERS: usize = 2;

/// Something in a store.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listed {
    /// Its address.
    pub address: Address,
    /// Its length and its tag or time, by which a file that changed is known.
    pub state: String,
}

/// Stores by their buckets, each opened once.
pub struct Stores {
    runtime: Arc<Runtime>,
    patience: Patience,
    opened: Mutex<BTreeMap<String, Arc<dyn ObjectStore>>>,
}

impl Stores {
    /// Without a store yet.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn new(patience: Patience) -> Result<Self, StoreError> {
        // fails where a program has chosen already, and then that holds
        let _ = rustls::crypto::ring::default_provider().install_default();
        let built = Builder::new_multi_thread().worker_threads(CARRIERS).enable_all().build();
        let runtime =
            built.map_err(|error| StoreError::Other(format!("the system could not start a thread: {error}")))?;
        Ok(Self { runtime: Arc::new(runtime), patience, opened: Mutex::default() })
    }

    fn store(&self, address: &Address) -> Result<Arc<dyn ObjectStore>, StoreError> {
        let mut opened = self.opened.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(store) = opened.get(&address.root) {
            return Ok(Arc::clone(store));
        }
        let store = store_of(address, self.patience)?;
        opened.insert(address.root.clone(), Arc::clone(&store));
        Ok(store)
    }

    /// All files below a folder at any depth, without hidden ones.
    ///
    /// # Errors
    /// The store cannot be listed.
    pub fn below(&self, folder: &Address) -> Result<Vec<Listed>, StoreError> {
        let store = self.store(folder)?;
        let prefix = (!folder.key.as_ref().is_empty()).then_some(&folder.key);
        let found: Result<Vec<ObjectMeta>, _> = self.runtime.block_on(store.list(prefix).try_collect());
        let found = found.map_err(|error| match StoreError::from(error) {
            StoreError::Status(_) | StoreError::Other(_) if folder.service == Service::Web => StoreError::ListsNothing,
            error => error,
        })?;
        let is_shown = |meta: &ObjectMeta| meta.location.parts().all(|part| !part.as_ref().starts_with('.'));
        let listed = |meta: ObjectMeta| Listed { state: state_of(&meta), address: folder.with_key(meta.location) };
        Ok(found.into_iter().filter(is_shown).map(listed).collect())
    }

    /// The file of an address.
    ///
    /// # Errors
    /// There is none, or the store does not say.
    pub fn found(&self, address: &Address) -> Result<Listed, StoreError> {
        let store = self.store(address)?;
        let meta = self.runtime.block_on(store.head(&address.key))?;
        Ok(Listed { address: address.clone(), state: state_of(&meta) })
    }

    /// A file to read from.
    ///
    /// # Errors
    /// There is none, or the store does not say.
    pub fn file(&self, address: &Address) -> Result<StoredFile, StoreError> {
        let store = self.store(address)?;
        let meta = self.runtime.block_on(store.head(&address.key))?;
        Ok(StoredFile::of(Shared {
            name: PathBuf::from(address.text()),
            store,
            key: address.key.clone(),
            size: meta.size,
            tag: meta.e_tag,
            runtime: Arc::clone(&self.runtime),
            patience: self.patience,
            blocks: Mutex::new(Blocks::default()),
            failure: OnceLock::new(),
        }))
    }
}

fn state_of(meta: &ObjectMeta) -> String {
    // services write a tag with quotation marks in one answer, and without them in another
    match &meta.e_tag {
        Some(tag) => format!("{} {}", meta.size, tag.trim_matches('"')),
        None => format!("{} {}", meta.size, meta.last_modified.timestamp()),
    }
}
