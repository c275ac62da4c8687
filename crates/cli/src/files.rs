//! From names and patterns to files, and from files to hashes.

use glob::{MatchOptions, Pattern};
use sha2::{Digest, Sha256};
use std::env;
use std::ffi::OsStr;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

/// Bytes per step of the hash.
const CHUNK: usize = 1 << 20;

/// As in a shell: a wild card does not match a hidden file.
const MATCHING: MatchOptions =
    MatchOptions { case_sensitive: true, require_literal_separator: true, require_literal_leading_dot: true };

/// The files that a name or pattern matches, sorted by name. Each part of an existing name is never read as a pattern, so that folders and files
/// may have brackets in their names. Empty where a pattern matches nothing; a name without wild cards is returned unchanged.
pub(crate) fn files_of(name: &Path) -> Vec<PathBuf> {
    let name = home_expanded(name);
    if name.exists() || !is_pattern(&name.to_string_lossy()) {
        return vec![name];
    }
    let mut found = vec![PathBuf::new()];
    let mut parts = name.components().peekable();
    while let Some(part) = parts.next() {
        let is_last = parts.peek().is_none();
        found = found.into_iter().flat_map(|folder| matches_in(folder, part, is_last)).collect();
    }
    let mut files: Vec<PathBuf> = found.into_iter().filter(|path| path.is_file()).collect();
    files.sort();
    files.dedup();
    files
}

/// What one part of a name or pattern leads to from a folder.
fn matches_in(folder: PathBuf, part: Component<'_>, is_last: bool) -> Vec<PathBuf> {
    let literal = folder.join(part);
    let text = part.as_os_str().to_string_lossy();
    if !matches!(part, Component::Normal(_)) || !is_pattern(&text) || literal.exists() {
        return vec![literal];
    }
    if text == "**" {
        return folders_below(folder, is_last);
    }
    let Ok(pattern) = Pattern::new(&text) else { return Vec::new() };
    let is_match = |name: &OsStr| pattern.matches_with(&name.to_string_lossy(), MATCHING);
    entries_of(&folder).into_iter().filter(|name| is_match(name)).map(|name| folder.join(name)).collect()
}

/// A folder and all folders in it, for `**`; where it is the last part, all files in them.
fn folders_below(folder: PathBuf, is_last: bool) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![folder];
    while let Some(folder) = open.pop() {
        for name in entries_of(&folder).into_iter().filter(|name| !name.as_encoded_bytes().starts_with(b".")) {
            let path = folder.join(name);
            match path.is_dir() && !path.is_symlink() {
                true => open.push(path),
                false if is_last => found.push(path),
                false => {}
            }
        }
        found.push(folder);
    }
    found
}

/// The names in a folder; none where it cannot be read.
fn entries_of(folder: &Path) -> Vec<std::ffi::OsString> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    entries.map(|entry| entry.file_name()).collect()
}

/// The path with the home folder in place of a leading `~`. Shells replace it only at the start of a word, and not in files. A folder of this
/// name is `./~`.
pub(crate) fn home_expanded(path: &Path) -> PathBuf {
    let Ok(rest) = path.strip_prefix("~") else { return path.to_owned() };
    home().map_or_else(|| path.to_owned(), |home| home.join(rest))
}

/// The home folder of the user.
pub(crate) fn home() -> Option<PathBuf> {
    let named = |name: &str| env::var_os(name).filter(|home| !home.is_empty()).map(PathBuf::from);
    named("HOME").or_else(|| named("USERPROFILE"))
}

/// Whether a name has wild cards.
pub(crate) fn is_pattern(name: &str) -> bool {
    name.contains(['*', '?', '['])
}

/// The folder of a pattern or a name, where there is no such folder.
pub(crate) fn missing_folder(pattern: &Path) -> Option<&Path> {
    let folder = pattern.parent().filter(|folder| !folder.as_os_str().is_empty())?;
    (!folder.exists() && !is_pattern(&folder.to_string_lossy())).then_some(folder)
}

/// SHA-256 of a file in hexadecimal, read in pieces.
pub(crate) fn sha256_of_file(path: &Path) -> io::Result<String> {
    File::open(path).and_then(sha256_of)
}

/// SHA-256 of all that a reader gives, in hexadecimal.
pub(crate) fn sha256_of(mut file: impl Read) -> io::Result<String> {
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

    #[test]
    fn brackets_in_a_folder_are_part_of_its_name() {
        let folder = tempfile::tempdir().unwrap();
        for name in
            ["flights [1]/no hull/a.mov", "flights [1]/no hull/b.mov", "flights [1]/.hidden.mov", "flights 1/c.mov"]
        {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, b"").unwrap();
        }
        let names = |pattern: &str| -> Vec<String> {
            let files = files_of(&folder.path().join(pattern));
            files.iter().map(|file| file.strip_prefix(folder.path()).unwrap().display().to_string()).collect()
        };
        assert_eq!(names("flights [1]/*/?.mov"), ["flights [1]/no hull/a.mov", "flights [1]/no hull/b.mov"]);
        assert_eq!(names("flights*/**/*.mov").len(), 3);
        assert_eq!(names("flights [0-9]/*.mov"), ["flights 1/c.mov"], "elsewhere they are a pattern");
        // a file of the other system, which marks its copies so
        assert!(names("flights [1]/*.mov").is_empty());
    }

    #[test]
    fn a_tilde_is_the_home_folder() {
        let home = home().unwrap();
        assert_eq!(home_expanded(Path::new("~/flights/a.mov")), home.join("flights/a.mov"));
        assert_eq!(home_expanded(Path::new("~")), home.join(""));
        for other in ["~user/a.mov", "a/~/b", "./~", "/~"] {
            assert_eq!(home_expanded(Path::new(other)), Path::new(other));
        }
    }
}
