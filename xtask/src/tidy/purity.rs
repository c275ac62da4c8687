//! Files, environment, clock, threads, network and printing belong at the edges, not in the pure crates.

use super::fault::Fault;
use super::paths::{NamedPath, faults_of_paths};
use crate::tree::{Source, Tree};

const PURE: [&str; 17] = [
    "vehicle",
    "fft",
    "signal",
    "analysis",
    "rotor-speed",
    "rotor-id",
    "dynamics",
    "thrust",
    "hovertone",
    "sim",
    "exchange",
    "logs",
    "report",
    "archive",
    "figures",
    "page",
    "workflow",
];
const IMPURE_MODULES: [&str; 5] = ["fs", "env", "time", "thread", "net"];
const IMPURE_MACROS: [&str; 5] = ["println!", "print!", "eprintln!", "eprint!", "dbg!"];

pub(super) fn check(tree: &Tree) -> Vec<Fault> {
    let is_checked = |source: &Source| PURE.contains(&source.crate_name.as_str()) && source.below_src().is_some();
    faults_of_paths(tree, is_checked, |path: &NamedPath| {
        let is_impure = match path.segments.as_slice() {
            [first, second, ..] if first == "std" => IMPURE_MODULES.contains(&second.as_str()),
            [.., last] => IMPURE_MACROS.contains(&last.as_str()),
            [] => false,
        };
        is_impure.then(|| {
            format!("{} in a pure crate: hand the value over as a parameter, and leave this to the caller", path.text())
        })
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
    fn impure_calls_in_pure_crates_are_faults() {
        for text in [
            "use std::fs;",
            "use std::{env, fmt};",
            "fn f() { let now = std::time::Instant::now(); }",
            "fn f() { println!(\"a\"); }",
            "fn f() { assert!(std::fs::exists(\"a\")); }",
        ] {
            assert_eq!(count("crates/signal/src/a.rs", text), 1, "{text}");
        }
    }

    #[test]
    fn tests_comments_and_edges_are_none() {
        assert_eq!(count("crates/signal/src/a.rs", "#[cfg(test)]\nmod tests { use std::fs; }"), 0);
        assert_eq!(count("crates/signal/src/a.rs", "//! No std::fs, no println!.\nuse std::fmt;"), 0);
        assert_eq!(count("crates/signal/tests/a.rs", "use std::fs;"), 0);
        assert_eq!(count("crates/signal/src/a/tests.rs", "use std::fs;"), 0);
        assert_eq!(count("crates/cli/src/a.rs", "use std::fs;"), 0);
        assert_eq!(count("crates/media/src/a.rs", "use std::fs;"), 0);
    }
}
