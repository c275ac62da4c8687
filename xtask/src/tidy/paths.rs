//! All paths that the code of a file names: in `use`, in types and expressions, in macros and attributes.

use super::fault::Fault;
use crate::tree::{Source, Tree};
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, Block, File, ItemMod, ItemUse, Lit, Macro, Meta, Path, UseTree, VisRestricted};

/// A path as it is written: `crate::room::Thing`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct NamedPath {
    /// A macro has its `!`: `["println!"]`.
    pub(super) segments: Vec<String>,
    pub(super) line: usize,
    /// Modules written out in the file around the path, outermost first.
    pub(super) module: Vec<String>,
    pub(super) kind: PathKind,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum PathKind {
    /// By a `use` of a module, which gives the name.
    Import { name: String },
    /// By a `use` of a module that ends in `*`; the segments stop before it.
    Glob,
    /// Anywhere else, or by a `use` inside a function.
    Inline,
}

impl NamedPath {
    pub(super) fn text(&self) -> String {
        let end = if self.kind == PathKind::Glob { "::*" } else { "" };
        format!("{}{end}", self.segments.join("::"))
    }
}

/// A fault at each path of the wanted sources for which there is a message.
pub(super) fn faults_of_paths(
    tree: &Tree,
    is_checked: impl Fn(&Source) -> bool,
    message_of: impl Fn(&NamedPath) -> Option<String>,
) -> Vec<Fault> {
    let of_source = |source: &Source| -> Vec<Fault> {
        let fault = |path: NamedPath| Some(Fault::new(&source.path, path.line, message_of(&path)?));
        paths(&source.code).into_iter().filter_map(fault).collect()
    };
    tree.sources.iter().filter(|source| is_checked(source)).flat_map(of_source).collect()
}

pub(super) fn paths(file: &File) -> Vec<NamedPath> {
    let mut collector = Collector { found: Vec::new(), module: Vec::new(), blocks: 0 };
    collector.visit_file(file);
    collector.found
}

struct Collector {
    found: Vec<NamedPath>,
    module: Vec<String>,
    /// Depth of blocks of functions.
    blocks: usize,
}

impl Collector {
    fn add(&mut self, segments: Vec<String>, line: usize, kind: PathKind) {
        self.found.push(NamedPath { segments, line, module: self.module.clone(), kind });
    }

    fn add_use(&mut self, before: &[String], tree: &UseTree) {
        let with = |name: String| [before, &[name]].concat();
        match tree {
            UseTree::Path(path) => self.add_use(&with(path.ident.to_string()), &path.tree),
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.add_use(before, tree)),
            UseTree::Glob(glob) => self.add_import(before.to_vec(), glob.star_token.span.start().line, PathKind::Glob),
            UseTree::Name(leaf) => {
                let name = leaf.ident.to_string();
                let line = leaf.ident.span().start().line;
                if name == "self" {
                    let name = before.last().cloned().unwrap_or_default();
                    self.add_import(before.to_vec(), line, PathKind::Import { name });
                } else {
                    self.add_import(with(name.clone()), line, PathKind::Import { name });
                }
            }
            UseTree::Rename(leaf) => {
                let own = leaf.ident.to_string();
                let segments = if own == "self" { before.to_vec() } else { with(own) };
                let name = leaf.rename.to_string();
                self.add_import(segments, leaf.ident.span().start().line, PathKind::Import { name });
            }
        }
    }

    fn add_import(&mut self, segments: Vec<String>, line: usize, kind: PathKind) {
        let is_named = self.blocks > 0 && kind != PathKind::Glob;
        self.add(segments, line, if is_named { PathKind::Inline } else { kind });
    }

    /// Paths and macros in code that is not parsed.
    fn add_tokens(&mut self, tokens: TokenStream) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let is_punct =
            |at: usize, sign: char| matches!(tokens.get(at), Some(TokenTree::Punct(p)) if p.as_char() == sign);
        let is_colons = |at: usize| is_punct(at, ':') && is_punct(at + 1, ':');
        let mut at = 0;
        while at < tokens.len() {
            match &tokens[at] {
                TokenTree::Ident(first) => {
                    let mut segments = vec![first.to_string()];
                    while is_colons(at + 1) {
                        let Some(TokenTree::Ident(next)) = tokens.get(at + 3) else { break };
                        segments.push(next.to_string());
                        at += 3;
                    }
                    let is_macro = is_punct(at + 1, '!') && matches!(tokens.get(at + 2), Some(TokenTree::Group(_)));
                    if let Some(last) = segments.last_mut().filter(|_| is_macro) {
                        last.push('!');
                    }
                    self.add(segments, first.span().start().line, PathKind::Inline);
                }
                TokenTree::Group(group) if group.delimiter() != Delimiter::None || !group.stream().is_empty() => {
                    self.add_tokens(group.stream());
                }
                _ => {}
            }
            at += 1;
        }
    }

    /// Paths in the strings of an attribute, as in `#[serde(with = "crate::room::format")]`.
    fn add_strings(&mut self, tokens: TokenStream) {
        for token in tokens {
            match token {
                TokenTree::Group(group) => self.add_strings(group.stream()),
                TokenTree::Literal(literal) => {
                    if let Lit::Str(text) = Lit::new(literal.clone()) {
                        let segments: Vec<String> = text.value().split("::").map(str::to_owned).collect();
                        if segments.len() > 1 {
                            self.add(segments, literal.span().start().line, PathKind::Inline);
                        }
                    }
                }
                _ => {}
            }
        }
    }
}

