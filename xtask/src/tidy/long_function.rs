//! A function fits on a screen.

use super::fault::Fault;
use super::functions::{Function, functions};
use crate::tree::Tree;

/// From the line of `fn` to that of the closing brace.
const LINES_MAX: usize = 80;

/// A function that may be longer.
struct Long {
    path: &'static str,
    function: &'static str,
    reason: &'static str,
}

/// The line of the list.
const LIST_LINE: usize = line!() as usize + 1;
const LONG: [Long; 0] = [];

pub(super) fn check(tree: &Tree) -> Vec<Fault> {
    faults(tree, &LONG)
}

fn faults(tree: &Tree, allowed: &[Long]) -> Vec<Fault> {
    let mut faults = Vec::new();
    let mut is_used = vec![false; allowed.len()];
    for source in &tree.sources {
        for function in functions(&source.code) {
            let lines = lines(&function);
            if lines <= LINES_MAX {
                continue;
            }
            let name = function.name();
            match allowed.iter().position(|long| long.path == source.path && long.function == name) {
                Some(index) => is_used[index] = true,
                None => faults.push(Fault::new(
                    &source.path,
                    function.line(),
                    format!(
                        "{name}() has {lines} lines, at most {LINES_MAX}: cut it where one step hands over to the next"
                    ),
                )),
            }
        }
    }
    for (long, _) in allowed.iter().zip(is_used).filter(|(_, is_used)| !is_used) {
        let message = format!(
            "{} has no long function {}() any more ({}): remove it from LONG",
            long.path, long.function, long.reason
        );
        faults.push(Fault::new(file!(), LIST_LINE, message));
    }
    faults
}

fn lines(function: &Function<'_>) -> usize {
    let end = function.body.map(|body| body.brace_token.span.close().end().line);
    end.map_or(0, |end| end + 1 - function.line())
}

#[cfg(test)]
mod tests {
    use super::{LINES_MAX, Long, check, faults};
    use crate::tree::Tree;

    const PATH: &str = "crates/cli/src/a.rs";
    const ALLOWED: [Long; 1] = [Long { path: PATH, function: "f", reason: "a table" }];

    /// A function of as many lines, below an attribute and a comment that do not count.
    fn tree(lines: usize) -> Tree {
        let text = format!("/// A comment.\n#[inline]\nfn f() {{{}}}", "\n".repeat(lines - 1));
        Tree::of(&[(PATH, &text)])
    }

    #[test]
    fn a_function_beyond_a_screen_is_a_fault() {
        assert_eq!(check(&tree(LINES_MAX)).len(), 0);
        let faults = check(&tree(LINES_MAX + 1));
        assert_eq!(faults.len(), 1);
        assert!(faults[0].to_string().starts_with("crates/cli/src/a.rs:3: f() has 81 lines, at most 80: cut it"));
    }

    #[test]
    fn a_long_function_may_be_on_the_list() {
        assert_eq!(faults(&tree(LINES_MAX + 1), &ALLOWED).len(), 0);
    }

    #[test]
    fn the_list_must_not_be_stale() {
        let of_short = faults(&tree(LINES_MAX), &ALLOWED);
        assert_eq!(of_short.len(), 1);
        assert!(of_short[0].message.contains("remove it from LONG"));
        assert_eq!(faults(&Tree::of(&[(PATH, "fn g() {}")]), &ALLOWED).len(), 1);
    }

    #[test]
    fn tests_are_not_checked() {
        let body = "\n".repeat(LINES_MAX);
        let test = format!("#[cfg(test)] mod tests {{ fn f() {{{body}}} }}");
        assert_eq!(check(&Tree::of(&[(PATH, &test)])).len(), 0);
    }
}
