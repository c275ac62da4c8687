//! Files that are at no path, such as those of a browser: the same sound, and the same words where there is none.

use crate::recordings::{files_of, name_of, native_only, samples, test_data};
use hovertone_media::{FileAccess, MediaError, OpenFile, Recording};
use hovertone_signal::SignalSource;
use std::fs;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Bytes with a name.
struct Held {
    name: PathBuf,
    bytes: Arc<[u8]>,
}

impl Held {
    fn of(name: &str, bytes: Vec<u8>) -> Arc<Self> {
        Arc::new(Self { name: PathBuf::from(name), bytes: bytes.into() })
    }
}

impl FileAccess for Held {
    fn open(&self) -> io::Result<OpenFile> {
        Ok(Box::new(Cursor::new(Arc::clone(&self.bytes))))
    }

    fn name(&self) -> &Path {
        &self.name
    }
}

#[test]
fn held_bytes_sound_as_their_file_does() {
    let Some(folder) = test_data("containers") else { return };
    let mut heard = 0;
    for path in files_of(&folder) {
        let held = Held::of(name_of(&path), fs::read(&path).unwrap());
        let at_path = Recording::open(&path, &native_only());
        match (at_path, Recording::open_file(held, &native_only())) {
            (Ok(mut one), Ok(mut other)) => {
                assert_eq!(one.info().codec, other.info().codec, "{}", path.display());
                assert!(samples(&mut one) == samples(&mut other), "{}", path.display());
                assert_eq!(one.warnings(), other.warnings(), "{}", path.display());
                heard += 1;
            }
            (Err(one), Err(other)) => assert_eq!(one.to_string(), other.to_string()),
            (one, other) => panic!("{}: {one:?}, {other:?}", path.display()),
        }
    }
    assert!(heard > 30, "{heard} files were compared");
}

#[test]
fn no_other_program_is_asked_for_bytes_at_no_path() {
    // the default allows ffmpeg, which could not open them
    let no_sound = Recording::open_file(Held::of("a.ogg", b"neither sound nor picture".to_vec()), &Default::default());
    assert!(matches!(no_sound, Err(MediaError::UnknownFormat { .. })), "{no_sound:?}");
    let empty = Recording::open_file(Held::of("a.wav", Vec::new()), &Default::default());
    assert!(matches!(empty, Err(MediaError::Empty)), "{empty:?}");
}

/// Bytes whose second half cannot be read, as where a connection breaks.
struct Breaking {
    held: Arc<Held>,
    has_failed: Arc<AtomicBool>,
}

struct BreakingReader {
    bytes: Cursor<Arc<[u8]>>,
    has_failed: Arc<AtomicBool>,
}

impl Read for BreakingReader {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = (self.bytes.get_ref().len() as u64 / 2).saturating_sub(self.bytes.position());
        if left == 0 {
            self.has_failed.store(true, Ordering::Relaxed);
            return Err(io::Error::other("the connection broke"));
        }
        let count = buffer.len().min(left as usize);
        self.bytes.read(&mut buffer[..count])
    }
}

impl Seek for BreakingReader {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}

impl FileAccess for Breaking {
    fn open(&self) -> io::Result<OpenFile> {
        let bytes = Cursor::new(Arc::clone(&self.held.bytes));
        Ok(Box::new(BreakingReader { bytes, has_failed: Arc::clone(&self.has_failed) }))
    }

    fn name(&self) -> &Path {
        self.held.name()
    }

    fn failure(&self) -> Option<io::Error> {
        self.has_failed.load(Ordering::Relaxed).then(|| io::Error::other("the connection broke"))
    }
}

#[test]
fn a_read_that_fails_is_no_end_of_the_sound() {
    let Some(folder) = test_data("containers") else { return };
    let mut broken = 0;
    for path in files_of(&folder).into_iter().filter(|path| Recording::open(path, &native_only()).is_ok()) {
        let has_failed = Arc::new(AtomicBool::new(false));
        let held = Held::of(name_of(&path), fs::read(&path).unwrap());
        let file = Arc::new(Breaking { held, has_failed: Arc::clone(&has_failed) });
        let ended =
            Recording::open_file(file, &native_only()).map_err(|error| error.to_string()).and_then(|mut sound| {
                while sound.next_block().map_err(|error| error.to_string())?.is_some() {}
                Ok(())
            });
        if has_failed.load(Ordering::Relaxed) {
            let told = ended.expect_err(&path.display().to_string());
            assert!(told.contains("could not be read to its end: the connection broke"), "{}: {told}", path.display());
            broken += 1;
        }
    }
    assert!(broken > 30, "{broken} files broke");
}
