//! The folder of a batch: what it is of, the parts of finished recordings, and the locks that keep runs apart.

use crate::failure::Failure;
use crate::files::sha256_of_bytes;
use crate::output_file::{LOCK, OutputFile, open_lock, remove_written};
use crate::output_folder::{FolderContent, OutputFolder};
use crate::outputs::{Outputs, refused, write_whole};
use hovertone_archive::{BatchIdentity, Part, Plan, Planned, Shard};
use std::collections::HashSet;
use std::ffi::OsStr;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

/// What the folder is of.
pub(crate) const IDENTITY: &str = "batch.json";
/// What a batch writes, beside parts and tracks.
const WRITTEN: [&str; 3] = [IDENTITY, super::tables::RECORDINGS, super::tables::OVERVIEW];
/// Folder of the parts.
const PARTS: &str = "parts";
/// Ending of a part.
const PART_ENDING: &str = "part";

/// A folder that this run may write.
pub(crate) struct BatchFolder {
    folder: OutputFolder,
    /// Held until the run ends.
    _locks: [File; 2],
}

impl BatchFolder {
    /// Makes the folder, or opens that of an earlier run of the same recordings and settings.
    pub(crate) fn open(path: &Path, outputs: Outputs, identity: &BatchIdentity, shard: Shard) -> Result<Self, Failure> {
        let begins_anew = outputs.may_replace();
        if !begins_anew {
            refuse_other(path, identity, shard)?;
        }
        let text = serde_json::to_string_pretty(identity).map_err(Failure::internal)?;
        let run = format!("batch {}", sha256_of_bytes(text.as_bytes()));
        let content = FolderContent { name: "with the same recordings and settings", run: &run, files: &WRITTEN };
        let folder = OutputFolder::checked(path, outputs, &content)?;
        fs::create_dir_all(path).map_err(|error| Failure::cannot_write(&error, path))?;
        let locks = [lock_of_run(path, shard)?, lock_of_shard(path, shard)?];
        let folder = Self { folder, _locks: locks };
        folder.begin(&text, begins_anew)?;
        Ok(folder)
    }

    fn begin(&self, identity: &str, begins_anew: bool) -> Result<(), Failure> {
        let _alone = self.alone()?;
        if begins_anew && self.place(IDENTITY).is_file() {
            self.remove_results()?;
        }
        self.folder.begin()?;
        let is_there = fs::read_to_string(self.place(IDENTITY)).is_ok_and(|there| there == identity);
        if is_there { Ok(()) } else { self.folder.write(IDENTITY, identity) }
    }

    /// Removes what an earlier batch wrote, and nothing else.
    fn remove_results(&self) -> Result<(), Failure> {
        for name in WRITTEN {
            remove_written(&self.place(name))?;
        }
        let tracks = entries_of(&self.place(super::tables::TRACKS));
        let tracks = tracks.into_iter().filter(|path| super::tables::is_of_tracks(path));
        tracks.chain(self.parts()).try_for_each(|path| remove_written(&path).map(drop))
    }

    /// The parts that batches wrote.
    fn parts(&self) -> impl Iterator<Item = PathBuf> {
        let files = entries_of(&self.place(PARTS)).into_iter().flat_map(|folder| entries_of(&folder));
        files.filter(|path| is_part(path))
    }

    /// Removes the parts of recordings that are gone or have changed. Only a run without other jobs may do this.
    pub(crate) fn remove_other_parts(&self, plan: &Plan) -> Result<(), Failure> {
        let of_plan: HashSet<PathBuf> = plan.recordings().iter().map(|one| self.place_of_part(one)).collect();
        let mut others = self.parts().filter(|path| !of_plan.contains(path));
        others.try_for_each(|path| remove_written(&path).map(drop))
    }

    /// Keeps other runs from writing tables until the lock is dropped; waits for them.
    pub(crate) fn alone(&self) -> Result<File, Failure> {
        let (file, place) = lock_file(self.folder.path(), "tables")?;
        // a disk without locks has no other runs, as far as can be known
        match file.lock() {
            Err(error) if error.kind() != io::ErrorKind::Unsupported => Err(Failure::cannot_write(&error, &place)),
            _ => Ok(file),
        }
    }

    /// Path of a file in the folder.
    pub(crate) fn place(&self, name: &str) -> PathBuf {
        self.folder.place(name)
    }

    /// Begins a file of results.
    pub(crate) fn create(&self, name: &str) -> Result<OutputFile, Failure> {
        self.folder.create(name)
    }

    /// Writes a whole file of results.
    pub(crate) fn write(&self, name: &str, content: &str) -> Result<(), Failure> {
        self.folder.write(name, content)
    }

    fn place_of_part(&self, recording: &Planned) -> PathBuf {
        self.place(PARTS).join(&recording.part).with_extension(PART_ENDING)
    }

