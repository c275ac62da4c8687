//! Folders that a command writes: the check before writing, and tables in them.

use crate::failure::Failure;
use std::fs;
use std::path::Path;

/// Makes the folder. A folder with files is refused unless an earlier run of the same command wrote it, which the beginning `mark` of the
/// file `marked` shows.
pub(crate) fn prepare(folder: &Path, kind: &str, marked: &str, mark: &str) -> Result<(), Failure> {
    let is_empty = match fs::read_dir(folder) {
        Ok(mut entries) => entries.next().is_none(),
        Err(_) if folder.exists() => {
            return Err(Failure::failed("this is no folder that can be read", "choose another with -o DIR", folder));
        }
        Err(_) => true,
    };
    let is_own = || fs::read_to_string(folder.join(marked)).is_ok_and(|text| text.starts_with(mark));
    if !is_empty && !is_own() {
        let what = format!("this folder is not empty, and what is in it is not an earlier {kind}: nothing was written");
        return Err(Failure::failed(what, "choose a new folder with -o DIR", folder));
    }
    fs::create_dir_all(folder).map_err(|error| Failure::cannot_write(&error, folder))
}

/// The failure for a table that cannot be written.
pub(crate) fn cannot_write_csv(error: &csv::Error, path: &Path) -> Failure {
    Failure::failed(format!("cannot write: {error}"), "choose another place, or check your rights and the disk", path)
}

/// Writes a table from its rows.
pub(crate) fn write_csv(
    path: &Path,
    write: impl FnOnce(&mut csv::Writer<fs::File>) -> Result<(), csv::Error>,
) -> Result<(), Failure> {
    let cannot_write = |error: csv::Error| cannot_write_csv(&error, path);
    let mut writer = csv::Writer::from_path(path).map_err(cannot_write)?;
    write(&mut writer).map_err(cannot_write)?;
    writer.flush().map_err(|error| Failure::cannot_write(&error, path))
}
