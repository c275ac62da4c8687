//! A file of the page. The worker reads it slice by slice, at any place, so that no file is in memory as a whole.

use hovertone_media::{FileAccess, OpenFile};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// Bytes that are read at once where less is wanted.
const SLICE_BYTES: usize = 256 * 1024;

#[wasm_bindgen]
extern "C" {
    /// Copies bytes of a file from a place on, and returns their number: 0 at its end. The worker provides it.
    #[wasm_bindgen(catch, js_namespace = hovertoneFiles, js_name = read)]
    fn read_slice(file: u32, at: f64, into: &mut [u8]) -> Result<u32, JsValue>;
}

/// A file that the page knows by a number.
#[derive(Clone, Debug)]
pub(crate) struct SlicedFile {
    pub(crate) number: u32,
    pub(crate) name: PathBuf,
    pub(crate) len: u64,
}

impl FileAccess for SlicedFile {
    fn open(&self) -> io::Result<OpenFile> {
        Ok(Box::new(Slices { number: self.number, len: self.len, at: 0, slice: Vec::new(), slice_at: 0 }))
    }

    fn name(&self) -> &Path {
        &self.name
    }
}

/// An open file with the slice around its position.
struct Slices {
    number: u32,
    len: u64,
    at: u64,
    slice: Vec<u8>,
    slice_at: u64,
}

impl Slices {
    fn read_from_page(&self, at: u64, into: &mut [u8]) -> io::Result<usize> {
        // places below 2^53 are exact
        let count = read_slice(self.number, at as f64, into).map_err(|error| {
            let words = error.as_string().unwrap_or_else(|| "the browser could not read the file".to_owned());
            io::Error::other(words)
        })?;
        Ok((count as usize).min(into.len()))
    }

    /// The held bytes from the position on.
    fn held(&self) -> &[u8] {
        let offset = self.at.checked_sub(self.slice_at).and_then(|offset| usize::try_from(offset).ok());
        offset.and_then(|offset| self.slice.get(offset..)).unwrap_or_default()
    }
}

impl Read for Slices {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if self.held().is_empty() {
            if into.len() >= SLICE_BYTES {
                let count = self.read_from_page(self.at, into)?;
                self.at += count as u64;
                return Ok(count);
            }
            let mut slice = std::mem::take(&mut self.slice);
            slice.resize(SLICE_BYTES, 0);
            let count = self.read_from_page(self.at, &mut slice)?;
            slice.truncate(count);
            (self.slice, self.slice_at) = (slice, self.at);
        }
        let held = self.held();
        let count = held.len().min(into.len());
        into[..count].copy_from_slice(&held[..count]);
        self.at += count as u64;
        Ok(count)
    }
}

impl Seek for Slices {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let target = match to {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::Current(delta) => self.at.checked_add_signed(delta),
            SeekFrom::End(delta) => self.len.checked_add_signed(delta),
        };
        self.at =
            target.ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "a position outside of the file"))?;
        Ok(self.at)
    }
}
