//! What a run may write: never over a file that it reads, and over an existing file only where the user says so. All outputs go this way.

use crate::failure::Failure;
use crate::output_file::OutputFile;
use crate::text_file::TextKind;
use hovertone_media::Container;
use hovertone_report::printable;
use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

/// The rules for all outputs of a run.
pub(crate) struct Outputs {
    /// The files that the run reads.
    inputs: Vec<PathBuf>,
    /// Whether existing files may be replaced.
    may_replace: bool,
}

impl Outputs {
    /// The rules of a run that reads these files.
    pub(crate) fn beside<P: AsRef<Path>>(inputs: impl IntoIterator<Item = P>, may_replace: bool) -> Self {
        Self { inputs: inputs.into_iter().map(|input| input.as_ref().to_owned()).collect(), may_replace }
    }

    /// Whether existing files may be replaced.
    pub(crate) fn may_replace(&self) -> bool {
        self.may_replace
    }

    /// Checks, before any long work, that a file may and can be written.
    pub(crate) fn check(&self, place: &Path) -> Result<(), Failure> {
        self.create(place).map(drop)
    }

    /// Writes a whole file.
    pub(crate) fn write(&self, place: &Path, content: impl AsRef<[u8]>) -> Result<(), Failure> {
        write_whole(self.create(place)?, content.as_ref())
    }

    /// Begins a file that holds no sound. It never takes the place of a recording: who names one by mistake, and follows a hint about --force,
    /// would lose it.
    pub(crate) fn create(&self, place: &Path) -> Result<OutputFile, Failure> {
        self.refuse_recording(place)?;
        self.create_sound(place)
    }

    /// Begins a file of text, whose name must promise no other kind of file.
    pub(crate) fn create_text(&self, place: &Path, kind: TextKind) -> Result<OutputFile, Failure> {
        self.refuse_recording(place)?;
        kind.check(place)?;
        self.create_sound(place)
    }

    /// Checks, before any long work, that a file of text may and can be written.
    pub(crate) fn check_text(&self, place: &Path, kind: TextKind) -> Result<(), Failure> {
        self.create_text(place, kind).map(drop)
    }

    fn refuse_recording(&self, place: &Path) -> Result<(), Failure> {
        self.refuse_input(place)?;
        if is_recording(place) {
            let what = "this file is a recording, and the output would replace it: nothing was written";
            return Err(refused(what, "choose another name for the output", place));
        }
        Ok(())
    }

    /// Begins a file that may hold sound.
    pub(crate) fn create_sound(&self, place: &Path) -> Result<OutputFile, Failure> {
        refuse_dash(place)?;
        self.refuse_input(place)?;
        if self.would_lose(place) {
            let what = "this file exists already: it was not replaced";
            return Err(refused(what, "choose another name, or use --force to replace it", place));
        }
        OutputFile::create(place)
    }

    /// Whether a file is there that may not be replaced.
    pub(crate) fn would_lose(&self, place: &Path) -> bool {
        !self.may_replace && has_content(place)
    }

    /// Begins a file in the place of one that hovertone wrote.
    pub(crate) fn create_over(&self, place: &Path) -> Result<OutputFile, Failure> {
        self.refuse_input(place)?;
        OutputFile::create(place)
    }

    /// An input that lies in a folder.
    pub(crate) fn input_in(&self, folder: &Path) -> Option<&Path> {
        let folder = folder.canonicalize().ok()?;
        let is_inside = |input: &&Path| input.canonicalize().is_ok_and(|input| input.starts_with(&folder));
        self.inputs.iter().map(PathBuf::as_path).find(is_inside)
    }

    /// Refuses an output that is an input, also with --force: the recording would be lost.
    pub(crate) fn refuse_input(&self, place: &Path) -> Result<(), Failure> {
        if !self.inputs.iter().any(|input| is_same_file(input, place)) {
            return Ok(());
        }
        let what = "the output has the same name as an input: nothing was written";
        Err(refused(what, "choose another name for the output", place))
    }
}

/// Refuses a dash as the name of an output: as an input it means stdin, so that a person expects stdout, and gets a file of this name.
pub(crate) fn refuse_dash(place: &Path) -> Result<(), Failure> {
    if place.as_os_str() != "-" {
        return Ok(());
    }
    let what = "- is given as an output, but it does not mean stdout here";
    Err(Failure::usage(what, "give the name of a file or folder; if the name really is -, write ./-"))
}

