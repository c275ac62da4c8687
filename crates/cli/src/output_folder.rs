//! Folders that a command writes: the check before the work, and the files in them.

use crate::failure::Failure;
use crate::file_list::FileList;
use crate::output_file::{OutputFile, is_left_by_run};
use crate::outputs::{Outputs, refuse_dash, refused, write_whole};
use crate::rights::CLOSED_FOLDER;
use crate::temporary_file::BeingWritten;
use hovertone_report::printable;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// What a run leaves in its folder.
pub(crate) struct FolderContent<'a> {
    /// How it is like an earlier run, in messages: "of the same demo".
    pub(crate) name: &'a str,
    /// Words that tell the run from runs on other inputs: a later run with the same words may replace its files.
    pub(crate) run: &'a str,
    /// The files, as far as they can be named before the work.
    pub(crate) files: &'a [&'a str],
}

/// A folder that was checked. Unchanged files of an earlier run of the same kind are replaced; files that a person changed, or that the run
/// reads, never are without --force.
pub(crate) struct OutputFolder {
    path: PathBuf,
    outputs: Outputs,
    list: FileList,
    being_written: OnceLock<BeingWritten>,
}

impl OutputFolder {
    /// Makes the folder. A folder with files is refused unless an earlier run of the same kind wrote it and nobody changed them, or the
    /// user uses --force.
    pub(crate) fn prepare(path: &Path, outputs: Outputs, content: &FolderContent<'_>) -> Result<Self, Failure> {
        let folder = Self::checked(path, outputs, content)?;
        folder.begin()?;
        Ok(folder)
    }

    /// The folder, before anything is written.
    pub(crate) fn checked(path: &Path, outputs: Outputs, content: &FolderContent<'_>) -> Result<Self, Failure> {
        refuse_dash(path)?;
        let list = FileList::of(path, content.run);
        let folder = Self { path: path.to_owned(), outputs, list, being_written: OnceLock::new() };
        if !folder.is_empty()? && !folder.outputs.may_replace() && !folder.list.is_of_same_run() {
            if let Some(input) = folder.outputs.input_in(path) {
                let what = format!(
                    "this folder holds the input file {}: nothing was written",
                    printable(&input.display().to_string())
                );
                return Err(refused(&what, "choose another folder for the results, as in -o results", path));
            }
            let what = format!(
                "nothing was written, because this folder has files that do not come from an earlier run {}",
                content.name
            );
            let hint = "choose a new folder with -o DIR, or use --force to write into this folder: files with the \
                        same names are replaced, all other files stay";
            return Err(refused(&what, hint, path));
        }
        for name in content.files.iter().map(|name| (*name).to_owned()).chain(folder.list.names()) {
            let place = folder.place(&name);
            folder.outputs.refuse_input(&place)?;
            if folder.outputs.would_lose(&place) && !folder.list.has_unchanged(&name) {
                let what = "hovertone did not write this file, or the file was changed later: nothing was written";
                return Err(refused(what, "choose a new folder with -o DIR, or use --force to replace it", &place));
            }
        }
        Ok(folder)
    }

    /// Makes the folder and its list of files.
    pub(crate) fn begin(&self) -> Result<(), Failure> {
        fs::create_dir_all(&self.path).map_err(|error| Failure::cannot_write(&error, &self.path))?;
        // a folder without the right to write is refused now, and not after the work
        write_whole(self.outputs.create_over(&self.list.place())?, self.list.beginning().as_bytes())
    }

    /// Whether nothing is in the folder but what an interrupt may have left, or there is no folder yet.
    fn is_empty(&self) -> Result<bool, Failure> {
        match fs::read_dir(&self.path) {
            Ok(entries) => Ok(entries.filter_map(Result::ok).all(|entry| is_left_by_run(&entry.file_name()))),
            Err(_) if self.path.is_dir() => {
                Err(Failure::failed(CLOSED_FOLDER, "choose another folder with -o DIR", &self.path))
            }
            Err(_) if self.path.exists() => Err(Failure::failed(
                "this is a file, but a folder is needed",
                "choose another folder with -o DIR",
                &self.path,
            )),
            Err(_) => Ok(true),
        }
    }

    /// Path of the folder.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Path of a file in the folder.
    pub(crate) fn place(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Begins a file. The folders of its name are made.
    pub(crate) fn create(&self, name: &str) -> Result<OutputFile, Failure> {
        self.being_written.get_or_init(|| BeingWritten::begin(&self.path));
        let place = self.place(name);
        if let Some(folder) = place.parent() {
            fs::create_dir_all(folder).map_err(|error| Failure::cannot_write(&error, folder))?;
        }
        let is_unchanged = self.list.has_unchanged(name);
        let output = if is_unchanged { self.outputs.create_over(&place) } else { self.outputs.create_sound(&place) }?;
        Ok(output.listed(self.list.clone(), name.to_owned()))
    }

    /// Writes a whole file.
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> Result<(), Failure> {
        write_whole(self.create(name)?, content.as_ref())
    }

    /// Writes a table from its rows.
    pub(crate) fn write_csv(
        &self,
        name: &str,
        write: impl FnOnce(&mut csv::Writer<fs::File>) -> Result<(), csv::Error>,
    ) -> Result<(), Failure> {
        let output = self.create(name)?;
        let mut writer = csv::Writer::from_writer(output.handle()?);
        write(&mut writer).map_err(|error| cannot_write_csv(&error, output.place()))?;
        writer.flush().map_err(|error| Failure::cannot_write(&error, output.place()))?;
        output.keep()
    }
}

/// The failure for a table that cannot be written.
pub(crate) fn cannot_write_csv(error: &csv::Error, path: &Path) -> Failure {
    Failure::failed(format!("cannot write: {error}"), "choose another place, or check your rights and the disk", path)
}
