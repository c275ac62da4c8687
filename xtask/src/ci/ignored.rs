//! Which tests are ignored, and why: an exam runs when asked for, a measurement of speed only by hand.

use crate::tree::Tree;
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, ItemFn, Lit, Meta};

/// How the reason of an exam begins.
const EXAM: &str = "exam:";

pub(super) struct TestFunction {
    name: String,
    /// `None` for a test that runs always; empty where no reason is given.
    ignored_for: Option<String>,
}

/// All functions marked `#[test]`.
pub(super) fn test_functions(tree: &Tree) -> Vec<TestFunction> {
    let mut collector = Collector { found: Vec::new() };
    tree.sources.iter().for_each(|source| collector.visit_file(&source.file));
    collector.found
}

/// Names of the tests that are ignored for another reason than being an exam.
///
/// # Errors
/// The test program leaves out every test whose path contains such a name. A name that would leave out another test is refused.
pub(super) fn never_run(tests: &[TestFunction]) -> Result<Vec<&str>, String> {
    let mut names = Vec::new();
    let is_left_out = |test: &TestFunction| test.ignored_for.as_ref().is_some_and(|reason| !reason.starts_with(EXAM));
    for test in tests.iter().filter(|test| is_left_out(test)) {
        let name = test.name.as_str();
        if let Some(other) = tests.iter().find(|other| other.name.contains(name) && !is_left_out(other)) {
            return Err(format!("the ignored test {name} would leave out {}: give it another name", other.name));
        }
        names.push(name);
    }
    Ok(names)
}

struct Collector {
    found: Vec<TestFunction>,
}

impl<'file> Visit<'file> for Collector {
    fn visit_item_fn(&mut self, item: &'file ItemFn) {
        if item.attrs.iter().any(|attribute| attribute.path().is_ident("test")) {
            let ignored_for = item.attrs.iter().find_map(ignore_reason);
            self.found.push(TestFunction { name: item.sig.ident.to_string(), ignored_for });
        }
        visit::visit_item_fn(self, item);
    }
}

/// The reason in `#[ignore = "reason"]`.
fn ignore_reason(attribute: &Attribute) -> Option<String> {
    if !attribute.path().is_ident("ignore") {
        return None;
    }
    let reason = match &attribute.meta {
        Meta::NameValue(pair) => match &pair.value {
            Expr::Lit(literal) => match &literal.lit {
                Lit::Str(text) => Some(text.value()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    };
    Some(reason.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::{never_run, test_functions};
    use crate::tree::Tree;

    fn left_out(text: &str) -> Result<Vec<String>, String> {
        let tests = test_functions(&Tree::of(&[("crates/a/tests/a.rs", text)]));
        never_run(&tests).map(|names| names.into_iter().map(str::to_owned).collect())
    }

    #[test]
    fn exams_run_and_measurements_do_not() {
        let text = "#[test] fn a() {}\n#[test] #[ignore = \"exam: minutes\"] fn b() {}\n\
                    #[test] #[ignore = \"a measurement\"] fn speed() {}\nmod m { #[test] #[ignore] fn why() {} }\nfn c() {}";
        assert_eq!(left_out(text), Ok(vec!["speed".to_owned(), "why".to_owned()]));
    }

    #[test]
    fn a_name_that_leaves_out_another_test_is_refused() {
        let text = "#[test] #[ignore = \"a measurement\"] fn speed() {}\n#[test] fn speed_is_found() {}";
        assert!(left_out(text).unwrap_err().contains("would leave out speed_is_found"));
    }
}
