//! Which code is a test: rules on the structure of a crate do not hold for it.

use super::Source;
use std::collections::BTreeSet;
use syn::{Attribute, Expr, ImplItem, Item, Lit, Meta, Token, punctuated::Punctuated};

/// Removes modules and items that are compiled for tests only.
pub(super) fn remove_tests(items: &mut Vec<Item>) {
    items.retain(|item| !is_test(attributes(item)));
    for item in items {
        match item {
            Item::Mod(module) => {
                if let Some((_, items)) = &mut module.content {
                    remove_tests(items);
                }
            }
            Item::Impl(block) => block.items.retain(|item| !is_test(attributes_in_impl(item))),
            _ => {}
        }
    }
}

/// Is this a file of tests, by its name, its folder, or because a module for tests is loaded from it?
pub(super) fn is_test_file(path: &str, modules_for_tests: &BTreeSet<String>) -> bool {
    let stem = path.strip_suffix(".rs").unwrap_or(path);
    let name = stem.rsplit('/').next().unwrap_or(stem);
    let mut folders = stem.match_indices('/').map(|(end, _)| &stem[..end]);
    name == "tests"
        || name.ends_with("_tests")
        || folders.any(|folder| folder.ends_with("/tests") || modules_for_tests.contains(folder))
        || modules_for_tests.contains(stem)
}

/// Paths, without `.rs`, of the files that `source` loads as modules for tests.
pub(super) fn modules_for_tests(source: &Source) -> Vec<String> {
    let folder = source.path.rsplit_once('/').map_or("", |(folder, _)| folder);
    let is_root = ["/mod.rs", "/lib.rs", "/main.rs"].iter().any(|name| source.path.ends_with(name));
    let children = if is_root { folder } else { source.path.trim_end_matches(".rs") };
    let modules = source.file.items.iter().filter_map(|item| match item {
        Item::Mod(module) if module.content.is_none() && is_test(&module.attrs) => Some(module),
        _ => None,
    });
    modules
        .map(|module| match path_attribute(&module.attrs) {
            Some(path) => format!("{folder}/{}", path.trim_end_matches(".rs")),
            None => format!("{children}/{}", module.ident),
        })
        .collect()
}

fn path_attribute(attributes: &[Attribute]) -> Option<String> {
    attributes.iter().find_map(|attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("path") => match &pair.value {
            Expr::Lit(literal) => match &literal.lit {
                Lit::Str(text) => Some(text.value()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    })
}

/// Is the item compiled for tests only?
fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::List(list) if list.path.is_ident("cfg") => {
            attribute.parse_args::<Meta>().is_ok_and(|condition| needs_test(&condition))
        }
        Meta::Path(path) => path.is_ident("test"),
        _ => false,
    })
}

fn needs_test(condition: &Meta) -> bool {
    match condition {
        Meta::Path(path) => path.is_ident("test"),
        Meta::List(list) if list.path.is_ident("all") => list
            .parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated)
            .is_ok_and(|conditions| conditions.iter().any(needs_test)),
        _ => false,
    }
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

fn attributes_in_impl(item: &ImplItem) -> &[Attribute] {
    match item {
        ImplItem::Const(item) => &item.attrs,
        ImplItem::Fn(item) => &item.attrs,
        ImplItem::Type(item) => &item.attrs,
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::remove_tests;

    #[test]
    fn only_what_needs_a_test_build_is_removed() {
        let items_left = |text: &str| {
            let mut file = syn::parse_file(text).unwrap();
            remove_tests(&mut file.items);
            file.items.len()
        };
        assert_eq!(items_left("#[cfg(test)] mod tests {}"), 0);
        assert_eq!(items_left("#[cfg(all(test, unix))] fn f() {}"), 0);
        assert_eq!(items_left("#[cfg(test)] use std::fs;"), 0);
        assert_eq!(items_left("#[test] fn f() {}"), 0);
        assert_eq!(items_left("#[cfg(not(test))] fn f() {}"), 1);
        assert_eq!(items_left("#[cfg(any(test, unix))] fn f() {}"), 1);
        assert_eq!(items_left("mod tests {}"), 1);
    }

    #[test]
    fn tests_inside_modules_and_impls_are_removed() {
        let mut file = syn::parse_file("mod a { #[cfg(test)] fn f() {} } impl A { #[cfg(test)] fn g() {} }").unwrap();
        remove_tests(&mut file.items);
        let syn::Item::Mod(module) = &file.items[0] else { panic!() };
        assert!(module.content.as_ref().unwrap().1.is_empty());
        let syn::Item::Impl(block) = &file.items[1] else { panic!() };
        assert!(block.items.is_empty());
    }
}
