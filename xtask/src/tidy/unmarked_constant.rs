//! A constant of the estimator says what kind of number it is: `*Physics.*`, `*Numeric.*` (resolution, tolerance) or `*Decision.*`. A constant
//! that is another one needs no mark: it is no number of its own.

use super::fault::Fault;
use crate::tree::{Source, Tree};
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, GenericArgument, Ident, ImplItemConst, ItemConst, ItemStatic, Lit, Meta, PathArguments};
use syn::{TraitItemConst, Type};

/// Crates whose numbers decide what is heard.
pub(super) const ESTIMATOR: [&str; 8] =
    ["vehicle", "fft", "signal", "analysis", "rotor-speed", "rotor-id", "thrust", "hovertone"];
const MARKS: [&str; 3] = ["*Physics.*", "*Numeric.*", "*Decision.*"];
const NUMBERS: [&str; 14] =
    ["f32", "f64", "i8", "i16", "i32", "i64", "i128", "isize", "u8", "u16", "u32", "u64", "u128", "usize"];
/// Types that hold numbers if their arguments are numbers.
const CONTAINERS: [&str; 5] = ["Option", "Range", "RangeInclusive", "RangeFrom", "RangeTo"];

pub(super) fn check(tree: &Tree) -> Vec<Fault> {
    let is_checked = |source: &&Source| is_of_estimator(source);
    tree.sources.iter().filter(is_checked).flat_map(check_source).collect()
}

/// Is this code, not a test, of an estimator crate?
pub(super) fn is_of_estimator(source: &Source) -> bool {
    ESTIMATOR.contains(&source.crate_name.as_str()) && source.below_src().is_some()
}

fn check_source(source: &Source) -> Vec<Fault> {
    let mut collector = Collector { found: Vec::new() };
    collector.visit_file(&source.code);
    let mut constants = collector.found;
    constants.sort_by_key(|constant| constant.first_line);
    let lines: Vec<&str> = source.text.lines().collect();
    let mut faults = Vec::new();
    let mut group: Option<(usize, bool)> = None;
    for constant in &constants {
        // A constant without a comment of its own is in the group of the one above it.
        let above =
            group.filter(|(last_line, _)| !constant.has_doc && is_adjacent(&lines, *last_line, constant.first_line));
        let is_marked = constant.is_marked || above.is_some_and(|(_, is_marked)| is_marked);
        group = Some((constant.last_line, is_marked));
        if constant.is_number && !is_marked {
            let message = format!(
                "{} has no mark: write {} in its doc comment, or in that of the group it stands in",
                constant.name,
                MARKS.join(", ").replace(", *Decision", " or *Decision")
            );
            faults.push(Fault::new(&source.path, constant.line, message));
        }
    }
    faults
}

/// Does nothing but comments stand between two lines?
fn is_adjacent(lines: &[&str], last_line: usize, first_line: usize) -> bool {
    let between = lines.get(last_line..first_line - 1).unwrap_or_default();
    between.iter().all(|line| line.trim_start().starts_with("//"))
}

struct Constant {
    name: String,
    /// Of the name.
    line: usize,
    /// Of the first attribute or comment.
    first_line: usize,
    last_line: usize,
    is_number: bool,
    has_doc: bool,
    is_marked: bool,
}

struct Collector {
    found: Vec<Constant>,
}

impl Collector {
    fn add(&mut self, attributes: &[Attribute], name: &Ident, is_number: bool, last_line: usize) {
        let line = name.span().start().line;
        let docs: Vec<String> = attributes.iter().filter_map(doc_line).collect();
        self.found.push(Constant {
            name: name.to_string(),
            line,
            first_line: attributes.first().map_or(line, |first| first.pound_token.span.start().line),
            last_line,
            is_number,
            has_doc: !docs.is_empty(),
            is_marked: docs.iter().any(|doc| MARKS.iter().any(|mark| doc.contains(mark))),
        });
    }
}

impl<'file> Visit<'file> for Collector {
    fn visit_item_const(&mut self, item: &'file ItemConst) {
        self.add(&item.attrs, &item.ident, is_own_number(&item.ty, &item.expr), item.semi_token.span.end().line);
        visit::visit_item_const(self, item);
    }

    fn visit_item_static(&mut self, item: &'file ItemStatic) {
        self.add(&item.attrs, &item.ident, is_own_number(&item.ty, &item.expr), item.semi_token.span.end().line);
        visit::visit_item_static(self, item);
    }

    fn visit_impl_item_const(&mut self, item: &'file ImplItemConst) {
        self.add(&item.attrs, &item.ident, is_own_number(&item.ty, &item.expr), item.semi_token.span.end().line);
        visit::visit_impl_item_const(self, item);
    }

    fn visit_trait_item_const(&mut self, item: &'file TraitItemConst) {
        if let Some((_, value)) = &item.default {
            self.add(&item.attrs, &item.ident, is_own_number(&item.ty, value), item.semi_token.span.end().line);
        }
        visit::visit_trait_item_const(self, item);
    }
}

fn doc_line(attribute: &Attribute) -> Option<String> {
    let Meta::NameValue(pair) = &attribute.meta else { return None };
    let Expr::Lit(literal) = &pair.value else { return None };
    match &literal.lit {
        Lit::Str(text) if pair.path.is_ident("doc") => Some(text.value()),
        _ => None,
    }
}