impl<'file> Visit<'file> for Collector {
    fn visit_item_use(&mut self, item: &'file ItemUse) {
        self.add_use(&[], &item.tree);
    }

    fn visit_item_mod(&mut self, item: &'file ItemMod) {
        self.module.push(item.ident.to_string());
        visit::visit_item_mod(self, item);
        self.module.pop();
    }

    fn visit_block(&mut self, block: &'file Block) {
        self.blocks += 1;
        visit::visit_block(self, block);
        self.blocks -= 1;
    }

    fn visit_path(&mut self, path: &'file Path) {
        let segments: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        let line = path.segments.first().map_or(0, |segment| segment.ident.span().start().line);
        self.add(segments, line, PathKind::Inline);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, item: &'file Macro) {
        let mut segments: Vec<String> = item.path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        let line = item.path.segments.first().map_or(0, |segment| segment.ident.span().start().line);
        if let Some(last) = segments.last_mut() {
            last.push('!');
        }
        self.add(segments, line, PathKind::Inline);
        self.add_tokens(item.tokens.clone());
    }

    fn visit_attribute(&mut self, attribute: &'file Attribute) {
        if let Meta::List(list) = &attribute.meta {
            self.add_tokens(list.tokens.clone());
            self.add_strings(list.tokens.clone());
        }
    }

    /// `pub(in crate::room)` uses nothing.
    fn visit_vis_restricted(&mut self, _: &'file VisRestricted) {}
}

#[cfg(test)]
mod tests {
    use super::{PathKind, paths};

    /// Paths of more than one segment, and macros.
    fn long_paths(text: &str) -> Vec<String> {
        let file = syn::parse_file(text).unwrap();
        let found = paths(&file).into_iter().map(|path| path.text());
        found.filter(|path| path.contains("::") || path.ends_with('!')).collect()
    }

    #[test]
    fn uses_are_spelled_out() {
        assert_eq!(
            long_paths("use crate::{a::{self, B}, c::D as E, f::*};"),
            ["crate::a", "crate::a::B", "crate::c::D", "crate::f::*"]
        );
        assert_eq!(long_paths("fn f() { use super::a::b; }"), ["super::a::b"]);
    }

    #[test]
    fn an_import_has_the_name_it_gives() {
        let file = syn::parse_file("use crate::a::{self as b, C, D as E};\nmod m { use crate::g; }").unwrap();
        let names: Vec<String> = paths(&file)
            .into_iter()
            .filter_map(|path| match path.kind {
                PathKind::Import { name } => Some(format!("{}/{name}", path.module.join("::"))),
                _ => None,
            })
            .collect();
        assert_eq!(names, ["/b", "/C", "/E", "m/g"]);
    }

    #[test]
    fn types_expressions_and_patterns_are_read() {
        let text = "fn f(a: crate::a::A) -> Vec<crate::b::B> { let crate::c::C { x } = y else { return <D as crate::d::T>::t() }; }";
        assert_eq!(long_paths(text), ["crate::a::A", "crate::b::B", "crate::c::C", "crate::d::T::t"]);
    }

    #[test]
    fn macros_and_attributes_are_read() {
        assert_eq!(
            long_paths("fn f() { format!(\"{}\", crate::a::b(self.c, [super::d::E; 2])); }"),
            ["format!", "crate::a::b", "super::d::E"]
        );
        assert_eq!(long_paths("fn f() { assert!(vec![1] == g()); }"), ["assert!", "vec!"]);
        assert_eq!(long_paths("macro_rules! m { () => { $crate::a::b() } }"), ["macro_rules!", "crate::a::b"]);
        assert_eq!(long_paths("#[serde(with = \"crate::a\")] struct S;"), ["crate::a"]);
    }

    #[test]
    fn comments_and_visibilities_name_nothing() {
        assert!(long_paths("/// See [`crate::a::B`].\npub(in crate::c) fn f() {}").is_empty());
    }
}
