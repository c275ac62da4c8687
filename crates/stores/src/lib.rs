//! Recordings in object stores (`s3://`, `gs://`, `az://`) and on web servers (`http://`, `https://`), read as files are.
//!
//! [`Address`] is a name in a store, [`Stores`] lists and finds, [`StoredFile`] reads: ranges of bytes as they are asked for, with a small cache.
//! Everything asynchronous stays inside of this crate.

mod address;
mod blocks;
mod error;
mod opened;
mod stored_file;
mod stores;

pub use address::{Address, Service};
pub use error::StoreError;
pub use opened::Patience;
pub use stored_file::StoredFile;
pub use stores::{Listed, Stores};
