//! The command line writes files in one place, which never replaces what a command reads; temporary files, which an interrupt removes, in another.

use super::fault::Fault;
use super::paths::{NamedPath, faults_of_paths};
use crate::tree::{Source, Tree};

const WRITER: &str = "crates/cli/src/output_file.rs";
const TEMPORARY: &str = "crates/cli/src/temporary_file.rs";
/// The last two names of a function that writes or removes a file.
const WRITING: [[&str; 2]; 11] = [
    ["fs", "write"],
    ["fs", "copy"],
    ["fs", "rename"],
    ["fs", "remove_file"],
    ["fs", "remove_dir_all"],
    ["fs", "OpenOptions"],
    ["File", "create"],
    ["File", "create_new"],
    ["File", "options"],
    ["Writer", "from_path"],
    ["WavWriter", "create"],
];

pub(super) fn check(tree: &Tree) -> Vec<Fault> {
    let is_checked = |source: &Source| {
        source.path.starts_with("crates/cli/src/") && ![WRITER, TEMPORARY].contains(&source.path.as_str())
    };
    faults_of_paths(tree, is_checked, |path: &NamedPath| {
        let ends_so = |end: &[&str; 2]| {
            path.segments.len() > 1 && path.segments.iter().rev().zip(end.iter().rev()).all(|(a, b)| a == b)
        };
        let writes = WRITING.iter().any(ends_so);
        writes.then(|| format!("{} beside {WRITER}: write through `Outputs` or `OutputFolder`", path.text()))
    })
}

#[cfg(test)]
mod tests {
    use super::check;
    use crate::tree::Tree;

    fn count(path: &str, text: &str) -> usize {
        check(&Tree::of(&[(path, text)])).len()
    }

    #[test]
    fn writing_beside_the_one_place_is_a_fault() {
        for text in [
            "fn f() { std::fs::write(\"a\", \"b\"); }",
            "use std::fs; fn f() { fs::remove_file(\"a\"); }",
            "fn f() { csv::Writer::from_path(\"a\"); }",
            "use std::fs::OpenOptions;",
        ] {
            assert_eq!(count("crates/cli/src/a.rs", text), 1, "{text}");
            assert_eq!(count("crates/cli/src/output_file.rs", text), 0, "{text}");
            assert_eq!(count("crates/bench/src/a.rs", text), 0, "{text}");
        }
    }

    #[test]
    fn reading_and_tests_are_none() {
        assert_eq!(count("crates/cli/src/a.rs", "fn f() { std::fs::read(\"a\"); OutputFile::create(\"a\"); }"), 0);
        assert_eq!(
            count("crates/cli/src/a.rs", "#[cfg(test)]\nmod tests { fn f() { std::fs::write(\"a\", \"b\"); } }"),
            0
        );
    }
}
