//! Names of recordings as an experiment file in another folder writes them.

use crate::failure::Failure;
use crate::files::{home_expanded, is_pattern};
use std::path::{Component, Path, PathBuf};

/// The name or pattern, which counts from the folder `root`, as it counts from the folder `target`. Only `target` must exist.
pub(crate) fn recordings_from(name: &str, root: &Path, target: &Path) -> Result<String, Failure> {
    let expanded = home_expanded(Path::new(name));
    let absolute = canonical(root)?.join(&expanded);
    let whole = normalised(&absolute);
    let target = canonical(target)?;
    let shared = whole.components().zip(target.components()).take_while(|(one, other)| one == other).count();
    // on another drive, or elsewhere altogether: the whole name is clearer than a way up to the root
    if shared <= 1 {
        return Ok(written(&whole));
    }
    let mut relative = PathBuf::new();
    target.components().skip(shared).for_each(|_| relative.push(".."));
    relative.extend(whole.components().skip(shared));
    Ok(written(&relative))
}

fn canonical(folder: &Path) -> Result<PathBuf, Failure> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    folder.canonicalize().map_err(|error| Failure::failed(format!("cannot be read: {error}"), "check its name", folder))
}

/// Without `.` and, where no pattern stands before it, `..`.
fn normalised(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if !is_pattern(&plain.to_string_lossy()) => {
                plain.pop();
            }
            other => plain.push(other),
        }
    }
    plain
}

/// With forward slashes on all systems.
fn written(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_leads_to_the_same_file_from_the_other_folder() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        std::fs::create_dir_all(root.join("results/deep")).unwrap();
        let from = |name: &str, target: &str| recordings_from(name, &root, &root.join(target)).unwrap();
        assert_eq!(from("no_hull/*.mov", "results"), "../no_hull/*.mov");
        assert_eq!(from("./no_hull/a.mov", "results/deep"), "../../no_hull/a.mov");
        assert_eq!(from("no_hull/*.mov", ""), "no_hull/*.mov");
        assert_eq!(from("../elsewhere/a.mov", "results"), "../../elsewhere/a.mov");
        assert_eq!(from("/elsewhere/a.mov", "results"), "/elsewhere/a.mov");
    }
}
