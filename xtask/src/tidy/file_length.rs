//! A file does one job, and is short.

use super::fault::Fault;
use crate::tree::Tree;

const LINES_MAX: usize = 400;

pub(super) fn check(tree: &Tree) -> Vec<Fault> {
    let mut faults = Vec::new();
    for source in &tree.sources {
        let lines = source.text.lines().count();
        if lines > LINES_MAX {
            let message = format!("{lines} lines, at most {LINES_MAX}: move one of its jobs to a file of its own");
            faults.push(Fault::new(&source.path, lines, message));
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::{LINES_MAX, check};
    use crate::tree::Tree;

    #[test]
    fn a_long_file_is_a_fault() {
        let of = |lines: usize| check(&Tree::of(&[("crates/cli/tests/a.rs", &"\n".repeat(lines))]));
        assert!(of(LINES_MAX).is_empty());
        assert_eq!(
            of(LINES_MAX + 1)[0].to_string(),
            "crates/cli/tests/a.rs:401: 401 lines, at most 400: move one of its jobs to a file of its own"
        );
    }
}
