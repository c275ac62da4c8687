//! What people read: strings of the programs, help texts, the page, the documents.

use crate::tree::{Source, Tree};
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::fs;
use std::path::Path;

/// Folders and endings of files that are text as a whole.
const PLAIN: [(&str, &[&str]); 4] = [
    ("docs", &["md"]),
    ("docs/decisions", &["md"]),
    ("crates/page/templates", &["html", "js"]),
    ("crates/report/src", &["schema.json"]),
];
/// Files that are text as a whole, at the root.
const AT_ROOT: [&str; 1] = [README];
/// The first text that a user reads.
pub(super) const README: &str = "README.md";
/// The list of the forbidden words has all of them.
const GLOSSARY: &str = "docs/glossary.md";
/// Comments of this folder are the help of the command line.
const HELP: &str = "crates/cli/src/args/";

/// A text with its place.
pub(super) struct Text {
    pub(super) path: String,
    /// The line on which it begins.
    pub(super) line: usize,
    pub(super) content: String,
}

/// All texts.
///
/// # Errors
/// A file or a folder that cannot be read; a folder without texts.
pub(super) fn texts(root: &Path, tree: &Tree) -> Result<Vec<Text>, String> {
    let is_program = |source: &&Source| source.path.starts_with("crates/") && source.below_src().is_some();
    let mut all: Vec<Text> = tree
        .sources
        .iter()
        .filter(is_program)
        .filter(|source| !source.code.items.is_empty())
        .flat_map(strings)
        .collect();
    for (folder, endings) in PLAIN {
        let before = all.len();
        let failed = |error: std::io::Error| format!("{folder}: {error}");
        let mut names: Vec<String> = fs::read_dir(root.join(folder))
            .map_err(failed)?
            .map(|entry| Ok(entry.map_err(failed)?.file_name().to_string_lossy().into_owned()))
            .collect::<Result<_, String>>()?;
        names.sort();
        for name in names.into_iter().filter(|name| endings.iter().any(|ending| name.ends_with(&format!(".{ending}"))))
        {
            let path = format!("{folder}/{name}");
            if path != GLOSSARY {
                let content = fs::read_to_string(root.join(&path)).map_err(|error| format!("{path}: {error}"))?;
                all.push(Text { path, line: 1, content });
            }
        }
        if all.len() == before {
            return Err(format!("{folder} has no text"));
        }
    }
    for path in AT_ROOT {
        let content = fs::read_to_string(root.join(path)).map_err(|error| format!("{path}: {error}"))?;
        all.push(Text { path: path.to_owned(), line: 1, content });
    }
    Ok(all)
}

/// The strings of a Rust file without its tests and comments; in the help of the command line, the comments too.
fn strings(source: &Source) -> Vec<Text> {
    let tokens: TokenStream = source.text.parse().unwrap_or_default();
    let mut found = Vec::new();
    add(tokens, source, &mut found);
    found
}

fn add(tokens: TokenStream, source: &Source, found: &mut Vec<Text>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut at = 0;
    while let Some(token) = tokens.get(at) {
        match token {
            TokenTree::Punct(mark) if mark.as_char() == '#' => {
                let attribute = tokens[at + 1..].iter().find_map(|token| match token {
                    TokenTree::Group(group) if group.delimiter() == Delimiter::Bracket => Some(group.stream()),
                    _ => None,
                });
                let inner = attribute.clone().map(|tokens| tokens.to_string()).unwrap_or_default();
                let is_doc = inner.starts_with("doc");
                if is_doc && !source.path.starts_with(HELP) {
                    at += after_attribute(&tokens, at);
                    continue;
                }
                if inner.starts_with("cfg") && inner.contains("test") {
                    // the item of a test: to its body, or to its semicolon
                    at += after_attribute(&tokens, at);
                    while let Some(token) = tokens.get(at) {
                        at += 1;
                        let is_body = matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace);
                        if is_body || matches!(token, TokenTree::Punct(mark) if mark.as_char() == ';') {
                            break;
                        }
                    }
                    continue;
                }
            }
            TokenTree::Group(group) => add(group.stream(), source, found),
            TokenTree::Literal(literal) => {
                if let syn::Lit::Str(text) = syn::Lit::new(literal.clone()) {
                    let line = literal.span().start().line;
                    found.push(Text { path: source.path.clone(), line, content: text.value() });
                }
            }
            _ => {}
        }
        at += 1;
    }
}

/// Number of tokens of the attribute that begins here.
fn after_attribute(tokens: &[TokenTree], at: usize) -> usize {
    let is_brackets =
        |token: &TokenTree| matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Bracket);
    tokens[at..].iter().position(is_brackets).map_or(1, |index| index + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strings_of(path: &str, text: &str) -> Vec<(usize, String)> {
        let tree = Tree::of(&[(path, text)]);
        strings(&tree.sources[0]).into_iter().map(|text| (text.line, text.content)).collect()
    }

    const CODE: &str = "/// doc\nfn f() { g!(\"one {x}\",\n \"two \\\n three\"); }\n#[error(\"four\")]\nstruct S;\n#[cfg(test)]\nmod tests { fn t() { \"five\" } }\nconst A: &str = \"six\";";

    #[test]
    fn strings_are_found_with_their_lines_without_tests_and_comments() {
        let all = strings_of("crates/a/src/b.rs", CODE);
        let expected = [(2, "one {x}"), (3, "two three"), (5, "four"), (9, "six")];
        assert_eq!(all, expected.map(|(line, text)| (line, text.to_owned())));
    }

    #[test]
    fn comments_are_texts_where_they_are_help() {
        let all = strings_of("crates/cli/src/args/b.rs", CODE);
        assert!(all.contains(&(1, " doc".to_owned())), "{all:?}");
    }
}
