//! Recordings at addresses in stores, such as `s3://bucket/flight.wav`. A build without the feature `stores` knows addresses too, so that it can
//! say how to read them.

#[cfg(not(feature = "stores"))]
mod absent;
#[cfg(feature = "stores")]
mod present;

#[cfg(not(feature = "stores"))]
pub(crate) use absent::opened;
#[cfg(all(not(feature = "stores"), feature = "archive"))]
pub(crate) use absent::{recordings_at, refuse_addresses, state_of, text_of};
#[cfg(feature = "stores")]
pub(crate) use present::{opened, recordings_at, refuse_addresses, state_of, text_of};

use std::path::Path;
#[cfg(feature = "archive")]
use std::path::PathBuf;

/// What is in each address, and in no name of a file that is there.
const MARK: &str = "://";

/// A recording in a store.
#[cfg(feature = "archive")]
pub(crate) struct StoredRecording {
    /// Its address.
    pub(crate) path: PathBuf,
    /// What tells it from an earlier one of the same name.
    pub(crate) state: String,
}

/// Whether a name is an address.
pub(crate) fn is_address(path: &Path) -> bool {
    path.to_string_lossy().contains(MARK) && !path.exists()
}