/// Writes the content of a file that was begun, and puts it into its place.
pub(crate) fn write_whole(output: OutputFile, content: &[u8]) -> Result<(), Failure> {
    output.handle()?.write_all(content).map_err(|error| Failure::cannot_write(&error, output.place()))?;
    output.keep()
}

/// The message about a written file.
pub(crate) fn written(place: &Path) -> String {
    format!("written: {}", printable(&place.display().to_string()))
}

pub(crate) fn refused(what: &str, hint: &str, place: &Path) -> Failure {
    Failure::Usage { what: what.to_owned(), hint: hint.to_owned(), path: Some(place.to_owned()) }
}

/// Bytes that tell the kind of a file.
const BEGINNING: u64 = 4096;

/// Whether a file is there that begins as recordings do.
pub(crate) fn is_recording(place: &Path) -> bool {
    if !fs::metadata(place).is_ok_and(|old| old.is_file()) {
        return false;
    }
    let mut beginning = Vec::new();
    let is_read = File::open(place).and_then(|file| file.take(BEGINNING).read_to_end(&mut beginning)).is_ok();
    is_read && Container::of_beginning(&beginning).is_some()
}

/// Whether something would be lost by writing here: a file with content, a link that leads nowhere. A device keeps nothing.
fn has_content(place: &Path) -> bool {
    match fs::metadata(place) {
        Ok(old) => old.is_file() && old.len() > 0,
        Err(_) => fs::symlink_metadata(place).is_ok(),
    }
}

/// Whether two names lead to one file: by symbolic links, and on Unix by hard links. Two names of a terminal are no danger.
fn is_same_file(one: &Path, other: &Path) -> bool {
    if one == other {
        return true;
    }
    let (Ok(of_one), Ok(of_other)) = (fs::metadata(one), fs::metadata(other)) else { return false };
    if !(of_one.is_file() && of_other.is_file()) {
        return false;
    }
    is_one_inode(&of_one, &of_other).unwrap_or_else(|| {
        fs::canonicalize(one).ok().zip(fs::canonicalize(other).ok()).is_some_and(|(one, other)| one == other)
    })
}

/// Whether two files are one by their numbers in the file system, which links of both kinds share; `None` where it has no numbers.
#[cfg(unix)]
fn is_one_inode(one: &fs::Metadata, other: &fs::Metadata) -> Option<bool> {
    use std::os::unix::fs::MetadataExt;
    Some((one.dev(), one.ino()) == (other.dev(), other.ino()))
}

#[cfg(not(unix))]
fn is_one_inode(_: &fs::Metadata, _: &fs::Metadata) -> Option<bool> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_existing_file_is_replaced_only_by_force_and_an_input_never() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        fs::write(file("sound.wav"), "sound").unwrap();
        fs::write(file("old.csv"), "old").unwrap();
        fs::write(file("empty.csv"), "").unwrap();
        let careful = Outputs::beside([file("sound.wav")], false);
        let forced = Outputs::beside([file("sound.wav")], true);
        assert!(careful.write(&file("old.csv"), "new").is_err());
        assert_eq!(fs::read_to_string(file("old.csv")).unwrap(), "old");
        careful.check(&file("empty.csv")).unwrap();
        careful.check(&file("new.csv")).unwrap();
        assert!(!file("new.csv").exists());
        forced.write(&file("old.csv"), "new").unwrap();
        assert_eq!(fs::read_to_string(file("old.csv")).unwrap(), "new");
        let mut names = vec![file("sound.wav"), file("../").join(folder.path().file_name().unwrap()).join("sound.wav")];
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(file("sound.wav"), file("link.wav")).unwrap();
            fs::hard_link(file("sound.wav"), file("hard.wav")).unwrap();
            names.extend([file("link.wav"), file("hard.wav")]);
        }
        for name in names {
            assert!(forced.write(&name, "new").is_err() && forced.create_over(&name).is_err(), "{name:?}");
        }
        assert_eq!(fs::read_to_string(file("sound.wav")).unwrap(), "sound");
    }

    #[test]
    fn a_recording_is_never_replaced_by_what_is_no_sound() {
        let folder = tempfile::tempdir().unwrap();
        let recording = folder.path().join("flight.csv");
        fs::write(&recording, b"RIFF\x24\x00\x00\x00WAVEfmt ").unwrap();
        let forced = Outputs::beside([folder.path().join("other.wav")], true);
        assert!(forced.check(&recording).is_err() && forced.write(&recording, "new").is_err());
        forced.create_sound(&recording).unwrap();
        assert!(fs::read(&recording).unwrap().starts_with(b"RIFF"));
    }
}
