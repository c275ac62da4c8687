//! Reading a file, or stdin where its name is `-`. A recording is read several times, so stdin is kept in a temporary file until the end of
//! the run.

use crate::failure::Failure;
use crate::rights::{CLOSED_FOLDER, GET_RIGHT, closed_folder};
use crate::temporary_file::TemporaryFile;
use hovertone_media::Container;
use std::fs::{self, File};
use std::io::{self, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// Name of stdin in messages and in the output.
pub(crate) const STDIN: &str = "stdin";
/// Bytes per step of a copy. The first step shows the kind of the file.
const CHUNK: usize = 1 << 20;
/// What happened, where a text has an encoding of Windows.
pub(crate) const IS_UTF16: &str = "this file is text in UTF-16, which hovertone does not read";
/// Most bytes that are kept of stdin: a day of stereo sound in 16 bits, at 48 kHz.
const STDIN_BYTES_MAX: u64 = 16_600_000_000;

/// Stdin as far as this run has used it.
enum Used {
    No,
    /// Read as text or a table.
    Read,
    /// Kept as a recording.
    Kept {
        _file: TemporaryFile,
    },
}

static USED: Mutex<Used> = Mutex::new(Used::No);

/// Whether a name means stdin. A file of this name is `./-`.
pub(crate) fn is_stdin(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Name of a file or of stdin in the output.
pub(crate) fn name_of(path: &Path) -> String {
    if is_stdin(path) { STDIN.to_owned() } else { path.display().to_string() }
}

/// The bytes of a file or of stdin; `what` names the content in messages.
pub(crate) fn read_bytes(path: &Path, what: &str) -> Result<Vec<u8>, Failure> {
    if !is_stdin(path) {
        return fs::read(path).map_err(|error| cannot_open(&error, what, path));
    }
    let mut used = first_use(what)?;
    let mut bytes = Vec::new();
    io::stdin().read_to_end(&mut bytes).map_err(|error| cannot_read(&error, what))?;
    *used = Used::Read;
    Ok(bytes)
}

/// The bytes of a file or of stdin, to be read once; `what` names the content in messages.
pub(crate) fn open_stream(path: &Path, what: &str) -> Result<Box<dyn Read>, Failure> {
    if is_stdin(path) {
        *first_use(what)? = Used::Read;
        return Ok(Box::new(io::stdin()));
    }
    let is_folder = |file: &File| file.metadata().is_ok_and(|metadata| metadata.is_dir());
    match File::open(path) {
        Ok(file) if is_folder(&file) => Err(cannot_open(&io::ErrorKind::IsADirectory.into(), what, path)),
        Ok(file) => Ok(Box::new(file)),
        Err(error) => Err(cannot_open(&error, what, path)),
    }
}

/// The text of a file or of stdin; `what` names the content in messages.
pub(crate) fn read_text(path: &Path, what: &str) -> Result<String, Failure> {
    String::from_utf8(read_bytes(path, what)?).map_err(|error| is_no_text(what, path, error.as_bytes()))
}

/// Whether bytes are a text in UTF-16, with the mark of one at its beginning.
pub(crate) fn is_utf16(content: &[u8]) -> bool {
    let (pairs, rest) = content.as_chunks::<2>();
    let units = |unit: fn([u8; 2]) -> u16| char::decode_utf16(pairs.iter().skip(1).map(move |pair| unit(*pair)));
    let is_text = |unit: fn([u8; 2]) -> u16| {
        units(unit).all(|letter| letter.is_ok_and(|letter| !letter.is_control() || letter.is_whitespace()))
    };
    rest.is_empty()
        && match pairs.first() {
            Some(b"\xff\xfe") => is_text(u16::from_le_bytes),
            Some(b"\xfe\xff") => is_text(u16::from_be_bytes),
            _ => false,
        }
}

/// The failure of a file that should be text and is something else, such as a recording.
pub(crate) fn is_no_text(what: &str, path: &Path, content: &[u8]) -> Failure {
    if is_utf16(content) {
        return Failure::failed(IS_UTF16, "save the file as UTF-8; in Excel, choose the file type \"CSV UTF-8\"", path);
    }
    let found = format!("this file is not text, so it cannot be {what}");
    Failure::failed(
        found,
        "give another file; `hovertone speed` hears recordings, and `hovertone log` reads flight logs",
        path,
    )
}

fn cannot_open(error: &io::Error, what: &str, path: &Path) -> Failure {
    let (found, hint) = match error.kind() {
        _ if path.is_dir() => {
            (format!("this is a folder, but {what} must be a file"), "give the name of the file in the folder")
        }
        io::ErrorKind::NotFound => {
            let hint = format!("check the name and the folder of {what}");
            return Failure::failed("there is no such file", hint, path);
        }
        io::ErrorKind::PermissionDenied => match closed_folder(path) {
            Some(folder) => return Failure::failed(CLOSED_FOLDER, GET_RIGHT, &folder),
            None => (format!("you have no right to read {what}"), GET_RIGHT),
        },
        _ => (format!("{what} cannot be read: {error}"), "check the file and its disk"),
    };
    Failure::failed(found, hint, path)
}

/// The file in which a recording from stdin is kept. [`forget_stdin`] removes it.
pub(crate) fn recording_of_stdin() -> Result<PathBuf, Failure> {
    let what = "the recording";
    let mut used = first_use(what)?;
    let (kept, mut file) = TemporaryFile::with_prefix("hovertone-stdin-").map_err(|error| cannot_keep(&error))?;
    let mut chunk = Vec::with_capacity(CHUNK);
    let mut kept_bytes = 0;
    loop {
        chunk.clear();
        io::stdin().take(CHUNK as u64).read_to_end(&mut chunk).map_err(|error| cannot_read(&error, what))?;
        if kept_bytes == 0 {
            refuse_no_sound(&chunk)?;
        }
        kept_bytes += chunk.len() as u64;
        if chunk.is_empty() {
            break;
        }
        if kept_bytes > STDIN_BYTES_MAX {
            return Err(Failure::usage(
                "stdin sends more than 16.6 GB, as much as a day of stereo sound",
                "give the recording as a file",
            ));
        }
        file.write_all(&chunk).map_err(|error| cannot_keep(&error))?;
    }
    let place = kept.path().to_owned();
    *used = Used::Kept { _file: kept };
    Ok(place)
}

/// Refuses the beginning of stdin where it is that of no sound: the rest could be endless.
fn refuse_no_sound(beginning: &[u8]) -> Result<(), Failure> {
    // nothing at all is a recording like others, whose row says that it is empty
    if beginning.is_empty() || Container::of_beginning(beginning).is_some() {
        return Ok(());
    }
    let what =
        "stdin is not an audio or video file that hovertone can read: its first bytes match no known format".to_owned();
    let hint = "send a recording, as in `hovertone speed - < hover.wav`; if only ffmpeg can read its format, give the \
         name of the file in place of -"
        .to_owned();
    Err(Failure::Failed { what, hint, path: None })
}

/// Removes what was kept of stdin.
pub(crate) fn forget_stdin() {
    if let Ok(mut used) = USED.lock() {
        *used = Used::Read;
    }
}

fn first_use(what: &str) -> Result<std::sync::MutexGuard<'static, Used>, Failure> {
    let used = USED.lock().map_err(Failure::internal)?;
    if !matches!(*used, Used::No) {
        return Err(Failure::usage(
            "stdin (-) is given twice, but it can be read only once",
            "give one of the two as a file",
        ));
    }
    if io::stdin().is_terminal() {
        let hint = "write < and the name of a file after the command, or give the name of the file in place of -";
        return Err(Failure::usage(
            format!("{what} should come from stdin (-), but stdin is the keyboard of this terminal"),
            hint,
        ));
    }
    Ok(used)
}

fn cannot_read(error: &io::Error, what: &str) -> Failure {
    Failure::failed(
        format!("{what} cannot be read: {error}"),
        "check the program that sends it to stdin",
        Path::new(STDIN),
    )
}

fn cannot_keep(error: &io::Error) -> Failure {
    let folder = std::env::temp_dir();
    Failure::failed(
        format!("the recording from stdin cannot be stored in this folder: {error}"),
        "make room in this folder, or set the variable TMPDIR to another folder",
        &folder,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stdin_has_a_name_and_a_file_of_its_sign_keeps_its_own() {
        assert_eq!(["-", "./-", "a/b.wav"].map(|typed| name_of(Path::new(typed))), ["stdin", "./-", "a/b.wav"]);
    }
}
