//! Folders that a command writes: the check before the work, and the files in them.

use crate::failure::Failure;
use crate::output_file::OutputFile;
use crate::outputs::{Outputs, write_whole};
use std::fs;
use std::path::{Path, PathBuf};

/// How the folder of a command is known again.
pub(crate) struct FolderKind {
    /// What the command leaves there, in messages.
    pub(crate) name: &'static str,
    /// A file that is always there …
    pub(crate) marked: &'static str,
    /// … and its beginning.
    pub(crate) mark: &'static str,
    /// The files that the command writes, as far as they can be named before its work.
    pub(crate) files: &'static [&'static str],
}

/// A folder that was checked. Files of an earlier run in it are replaced, files that the run reads never are.
pub(crate) struct OutputFolder {
    path: PathBuf,
    outputs: Outputs,
    /// Whether an earlier run of the same command wrote it.
    is_own: bool,
}

impl OutputFolder {
    /// Makes the folder. A folder with files is refused unless an earlier run of the same command wrote it, or the user uses --force.
    pub(crate) fn prepare(path: &Path, outputs: Outputs, kind: &FolderKind) -> Result<Self, Failure> {
        let is_empty = match fs::read_dir(path) {
            Ok(mut entries) => entries.next().is_none(),
            Err(_) if path.exists() => {
                return Err(Failure::failed("this is no folder that can be read", "choose another with -o DIR", path));
            }
            Err(_) => true,
        };
        let is_own = fs::read_to_string(path.join(kind.marked)).is_ok_and(|text| text.starts_with(kind.mark));
        if !is_empty && !outputs.may_replace() && !is_own {
            return Err(Failure::Usage {
                what: format!(
                    "this folder is not empty, and its content is not an earlier {}: nothing was written",
                    kind.name
                ),
                hint: "choose a new folder with -o DIR, or use --force to write there: files of the same names are \
                       replaced, all others stay"
                    .to_owned(),
                path: Some(path.to_owned()),
            });
        }
        let folder = Self { path: path.to_owned(), outputs, is_own };
        kind.files.iter().try_for_each(|name| folder.outputs.refuse_input(&path.join(name)))?;
        fs::create_dir_all(path).map_err(|error| Failure::cannot_write(&error, path))?;
        // a folder without the right to write is refused now, and not after the work
        folder.outputs.create_over(&path.join(kind.marked))?;
        Ok(folder)
    }

    /// Path of the folder.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Whether an earlier run of the same command wrote the folder.
    pub(crate) fn is_own(&self) -> bool {
        self.is_own
    }

    /// Path of a file in the folder.
    pub(crate) fn place(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Begins a file. The folders of its name are made.
    pub(crate) fn create(&self, name: &str) -> Result<OutputFile, Failure> {
        let place = self.place(name);
        if let Some(folder) = place.parent() {
            fs::create_dir_all(folder).map_err(|error| Failure::cannot_write(&error, folder))?;
        }
        self.outputs.create_over(&place)
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