    /// Whether a recording is finished.
    pub(crate) fn has(&self, recording: &Planned) -> bool {
        fs::metadata(self.place_of_part(recording)).is_ok_and(|facts| facts.len() > 0)
    }

    /// Keeps a finished recording: after an interrupt it is there as a whole, or not at all.
    pub(crate) fn keep(&self, recording: &Planned, part: &Part) -> Result<(), Failure> {
        let place = self.place_of_part(recording);
        if let Some(folder) = place.parent() {
            fs::create_dir_all(folder).map_err(|error| Failure::cannot_write(&error, folder))?;
        }
        write_whole(OutputFile::create(&place)?, &part.to_bytes().map_err(Failure::internal)?)
    }

    /// The part of a finished recording. One that is not whole, such as after a loss of power, is removed.
    pub(crate) fn part(&self, recording: &Planned) -> Result<Part, Failure> {
        let place = self.place_of_part(recording);
        let bytes = fs::read(&place).map_err(|error| {
            Failure::failed(
                format!("the stored result of a recording cannot be read: {error}"),
                "check the disk",
                &place,
            )
        })?;
        Part::from_bytes(&bytes).map_err(|error| {
            let (done, hint) = match remove_written(&place) {
                Ok(_) => ("is removed now", "run the same command again: it hears only this recording again"),
                Err(_) => ("could not be removed", "remove this file, then run the same command again"),
            };
            Failure::failed(format!("the stored result of a recording is damaged and {done}: {error}"), hint, &place)
        })
    }
}

/// What the results in a folder are of, where an earlier run has said it.
pub(crate) fn identity_in(path: &Path) -> Option<BatchIdentity> {
    serde_json::from_str(&fs::read_to_string(path.join(IDENTITY)).ok()?).ok()
}

/// Whether a file has the name of a part, `0f/0f….part`: other files in the folder are not ours.
fn is_part(path: &Path) -> bool {
    let text = |name: Option<&OsStr>| name.and_then(OsStr::to_str).unwrap_or_default().to_owned();
    let (name, folder) = (text(path.file_stem()), text(path.parent().and_then(Path::file_name)));
    let is_hash = name.len() == Planned::HASH_LETTERS && name.bytes().all(|letter| letter.is_ascii_hexdigit());
    path.extension().is_some_and(|ending| ending == PART_ENDING)
        && is_hash
        && folder.len() == 2
        && name.starts_with(&folder)
}

/// Refuses a folder of other recordings or settings, with what differs.
fn refuse_other(path: &Path, identity: &BatchIdentity, shard: Shard) -> Result<(), Failure> {
    let place = path.join(IDENTITY);
    let Ok(text) = fs::read_to_string(&place) else { return Ok(()) };
    let hint = match shard.is_whole() {
        true => "choose a new folder with -o OUT, or use --force to remove the old results and start again",
        // --force of one job would remove the results of the other jobs
        false => "choose a new folder with -o OUT for all jobs, or remove this folder before the first job starts",
    };
    let Ok(there) = serde_json::from_str::<BatchIdentity>(&text) else {
        return Err(refused(
            "this file should list the recordings and settings of the results in its folder, but it cannot be read: nothing was written",
            hint,
            &place,
        ));
    };
    let Some(shown) = there.differences(identity, ["in the earlier run", "in this run"]) else { return Ok(()) };
    let what = format!("this folder holds results of other recordings or settings: nothing was written ({shown})");
    Err(refused(&what, hint, path))
}

/// One run that hears everything, or several jobs.
fn lock_of_run(path: &Path, shard: Shard) -> Result<File, Failure> {
    let (file, place) = lock_file(path, "run")?;
    let locked = if shard.is_whole() { file.try_lock() } else { file.try_lock_shared() };
    taken(locked, file, &place, "another run of hovertone is writing into this folder")
}

fn lock_of_shard(path: &Path, shard: Shard) -> Result<File, Failure> {
    let (file, place) = lock_file(path, &format!("job-{shard}").replace('/', "-of-"))?;
    let locked = file.try_lock();
    taken(locked, file, &place, "another run of hovertone is doing the same job (--shard) in this folder")
}

fn taken(locked: Result<(), TryLockError>, file: File, place: &Path, other: &str) -> Result<File, Failure> {
    match locked {
        Err(TryLockError::WouldBlock) => {
            let hint = "wait until the other run ends; to share the work among N jobs, give each its own number: \
                        --shard 1/N to --shard N/N";
            Err(Failure::failed(other, hint, place.parent().unwrap_or(place)))
        }
        Err(TryLockError::Error(error)) if error.kind() != io::ErrorKind::Unsupported => {
            Err(Failure::cannot_write(&error, place))
        }
        _ => Ok(file),
    }
}

fn lock_file(path: &Path, name: &str) -> Result<(File, PathBuf), Failure> {
    let place = path.join(format!(".{name}{LOCK}"));
    Ok((open_lock(&place)?, place))
}

fn entries_of(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path())).collect()
}
