//! The workspace that is examined: its root, its build folder, and its builds.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The root of the workspace.
pub(crate) fn root() -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    folder.ancestors().nth(2).map_or_else(PathBuf::new, Path::to_path_buf)
}

/// The build folder, where exams keep their files.
pub(crate) fn target(root: &Path) -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from)
}

/// Runs cargo in the workspace.
pub(crate) fn cargo(root: &Path, arguments: &[&str]) -> Result<(), String> {
    let status = Command::new("cargo")
        .args(arguments)
        .current_dir(root)
        .status()
        .map_err(|error| format!("cargo could not start: {error}"))?;
    if status.success() { Ok(()) } else { Err(format!("cargo {} failed", arguments.join(" "))) }
}

/// The command of an exam and the commit, for its report.
pub(crate) fn made_by(root: &Path, exam: &str, words: &[&str]) -> String {
    let git = |arguments: &[&str]| output_of(Command::new("git").args(arguments).current_dir(root));
    let commit = git(&["rev-parse", "--short", "HEAD"]).unwrap_or_default();
    let is_changed = !git(&["status", "--porcelain", "--untracked-files=no"]).unwrap_or_default().is_empty();
    // where the program or the rows lie on this computer says nothing to a reader
    let is_place = |word: &&str| ["--hovertone", "--out"].contains(word);
    let told = words.iter().enumerate().filter(|(index, word)| {
        !is_place(word) && !index.checked_sub(1).is_some_and(|before| is_place(&words[before]))
    });
    let told = told.map(|(_, word)| *word);
    format!(
        "made by `{}`, hovertone {} at commit {}{}",
        ["cargo run --release -p hovertone-bench --", exam].into_iter().chain(told).collect::<Vec<_>>().join(" "),
        env!("CARGO_PKG_VERSION"),
        commit.trim(),
        if is_changed { " with changes" } else { "" },
    )
}

/// What a program says on stdout; the last line of its stderr where it fails.
pub(crate) fn output_of(command: &mut Command) -> Result<String, String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.stdin(Stdio::null()).output().map_err(|error| format!("{name}: {error}"))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    Err(said.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("it failed and said nothing").trim().to_owned())
}
