//! From a path inside a crate to the room that it leads to.

use crate::tidy::paths::{PathKind, paths};
use crate::tree::Source;
use std::collections::{BTreeMap, BTreeSet};
use syn::Item;

/// Re-exports of re-exports that are followed; more are a loop.
const STEPS_MAX: usize = 16;

/// The rooms of a crate, and the names that `lib.rs` and `main.rs` give to what is in them.
#[derive(Default)]
pub(super) struct Door {
    rooms: BTreeSet<String>,
    /// Modules written out in the door.
    modules: BTreeSet<Vec<String>>,
    /// From a name in the door, with its modules, to the path behind it.
    names: BTreeMap<Vec<String>, Vec<String>>,
    /// Module of the door → module whose names it all gives.
    globs: Vec<(Vec<String>, Vec<String>)>,
    /// Items that each room defines.
    items: BTreeMap<String, BTreeSet<String>>,
}

impl Door {
    pub(super) fn of(sources: &[&Source]) -> Self {
        let mut door = Self::default();
        for source in sources {
            if let Some(room) = source.module().into_iter().next() {
                door.items.entry(room.clone()).or_default().extend(names_of_items(&source.code.items));
                door.rooms.insert(room);
            }
        }
        for source in sources.iter().filter(|source| source.module().is_empty()) {
            door.add_modules(&[], &source.code.items);
        }
        for source in sources.iter().filter(|source| source.module().is_empty()) {
            door.add_names(source);
        }
        door
    }

    fn add_modules(&mut self, before: &[String], items: &[Item]) {
        for item in items {
            if let Item::Mod(module) = item
                && let Some((_, items)) = &module.content
            {
                let path = [before, &[module.ident.to_string()]].concat();
                self.add_modules(&path, items);
                self.modules.insert(path);
            }
        }
    }

    fn add_names(&mut self, source: &Source) {
        let imports: Vec<_> = paths(&source.code).into_iter().filter(|path| path.kind != PathKind::Inline).collect();
        let names: BTreeSet<Vec<String>> = imports
            .iter()
            .filter_map(|path| match &path.kind {
                PathKind::Import { name } => Some([path.module.as_slice(), std::slice::from_ref(name)].concat()),
                _ => None,
            })
            .collect();
        for path in imports {
            let target = absolute(&path.module, &path.segments).or_else(|| {
                let first = [&path.module[..], &path.segments[..1.min(path.segments.len())]].concat();
                let is_room =
                    path.module.is_empty() && path.segments.first().is_some_and(|first| self.rooms.contains(first));
                let is_inside = is_room || self.modules.contains(&first) || names.contains(&first);
                is_inside.then(|| [path.module.clone(), path.segments.clone()].concat())
            });
            let Some(target) = target else { continue };
            match path.kind {
                PathKind::Import { name } => {
                    let name = [path.module.as_slice(), &[name]].concat();
                    if name != target {
                        self.names.insert(name, target);
                    }
                }
                PathKind::Glob => self.globs.push((path.module, target)),
                PathKind::Inline => {}
            }
        }
    }

    /// The room that a path, counted from the root of the crate, leads to; `None` for what stands in the door itself or in another crate.
    pub(super) fn room(&self, path: &[String]) -> Option<String> {
        self.room_within(path, STEPS_MAX)
    }

    fn room_within(&self, path: &[String], steps: usize) -> Option<String> {
        let steps = steps.checked_sub(1)?;
        for (depth, segment) in path.iter().enumerate() {
            let (module, name) = (&path[..depth], &path[..=depth]);
            if depth == 0 && self.rooms.contains(segment) {
                return Some(segment.clone());
            }
            if let Some(target) = self.names.get(name) {
                return self.room_within(&[target, &path[depth + 1..]].concat(), steps);
            }
            if self.modules.contains(name) {
                continue;
            }
            let globs = self.globs.iter().filter(|(from, _)| from == module);
            return globs
                .filter_map(|(_, target)| self.room_within(target, steps))
                .find(|room| self.defines(room, segment));
        }
        None
    }

    fn defines(&self, room: &str, item: &str) -> bool {
        self.items.get(room).is_some_and(|items| items.contains(item))
    }
}

/// The path counted from the root of the crate, if it begins with `crate`, `self` or `super`; `module` is where it is written.
pub(super) fn absolute(module: &[String], segments: &[String]) -> Option<Vec<String>> {
    let mut base = match segments.first()?.as_str() {
        "crate" => Vec::new(),
        "self" | "super" => module.to_vec(),
        _ => return None,
    };
    let mut rest = segments;
    while let Some(first) = rest.first() {
        match first.as_str() {
            "super" => base.truncate(base.len().checked_sub(1)?),
            "self" | "crate" => {}
            _ => break,
        }
        rest = &rest[1..];
    }
    base.extend(rest.iter().cloned());
    Some(base)
}

fn names_of_items(items: &[Item]) -> Vec<String> {
    let mut names = Vec::new();
    for item in items {
        let name = match item {
            Item::Const(item) => &item.ident,
            Item::Enum(item) => &item.ident,
            Item::Fn(item) => &item.sig.ident,
            Item::Mod(item) => &item.ident,
            Item::Static(item) => &item.ident,
            Item::Struct(item) => &item.ident,
            Item::Trait(item) => &item.ident,
            Item::Type(item) => &item.ident,
            _ => continue,
        };
        names.push(name.to_string());
    }
    names
}

#[cfg(test)]
mod tests {
    use super::absolute;

    fn path(text: &str) -> Vec<String> {
        text.split("::").filter(|segment| !segment.is_empty()).map(str::to_owned).collect()
    }

    #[test]
    fn paths_are_counted_from_the_root() {
        let at = path("room::part");
        assert_eq!(absolute(&at, &path("crate::a::B")), Some(path("a::B")));
        assert_eq!(absolute(&at, &path("self::a")), Some(path("room::part::a")));
        assert_eq!(absolute(&at, &path("super::a")), Some(path("room::a")));
        assert_eq!(absolute(&at, &path("self::super::super::a")), Some(path("a")));
        assert_eq!(absolute(&at, &path("super::super::super::a")), None);
        assert_eq!(absolute(&at, &path("std::fs")), None);
    }
}
