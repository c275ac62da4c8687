//! From names and patterns to files, and from files to hashes.

use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Bytes per step of the hash.
const CHUNK: usize = 1 << 20;

/// The files that a name or pattern matches, sorted by name. An existing name is never read as a pattern. Empty where a pattern matches
/// nothing; a name without wild cards is returned unchanged.
pub(crate) fn files_of(name: &Path) -> Vec<PathBuf> {
    let text = name.to_string_lossy();
    if name.exists() || !is_pattern(&text) {
        return vec![name.to_owned()];
    }
    let matches = glob::glob(&text).map(|paths| paths.filter_map(Result::ok).filter(|path| path.is_file()));
    let mut files: Vec<PathBuf> = matches.map(Iterator::collect).unwrap_or_default();
    files.sort();
    files
}

/// Whether a name has wild cards.
pub(crate) fn is_pattern(name: &str) -> bool {
    name.contains(['*', '?', '['])
}

/// SHA-256 of a file in hexadecimal, read in pieces.
pub(crate) fn sha256_of_file(path: &Path) -> io::Result<String> {
    let mut file = File::open(path)?;
    let mut hasher = Sha256::new();
    let mut chunk = vec![0; CHUNK];
    loop {
        match file.read(&mut chunk) {
            Ok(0) => return Ok(in_hexadecimal(&hasher.finalize())),
            Ok(count) => hasher.update(&chunk[..count]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

/// SHA-256 of bytes, in hexadecimal.
pub(crate) fn sha256_of_bytes(bytes: &[u8]) -> String {
    in_hexadecimal(&Sha256::digest(bytes))
}

fn in_hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        // writing to a string does not fail
        let _ = write!(text, "{byte:02x}");
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_of_abc_is_the_standards_example() {
        // FIPS 180-2, appendix B.1
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256_of_bytes(b"abc"), expected);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("abc");
        std::fs::write(&path, b"abc").unwrap();
        assert_eq!(sha256_of_file(&path).unwrap(), expected);
    }

    #[test]
    fn a_pattern_is_its_files_in_order_and_a_name_is_itself() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["b.wav", "a.wav", "c.txt", "take [1].wav"] {
            std::fs::write(folder.path().join(name), b"").unwrap();
        }
        let names = |pattern: &str| -> Vec<String> {
            let files = files_of(&folder.path().join(pattern));
            files.iter().map(|file| file.file_name().unwrap().to_string_lossy().into_owned()).collect()
        };
        assert_eq!(names("?.wav"), ["a.wav", "b.wav"]);
        assert_eq!(names("take [1].wav"), ["take [1].wav"]);
        assert_eq!(names("missing.wav"), ["missing.wav"]);
        assert!(names("*.flac").is_empty());
    }
}
