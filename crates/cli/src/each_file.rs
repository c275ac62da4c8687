//! A command that reads several files, one after the other.

use crate::failure::{Ending, Failure};
use crate::terminal::Terminal;
use std::path::{Path, PathBuf};

/// The files of a command, and how their answers follow each other.
pub(crate) struct EachFile<'a> {
    pub(crate) files: &'a [PathBuf],
    /// Whether an empty line stands between two answers.
    pub(crate) has_gaps: bool,
}

impl EachFile<'_> {
    /// Reads and tells each file. One that cannot be read is an error, and the others are told all the same. A failure to tell ends the command.
    pub(crate) fn told<T>(
        &self,
        terminal: &mut Terminal,
        read: impl Fn(&Path) -> Result<T, Failure>,
        tell: impl Fn(&Path, T, &mut Terminal) -> Result<Ending, Failure>,
    ) -> Result<Ending, Failure> {
        let mut ending = Ending::Done;
        let mut is_first = true;
        for file in self.files {
            let content = match read(file) {
                Ok(content) => content,
                Err(failure @ Failure::Failed { .. }) if self.files.len() > 1 => {
                    terminal.flush()?;
                    terminal.failure(&failure);
                    ending = ending.max(Ending::FilesFailed);
                    continue;
                }
                Err(failure) => return Err(failure),
            };
            if !std::mem::take(&mut is_first) && self.has_gaps {
                terminal.text("\n")?;
            }
            ending = ending.max(tell(file, content, terminal)?);
        }
        Ok(ending)
    }
}
