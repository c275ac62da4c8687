//! The decision constants that are no settings: those that the sources mark, by file.

use std::fs;
use std::path::{Path, PathBuf};

/// Where the constants are.
const SOURCES: &str = "crates/rotor-speed/src";
/// The table of levels, which it shares with the simulator.
const TABLE: &str = "crates/vehicle/src/line_levels.rs";
/// The mark in a doc comment.
const MARK: &str = "*Decision.*";

/// The decision constants of one file.
#[derive(Debug, PartialEq)]
pub(super) struct FileConstants {
    pub(super) file: String,
    /// Their names, in their order.
    pub(super) names: String,
    count: usize,
}

/// The decision constants of all files.
pub(super) struct Constants(Vec<FileConstants>);

impl Constants {
    pub(super) fn len(&self) -> usize {
        self.0.iter().map(|file| file.count).sum()
    }
}

impl IntoIterator for Constants {
    type Item = FileConstants;
    type IntoIter = std::vec::IntoIter<FileConstants>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

/// Reads the sources.
pub(super) fn decision_constants(root: &Path) -> Result<Constants, String> {
    let folder = root.join(SOURCES);
    let mut files = vec![root.join(TABLE)];
    let mut folders = vec![folder.clone()];
    while let Some(folder) = folders.pop() {
        let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
        for entry in fs::read_dir(&folder).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    files.sort();
    let of_file = |path: PathBuf| {
        let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let names = names_of(&text);
        let file = path.strip_prefix(&folder).or(path.strip_prefix(root)).unwrap_or(&path).display().to_string();
        Ok(FileConstants { file: format!("`{file}`"), count: names.len(), names: names.join(", ") })
    };
    let all: Vec<FileConstants> = files.into_iter().map(of_file).collect::<Result<_, String>>()?;
    Ok(Constants(all.into_iter().filter(|file| file.count > 0).collect()))
}

/// Names of the constants under a comment with the mark. A comment covers all constants up to a blank line or the next comment.
fn names_of(source: &str) -> Vec<String> {
    let mut names = Vec::new();
    let (mut is_marked, mut is_in_comment) = (false, false);
    for line in source.lines().map(str::trim) {
        if line.starts_with("///") {
            is_marked = line.contains(MARK) || is_marked && is_in_comment;
            is_in_comment = true;
            continue;
        }
        is_in_comment = false;
        if line.is_empty() {
            is_marked = false;
        }
        let declared = line.split_once("const ").filter(|(before, _)| before.is_empty() || before.starts_with("pub"));
        if let Some((name, _)) = declared.and_then(|(_, rest)| rest.split_once(':')).filter(|_| is_marked) {
            names.push(format!("`{name}`"));
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::{decision_constants, names_of};
    use crate::workspace::root;

    #[test]
    fn marked_constants_are_named() {
        let source = "/// One. *Decision.*\nconst A: f64 = 1.0;\npub(super) const B: u32 = 2;\n\n/// Two. *Numeric.*\nconst C: f64 = 3.0;\n\
                      /// Three,\n/// four. *Decision.*\nconst D: f64 = 4.0;\nfn f() {}\n";
        assert_eq!(names_of(source), ["`A`", "`B`", "`D`"]);
    }

    #[test]
    fn the_sources_have_some() {
        assert!(decision_constants(&root()).unwrap().len() > 0);
    }
}
