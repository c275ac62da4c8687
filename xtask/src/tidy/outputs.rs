//! The command line writes files in one place, which never replaces what a command reads.

use super::fault::Fault;
use super::paths::paths;
use crate::tree::Tree;

const WRITER: &str = "crates/cli/src/output_file.rs";
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
    let mut faults = Vec::new();
    let of_cli = |path: &str| path.starts_with("crates/cli/src/") && path != WRITER;
    for source in tree.sources.iter().filter(|source| of_cli(&source.path)) {
        for path in paths(&source.code) {
            let ends_so = |end: &[&str; 2]| {
                path.segments.len() > 1 && path.segments.iter().rev().zip(end.iter().rev()).all(|(a, b)| a == b)
            };
            if WRITING.iter().any(ends_so) {
                let message = format!("{} beside {WRITER}: write through `Outputs` or `OutputFolder`", path.text());
                faults.push(Fault::new(&source.path, path.line, message));
            }
        }
    }
    faults
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
