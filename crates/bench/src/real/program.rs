//! Runs the program `hovertone` as a user would, with a time limit.

use super::answer::Answer;
use std::fs::File;
use std::io::{Read, Seek};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// A run may take this long.
const LIMIT: Duration = Duration::from_secs(180);
/// How often a running program is looked at.
const POLL: Duration = Duration::from_millis(5);

/// The program under examination.
pub(super) struct Program {
    path: PathBuf,
}

impl Program {
    /// The program at a path, or beside the bench's own.
    ///
    /// # Errors
    /// It is not there; says how to build it.
    pub(super) fn found(given: Option<&str>) -> Result<Self, String> {
        let name = format!("hovertone{}", std::env::consts::EXE_SUFFIX);
        let own = std::env::current_exe().map_err(|error| format!("the bench does not know where it is: {error}"))?;
        // a test lies in a folder below the programs
        let beside = own.ancestors().skip(1).take(2).map(|folder| folder.join(&name));
        let path = match given {
            Some(given) => Some(PathBuf::from(given)).filter(|path| path.is_file()),
            None => beside.into_iter().find(|path| path.is_file()),
        };
        let place = given.map_or_else(|| format!("{name} beside {}", own.display()), str::to_owned);
        let path = path.and_then(|path| std::path::absolute(path).ok());
        path.map(|path| Self { path }).ok_or_else(|| {
            format!(
                "there is no {place}: build it with `cargo build --release -p hovertone-cli`, or give --hovertone PATH"
            )
        })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Is a source file of the workspace newer than the program?
    pub(super) fn is_older_than_sources(&self, root: &Path) -> bool {
        let built = modified(&self.path);
        let crates = std::fs::read_dir(root.join("crates")).into_iter().flatten().flatten();
        crates.filter(|one| one.file_name() != "bench").any(|one| has_newer(&one.path().join("src"), built))
    }

    /// Analyses a file with these flags of `speed`.
    pub(super) fn speed(&self, flags: &[String], file: &Path) -> Result<Answer, String> {
        let failed = |error: std::io::Error| format!("{}: {error}", self.path.display());
        // files and not pipes: a full pipe would stop the program, and reading it would need threads
        let (mut stdout, mut stderr) = (tempfile::tempfile().map_err(failed)?, tempfile::tempfile().map_err(failed)?);
        let child = Command::new(&self.path)
            .args(["speed", "--json", "--no-progress"])
            .args(flags)
            .arg(file)
            .stdin(Stdio::null())
            .stdout(stdout.try_clone().map_err(failed)?)
            .stderr(stderr.try_clone().map_err(failed)?)
            .spawn()
            .map_err(failed)?;
        match waited(child, LIMIT).map_err(failed)? {
            Some(_) => {
                Ok(Answer::from_output(&text_of(&mut stdout).map_err(failed)?, &text_of(&mut stderr).map_err(failed)?))
            }
            None => Ok(Answer::timeout()),
        }
    }
}

/// Waits for the end of a child; `None` where it took too long and was ended.
fn waited(mut child: Child, limit: Duration) -> std::io::Result<Option<ExitStatus>> {
    let started = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        if started.elapsed() > limit {
            child.kill()?;
            child.wait()?;
            return Ok(None);
        }
        std::thread::sleep(POLL);
    }
}

fn text_of(file: &mut File) -> std::io::Result<String> {
    file.rewind()?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn modified(path: &Path) -> Option<SystemTime> {
    std::fs::metadata(path).and_then(|facts| facts.modified()).ok()
}

/// Has a folder, or one below it, a file that is newer?
fn has_newer(folder: &Path, than: Option<SystemTime>) -> bool {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).any(|path| {
        if path.is_dir() { has_newer(&path, than) } else { modified(&path).is_some_and(|time| Some(time) > than) }
    })
}

#[cfg(test)]
mod tests {
    use super::{Program, waited};
    use std::process::Command;
    use std::time::{Duration, Instant};

    #[test]
    fn a_program_that_is_missing_is_named_with_what_builds_it() {
        let message = Program::found(Some("no/such/program")).err().unwrap();
        assert!(message.contains("no/such/program") && message.contains("cargo build --release -p hovertone-cli"));
    }

    #[cfg(unix)]
    #[test]
    fn a_program_that_takes_too_long_is_ended() {
        let started = Instant::now();
        let sleeper = Command::new("sleep").arg("60").spawn().unwrap();
        assert!(waited(sleeper, Duration::from_millis(20)).unwrap().is_none());
        assert!(started.elapsed() < Duration::from_secs(30));
        let quick = Command::new("true").spawn().unwrap();
        assert!(waited(quick, Duration::from_secs(30)).unwrap().unwrap().success());
    }
}