/// Is the value a number, and no other constant's?
fn is_own_number(of: &Type, value: &Expr) -> bool {
    is_number(of) && !is_name(value)
}

fn is_name(value: &Expr) -> bool {
    match value {
        Expr::Path(_) => true,
        Expr::Cast(cast) => is_name(&cast.expr),
        _ => false,
    }
}

/// Does the type hold numbers: one, or an array, slice, tuple, range or option of them?
fn is_number(of: &Type) -> bool {
    match of {
        Type::Array(array) => is_number(&array.elem),
        Type::Slice(slice) => is_number(&slice.elem),
        Type::Reference(reference) => is_number(&reference.elem),
        Type::Paren(inner) => is_number(&inner.elem),
        Type::Tuple(tuple) => tuple.elems.iter().any(is_number),
        Type::Path(path) => path.path.segments.last().is_some_and(|last| {
            let name = last.ident.to_string();
            NUMBERS.contains(&name.as_str()) || (CONTAINERS.contains(&name.as_str()) && holds_numbers(&last.arguments))
        }),
        _ => false,
    }
}

fn holds_numbers(arguments: &PathArguments) -> bool {
    let PathArguments::AngleBracketed(arguments) = arguments else { return false };
    arguments.args.iter().any(|argument| matches!(argument, GenericArgument::Type(of) if is_number(of)))
}

#[cfg(test)]
mod tests {
    use super::check;
    use crate::tree::Tree;

    fn count(text: &str) -> usize {
        check(&Tree::of(&[("crates/signal/src/a.rs", text)])).len()
    }

    #[test]
    fn a_number_without_a_mark_is_a_fault() {
        for text in [
            "const A: f64 = 0.3;",
            "/// A share.\nconst A: f64 = 0.3;",
            "pub static A: usize = 3;",
            "const A: [f64; 2] = [0.3, 0.4];",
            "const A: &[f64] = &[0.3];",
            "const A: (f64, u8) = (0.3, 1);",
            "const A: std::ops::RangeInclusive<f64> = 0.3..=0.4;",
            "impl S { const A: f64 = 0.3; }",
            "fn f() { const A: f64 = 0.3; }",
            "// *Numeric.*\nconst A: f64 = 0.3;",
            "const A: f64 = B / 2.0;",
        ] {
            assert_eq!(count(text), 1, "{text}");
        }
    }

    #[test]
    fn marks_and_other_types_are_none() {
        for text in [
            "/// Standard gravity. *Physics.*\nconst A: f64 = 9.80665;",
            "/// A step.\n/// Fine enough. *Numeric.*\n#[allow(dead_code)]\nconst A: f64 = 0.3;",
            "/// A limit. *Decision.*\nstatic A: [usize; 2] = [1, 2];",
            "const A: &str = \"a\";",
            "const A: [&str; 2] = [\"a\", \"b\"];",
            "const A: Settings = Settings { b: 0.3 };",
            "#[cfg(test)] mod tests { const A: f64 = 0.3; }",
            "trait T { const A: f64; }",
            "const A: f64 = B;",
            "const A: f32 = b::C as f32;",
        ] {
            assert_eq!(count(text), 0, "{text}");
        }
    }

    #[test]
    fn a_comment_covers_the_group_below_it() {
        assert_eq!(
            count(
                "/// Steps. *Numeric.*\nconst A: f64 = 0.3;\n// why\nconst B: f64 = 0.3;\nconst C: [f64; 1] = [\n0.3,\n];\nconst D: u8 = 1;"
            ),
            0
        );
        assert_eq!(count("/// Steps.\nconst A: f64 = 0.3;\nconst B: f64 = 0.3;"), 2);
        assert_eq!(count("/// Steps. *Numeric.*\nconst A: f64 = 0.3;\n\nconst B: f64 = 0.3;"), 1);
        assert_eq!(count("/// Steps. *Numeric.*\nconst A: f64 = 0.3;\nfn f() {}\nconst B: f64 = 0.3;"), 1);
        assert_eq!(count("/// Steps. *Numeric.*\nconst A: f64 = 0.3;\n/// Without.\nconst B: f64 = 0.3;"), 1);
    }

    #[test]
    fn only_the_estimator_is_checked() {
        let count = |path: &str| check(&Tree::of(&[(path, "const A: f64 = 0.3;")])).len();
        assert_eq!(count("crates/sim/src/a.rs"), 0);
        assert_eq!(count("crates/signal/tests/a.rs"), 0);
        assert_eq!(count("crates/signal/src/a_tests.rs"), 0);
        assert_eq!(count("crates/rotor-speed/src/ridge/a.rs"), 1);
    }

    #[test]
    fn the_fault_names_line_constant_and_remedy() {
        let faults = check(&Tree::of(&[("crates/signal/src/a.rs", "/// A share.\nconst A: f64 = 0.3;")]));
        assert_eq!(
            faults[0].to_string(),
            "crates/signal/src/a.rs:2: A has no mark: write *Physics.*, *Numeric.* or *Decision.* in its doc comment, \
             or in that of the group it stands in"
        );
    }
}
