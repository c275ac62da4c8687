//! No tuning number inside an algorithm of the estimator.

use super::fault::Fault;
use super::unmarked_constant::is_of_estimator;
use crate::tree::{Source, Tree};
use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{
    ImplItemConst, ImplItemFn, ItemConst, ItemFn, ItemImpl, ItemStatic, Lit, Macro, TraitItemConst, TraitItemFn,
};

/// Whole numbers up to this need no name.
const WHOLE_MAX: f64 = 12.0;
/// Besides whole numbers and powers of ten: a half, seconds of a minute and an hour, degrees of a half and a full turn.
const PLAIN: [f64; 5] = [0.5, 60.0, 3600.0, 180.0, 360.0];
/// Functions of this name refuse settings out of their range, and say the range.
const CHECK: &str = "check";

pub(super) fn check(tree: &Tree) -> Vec<Fault> {
    let is_checked = |source: &&Source| is_of_estimator(source);
    tree.sources.iter().filter(is_checked).flat_map(check_source).collect()
}

fn check_source(source: &Source) -> Vec<Fault> {
    let mut collector = Collector { functions: Vec::new(), found: Vec::new() };
    collector.visit_file(&source.code);
    collector
        .found
        .into_iter()
        .map(|number| {
            let message = format!("{} in {}(): give it a name and a mark", number.text, number.function);
            Fault::new(&source.path, number.line, message)
        })
        .collect()
}

struct Number {
    text: String,
    line: usize,
    function: String,
}

struct Collector {
    /// Names of the functions around, outermost first.
    functions: Vec<String>,
    found: Vec<Number>,
}

impl Collector {
    fn add(&mut self, literal: &Lit) {
        let Some(function) = self.functions.last() else { return };
        let digits = match literal {
            Lit::Float(number) => number.base10_digits(),
            Lit::Int(number) if number.suffix().starts_with('f') => number.base10_digits(),
            _ => return,
        };
        if !digits.parse().is_ok_and(is_plain) {
            let line = literal.span().start().line;
            self.found.push(Number { text: digits.to_owned(), line, function: function.clone() });
        }
    }

    fn add_tokens(&mut self, tokens: TokenStream) {
        for token in tokens {
            match token {
                TokenTree::Group(group) => self.add_tokens(group.stream()),
                TokenTree::Literal(literal) => self.add(&Lit::new(literal)),
                _ => {}
            }
        }
    }

    fn within(&mut self, function: String, visit: impl FnOnce(&mut Self)) {
        if function != CHECK {
            self.functions.push(function);
            visit(self);
            self.functions.pop();
        }
    }
}

impl<'file> Visit<'file> for Collector {
    fn visit_lit(&mut self, literal: &'file Lit) {
        self.add(literal);
    }

    fn visit_macro(&mut self, item: &'file Macro) {
        self.add_tokens(item.tokens.clone());
    }

    fn visit_item_fn(&mut self, item: &'file ItemFn) {
        self.within(item.sig.ident.to_string(), |collector| visit::visit_item_fn(collector, item));
    }

    fn visit_impl_item_fn(&mut self, item: &'file ImplItemFn) {
        self.within(item.sig.ident.to_string(), |collector| visit::visit_impl_item_fn(collector, item));
    }

    fn visit_trait_item_fn(&mut self, item: &'file TraitItemFn) {
        self.within(item.sig.ident.to_string(), |collector| visit::visit_trait_item_fn(collector, item));
    }

    fn visit_item_impl(&mut self, item: &'file ItemImpl) {
        let name = item.trait_.as_ref().and_then(|(path, _)| path.segments.last());
        if name.is_none_or(|name| name.ident != "Default") {
            visit::visit_item_impl(self, item);
        }
    }

    // The rule on constants looks at these.
    fn visit_item_const(&mut self, _: &'file ItemConst) {}
    fn visit_item_static(&mut self, _: &'file ItemStatic) {}
    fn visit_impl_item_const(&mut self, _: &'file ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'file TraitItemConst) {}
}

/// Does the number say what it is without a name?
fn is_plain(number: f64) -> bool {
    let is_whole = number.fract() == 0.0 && number.abs() <= WHOLE_MAX;
    is_whole || PLAIN.contains(&number) || is_power_of_ten(number)
}

fn is_power_of_ten(number: f64) -> bool {
    number > 0.0 && format!("1e{}", number.log10().round()).parse() == Ok(number)
}

#[cfg(test)]
mod tests {
    use super::{check, is_plain};
    use crate::tree::Tree;

    fn count(text: &str) -> usize {
        check(&Tree::of(&[("crates/thrust/src/a.rs", text)])).len()
    }

    #[test]
    fn plain_numbers_are_told_from_tuning_numbers() {
        for number in [0.0, 1.0, 12.0, 0.5, 60.0, 3600.0, 180.0, 360.0, 1e-6, 1e-12, 0.001, 100.0, 1e9] {
            assert!(is_plain(number), "{number}");
        }
        for number in [0.3, 1.5, 13.0, 0.25, 2e-6, 1.1, 200.0, 99.0] {
            assert!(!is_plain(number), "{number}");
        }
    }

    #[test]
    fn a_tuning_number_in_a_body_is_a_fault() {
        for text in [
            "fn f(x: f64) -> f64 { 0.3 * x }",
            "fn f(x: f64) -> f64 { x.max(-1.5) }",
            "fn f(x: f64) -> f64 { let g = |y: f64| y * 2.5; g(x) }",
            "fn f(x: f64) -> bool { assert!(x < 0.3); true }",
            "fn f(x: f64) -> bool { matches!(x, 0.0..0.3) }",
            "fn f() -> f64 { 20f64 }",
            "impl A { fn f(&self) -> f64 { 0.3 } }",
            "trait T { fn f(&self) -> f64 { 0.3 } }",
            "impl From<A> for B { fn from(a: A) -> B { B(0.3) } }",
        ] {
            assert_eq!(count(text), 1, "{text}");
        }
    }

    #[test]
    fn constants_defaults_checks_and_tests_are_none() {
        for text in [
            "fn f(x: f64) -> f64 { 2.0 * x + 0.5 - 1e-9 + 60.0 }",
            "fn f(x: f64) -> f64 { const SHARE: f64 = 0.3; SHARE * x }",
            "const A: Settings = Settings { share: 0.3 };",
            "impl Default for A { fn default() -> A { A { share: 0.3 } } }",
            "impl A { fn check(&self) -> bool { self.share < 0.3 } }",
            "#[cfg(test)] mod tests { fn f() -> f64 { 0.3 } }",
            "fn f() -> usize { 17 + 1_000 }",
            "fn f() -> String { format!(\"0.3 {}\", 12.0) }",
        ] {
            assert_eq!(count(text), 0, "{text}");
        }
    }

    #[test]
    fn only_the_estimator_is_checked() {
        let count = |path: &str| check(&Tree::of(&[(path, "fn f() -> f64 { 0.3 }")])).len();
        assert_eq!(count("crates/figures/src/a.rs"), 0);
        assert_eq!(count("crates/thrust/tests/a.rs"), 0);
        assert_eq!(count("crates/rotor-speed/src/pipeline.rs"), 1);
    }

    #[test]
    fn the_fault_names_line_function_and_remedy() {
        let faults = check(&Tree::of(&[("crates/thrust/src/a.rs", "fn f() -> f64 {\n    0.3\n}")]));
        assert_eq!(faults[0].to_string(), "crates/thrust/src/a.rs:2: 0.3 in f(): give it a name and a mark");
    }
}
