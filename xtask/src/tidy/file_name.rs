//! A file's name says what is in it.

use super::fault::Fault;
use crate::tree::Tree;

const VAGUE: [&str; 5] = ["utils", "util", "helpers", "common", "misc"];

pub(super) fn check(tree: &Tree) -> Vec<Fault> {
    let mut faults = Vec::new();
    for source in &tree.sources {
        let stem = source.path.strip_suffix(".rs").unwrap_or(&source.path);
        if let Some(vague) = VAGUE.iter().find(|vague| stem.trim_end_matches("/mod").ends_with(&format!("/{vague}"))) {
            let message = format!("the name \"{vague}\" does not say what is in the file: name it after its job");
            faults.push(Fault::new(&source.path, 1, message));
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::check;
    use crate::tree::Tree;

    #[test]
    fn a_vague_name_is_a_fault() {
        let count = |path: &str| check(&Tree::of(&[(path, "")])).len();
        assert_eq!(count("crates/cli/src/utils.rs"), 1);
        assert_eq!(count("crates/cli/tests/common/mod.rs"), 1);
        assert_eq!(count("crates/cli/src/uncommon.rs"), 0);
        assert_eq!(count("crates/cli/src/common_mode.rs"), 0);
    }
}
