//! A line of prose in a comment is not too long to read.

use super::fault::Fault;
use crate::tree::Tree;

const COLUMNS_MAX: usize = 150;

pub(super) fn check(tree: &Tree) -> Vec<Fault> {
    let mut faults = Vec::new();
    for source in tree.sources.iter().filter(|source| source.below_src().is_some()) {
        let mut is_drawing = false;
        for (index, line) in source.text.lines().enumerate() {
            let Some(comment) = comment(line) else {
                is_drawing = false;
                continue;
            };
            if comment.starts_with("```") {
                is_drawing = !is_drawing;
            }
            let columns = line.chars().count();
            let is_prose = !is_drawing && !comment.starts_with('|') && !comment.contains("://");
            if columns > COLUMNS_MAX && is_prose {
                let message = format!("a line of prose of {columns} columns, at most {COLUMNS_MAX}: break it");
                faults.push(Fault::new(&source.path, index + 1, message));
            }
        }
    }
    faults
}

/// The text of the comment on a line, without its slashes; also behind code.
fn comment(line: &str) -> Option<&str> {
    let start = match line.trim_start() {
        whole if whole.starts_with("//") => line.len() - whole.len(),
        _ => line.match_indices(" // ").find(|(start, _)| line[..*start].matches('"').count().is_multiple_of(2))?.0 + 1,
    };
    Some(line[start..].trim_start_matches(['/', '!']).trim_start())
}

#[cfg(test)]
mod tests {
    use super::{COLUMNS_MAX, check, comment};
    use crate::tree::Tree;

    fn count(lines: &str) -> usize {
        check(&Tree::of(&[("crates/cli/src/a.rs", &format!("{lines}\nfn f() {{}}"))])).len()
    }

    #[test]
    fn long_prose_is_a_fault_and_tables_and_addresses_are_none() {
        let words = "ä".repeat(COLUMNS_MAX - 3);
        assert_eq!(count(&format!("// {words}")), 0);
        assert_eq!(count(&format!("// {words}a")), 1);
        assert_eq!(count(&format!("/// {words}")), 1);
        assert_eq!(count(&format!("//! {words}")), 1);
        assert_eq!(count(&format!("const A: u8 = 1; // {words}")), 1);
        assert_eq!(count(&format!("// | {words} |")), 0);
        assert_eq!(count(&format!("// https://example.org/{words}")), 0);
        assert_eq!(count(&format!("// ```text\n// {words} drawn\n// ```\n// {words} written")), 1);
        assert_eq!(count(&format!("const A: &str = \"{words} // {words}\";")), 0);
    }

    #[test]
    fn the_comment_behind_code_is_found() {
        assert_eq!(comment("let a = \"b // c\"; // d"), Some("d"));
        assert_eq!(comment("    /// a"), Some("a"));
        assert_eq!(comment("let a = 1;"), None);
    }
}
