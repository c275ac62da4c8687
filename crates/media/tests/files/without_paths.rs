//! Files that are at no path, such as those of a browser: the same sound, and the same words where there is none.

use crate::recordings::{files_of, name_of, native_only, samples, test_data};
use hovertone_media::{FileAccess, MediaError, OpenFile, Recording};
use std::fs;
use std::io::{self, Cursor};
use std::path::{Path, PathBuf};
use std::sync::Arc;

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
