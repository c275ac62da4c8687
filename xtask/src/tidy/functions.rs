//! All functions of a file: items, methods, methods of traits; also those inside other functions. No closures.

use syn::visit::{self, Visit};
use syn::{Block, File, ImplItemFn, ItemFn, Signature, TraitItemFn};

pub(super) struct Function<'file> {
    pub(super) signature: &'file Signature,
    /// `None` for a method that a trait only declares.
    pub(super) body: Option<&'file Block>,
}

impl Function<'_> {
    /// The line of the word `fn`.
    pub(super) fn line(&self) -> usize {
        self.signature.fn_token.span.start().line
    }

    pub(super) fn name(&self) -> String {
        self.signature.ident.to_string()
    }
}

pub(super) fn functions(file: &File) -> Vec<Function<'_>> {
    let mut collector = Collector { found: Vec::new() };
    collector.visit_file(file);
    collector.found
}

struct Collector<'file> {
    found: Vec<Function<'file>>,
}

impl<'file> Visit<'file> for Collector<'file> {
    fn visit_item_fn(&mut self, item: &'file ItemFn) {
        self.found.push(Function { signature: &item.sig, body: Some(&item.block) });
        visit::visit_item_fn(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'file ImplItemFn) {
        self.found.push(Function { signature: &item.sig, body: Some(&item.block) });
        visit::visit_impl_item_fn(self, item);
    }

    fn visit_trait_item_fn(&mut self, item: &'file TraitItemFn) {
        self.found.push(Function { signature: &item.sig, body: item.default.as_ref() });
        visit::visit_trait_item_fn(self, item);
    }
}

#[cfg(test)]
mod tests {
    use super::functions;

    #[test]
    fn functions_are_found_wherever_they_stand() {
        let text = "fn a() { fn b() {} let closure = |x: u8| x; }\nimpl A { fn c(&self) {} }\n\
                    trait T { fn d(&self);\nfn e(&self) {} }\nmod m { fn f() {} }";
        let file = syn::parse_file(text).unwrap();
        let found: Vec<(String, usize)> = functions(&file).iter().map(|f| (f.name(), f.line())).collect();
        let expected = [("a", 1), ("b", 1), ("c", 2), ("d", 3), ("e", 4), ("f", 5)];
        assert_eq!(found, expected.map(|(name, line)| (name.to_owned(), line)));
    }
}
