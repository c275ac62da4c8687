//! No function takes a tuple: at the call, nobody sees what its parts are.

use super::fault::Fault;
use super::functions::functions;
use crate::tree::Tree;
use syn::{FnArg, Pat, Type};

pub(super) fn check(tree: &Tree) -> Vec<Fault> {
    let mut faults = Vec::new();
    for source in &tree.sources {
        for function in functions(&source.code) {
            for parameter in &function.signature.inputs {
                if is_tuple(parameter) {
                    let message = format!(
                        "{}() takes a tuple: make it separate parameters, or a struct with named fields",
                        function.name()
                    );
                    faults.push(Fault::new(&source.path, function.line(), message));
                }
            }
        }
    }
    faults
}

/// Is the parameter a tuple or a reference to one, by its type or its pattern? `()` is none.
fn is_tuple(parameter: &FnArg) -> bool {
    let FnArg::Typed(parameter) = parameter else { return false };
    is_tuple_type(&parameter.ty) || is_tuple_pattern(&parameter.pat)
}

fn is_tuple_type(of: &Type) -> bool {
    match of {
        Type::Tuple(tuple) => !tuple.elems.is_empty(),
        Type::Reference(reference) => is_tuple_type(&reference.elem),
        Type::Paren(inner) => is_tuple_type(&inner.elem),
        _ => false,
    }
}

fn is_tuple_pattern(pattern: &Pat) -> bool {
    match pattern {
        Pat::Tuple(tuple) => !tuple.elems.is_empty(),
        Pat::Reference(reference) => is_tuple_pattern(&reference.pat),
        Pat::Paren(inner) => is_tuple_pattern(&inner.pat),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::check;
    use crate::tree::Tree;

    fn count(path: &str, text: &str) -> usize {
        check(&Tree::of(&[(path, text)])).len()
    }

    #[test]
    fn tuples_and_references_to_tuples_are_faults() {
        let path = "crates/cli/src/a.rs";
        assert_eq!(count(path, "fn f(pair: (f64, f64)) {}"), 1);
        assert_eq!(count(path, "fn f(pair: &(f64, f64)) {}"), 1);
        assert_eq!(count(path, "fn f(pair: &mut (f64, f64)) {}"), 1);
        assert_eq!(count(path, "fn f((a, b): Pair) {}"), 1);
        assert_eq!(count(path, "fn f(&(a, b): &(f64, f64), c: (u8,)) {}"), 2);
        assert_eq!(count(path, "impl A { fn f(&self, pair: (f64, f64)) {} }"), 1);
        assert_eq!(count(path, "trait T { fn f(&self, pair: (f64, f64)); }"), 1);
    }

    #[test]
    fn other_parameters_and_tests_are_none() {
        let path = "crates/cli/src/a.rs";
        assert_eq!(count(path, "fn f(pairs: &[(f64, f64)], more: Vec<(f64, f64)>, unit: ()) -> (f64, f64) {}"), 0);
        assert_eq!(count(path, "fn f() { let g = |(a, b): (f64, f64)| a + b; }"), 0);
        assert_eq!(count(path, "fn f(Pair { a, b }: Pair, [c, d]: [f64; 2]) {}"), 0);
        assert_eq!(count(path, "#[cfg(test)] mod tests { fn f(pair: (f64, f64)) {} }"), 0);
    }

    #[test]
    fn the_fault_names_line_function_and_remedy() {
        let faults = check(&Tree::of(&[("crates/cli/src/a.rs", "\nfn f(pair: (f64, f64)) {}")]));
        assert_eq!(
            faults[0].to_string(),
            "crates/cli/src/a.rs:2: f() takes a tuple: make it separate parameters, or a struct with named fields"
        );
    }
}
