//! A build without stores.

#[cfg(feature = "archive")]
use super::StoredRecording;
#[cfg(feature = "archive")]
use crate::failure::Failure;
use hovertone_media::{MediaError, OpenOptions, Recording};
use std::path::Path;
#[cfg(feature = "archive")]
use std::path::PathBuf;

const WHAT: &str = "this hovertone was built without stores, so it cannot read addresses such as s3:// or https://";

#[cfg(feature = "archive")]
fn refused(address: &Path) -> Failure {
    let hint = "copy the recordings to a disk, or build hovertone with `cargo build --release --features stores`";
    Failure::usage(format!("{}: {WHAT}", address.display()), hint)
}

/// Refuses.
#[cfg(feature = "archive")]
pub(crate) fn recordings_at(address: &Path) -> Result<Vec<StoredRecording>, Failure> {
    Err(refused(address))
}

/// Refuses.
#[cfg(feature = "archive")]
pub(crate) fn text_of(address: &Path) -> Result<String, Failure> {
    Err(refused(address))
}

/// Refuses names of a list that are addresses.
#[cfg(feature = "archive")]
pub(crate) fn refuse_addresses(names: &[PathBuf]) -> Result<(), Failure> {
    names.iter().find(|name| super::is_address(name)).map_or(Ok(()), |address| Err(refused(address)))
}

/// That of a recording that is not there.
#[cfg(feature = "archive")]
pub(crate) fn state_of(_: &Path) -> String {
    "absent".to_owned()
}

/// Opens nothing.
pub(crate) fn opened(_: &Path, _: &OpenOptions) -> Result<Recording, MediaError> {
    let advice = "copy the file to a disk, or build hovertone with `cargo build --release --features stores`";
    Err(MediaError::AtAddress(format!("{WHAT}; {advice}")))
}
