//! A build with stores.

use super::StoredRecording;
use crate::failure::Failure;
use crate::recording_files::has_ending_of_recording;
use hovertone_media::{FileAccess, MediaError, OpenOptions, Recording};
use hovertone_stores::{Address, Patience, Service, StoreError, StoredFile, Stores};
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// The stores of this process: a store keeps its connections from one recording to the next.
static STORES: OnceLock<Stores> = OnceLock::new();

fn stores() -> Result<&'static Stores, StoreError> {
    if let Some(stores) = STORES.get() {
        return Ok(stores);
    }
    let made = Stores::new(Patience::default())?;
    Ok(STORES.get_or_init(|| made))
}

fn address_of(path: &Path) -> Result<Address, StoreError> {
    Address::parse(&path.to_string_lossy())
}

fn failure(error: &StoreError, path: &Path) -> Failure {
    match error {
        StoreError::BadAddress(why) => Failure::usage(format!("{}: {why}", path.display()), error.hint()),
        _ => Failure::failed(error.to_string(), error.hint(), path),
    }
}

/// The recording at an address, or all recordings below it.
pub(crate) fn recordings_at(path: &Path) -> Result<Vec<StoredRecording>, Failure> {
    recordings(path).map_err(|error| failure(&error, path))
}

fn recordings(path: &Path) -> Result<Vec<StoredRecording>, StoreError> {
    let (address, stores) = (address_of(path)?, stores()?);
    let stored = |listed: hovertone_stores::Listed| StoredRecording {
        path: PathBuf::from(listed.address.text()),
        state: listed.state,
    };
    let is_web = address.service() == Service::Web;
    if !address.is_folder() && (is_web || has_ending_of_recording(path)) {
        match stores.found(&address) {
            // in a bucket, a folder may be named as a recording
            Err(StoreError::NotFound) if !is_web => {}
            found => return Ok(vec![stored(found?)]),
        }
    }
    let below = stores.below(&address)?.into_iter().map(stored);
    Ok(below.filter(|recording| has_ending_of_recording(&recording.path)).collect())
}

/// The text at an address.
pub(crate) fn text_of(path: &Path) -> Result<String, Failure> {
    let mut text = String::new();
    let file = file_at(path).map_err(|error| failure(&error, path))?;
    match file.open().and_then(|mut file| file.read_to_string(&mut text)) {
        Ok(_) => Ok(text),
        Err(error) if error.kind() == ErrorKind::InvalidData && error.get_ref().is_none() => {
            let what = "this list is no text in UTF-8";
            Err(Failure::failed(what, "save the list as UTF-8", path))
        }
        // an error of a store brings its own advice
        Err(error) if error.get_ref().is_some() => {
            Err(Failure::failed(format!("this list cannot be read: {error}"), "", path))
        }
        Err(error) => Err(Failure::failed(
            format!("this list cannot be read: {error}"),
            "check the address and the connection",
            path,
        )),
    }
}

/// Addresses may stand in a list.
pub(crate) fn refuse_addresses(_: &[PathBuf]) -> Result<(), Failure> {
    Ok(())
}

/// Length and tag of a recording. They stand in no table.
pub(crate) fn state_of(path: &Path) -> String {
    let found = address_of(path).and_then(|address| stores()?.found(&address));
    found.map_or_else(|_| "absent".to_owned(), |listed| listed.state)
}

fn file_at(path: &Path) -> Result<StoredFile, StoreError> {
    stores()?.file(&address_of(path)?)
}

/// Opens a recording.
pub(crate) fn opened(path: &Path, options: &OpenOptions) -> Result<Recording, MediaError> {
    let file = file_at(path).map_err(|error| match error {
        StoreError::NotFound => MediaError::CannotOpen(error.into()),
        _ => MediaError::Read(error.into()),
    })?;
    Recording::open_file(Arc::new(file), options)
}
