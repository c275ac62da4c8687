//! Rooms of a crate do not use each other in a circle.
//!
//! A room is a folder or a file directly under `src`. `lib.rs` and `main.rs` are doors: a name that goes through a door leads to the room
//! that defines it.

mod door;
mod graph;

use super::fault::Fault;
use super::paths::{NamedPath, PathKind, paths};
use crate::tree::{Source, Tree};
use door::{Door, absolute};
use graph::{Graph, Tie};

/// Names that a message shows of each pair of rooms.
const NAMES_SHOWN: usize = 6;

pub(super) fn check(tree: &Tree) -> Vec<Fault> {
    tree.crate_names().into_iter().flat_map(|name| check_crate(tree, name)).collect()
}

fn check_crate(tree: &Tree, crate_name: &str) -> Vec<Fault> {
    let of_crate = |source: &&Source| source.crate_name == crate_name && source.below_src().is_some();
    let sources: Vec<&Source> = tree.sources.iter().filter(of_crate).collect();
    let door = Door::of(&sources);
    let mut graph = Graph::default();
    let mut faults = Vec::new();
    for source in &sources {
        let Some(room) = source.module().into_iter().next() else { continue };
        for path in paths(&source.code) {
            let module = [source.module(), path.module.clone()].concat();
            let Some(target) = absolute(&module, &path.segments) else { continue };
            if target.is_empty() && path.kind == PathKind::Glob {
                faults.push(glob_of_the_door(source, &path));
            } else if let Some(other) = door.room(&target).filter(|other| *other != room) {
                graph.add(&room, &other, Tie { name: path.text(), path: source.path.clone(), line: path.line });
            }
        }
    }
    faults.extend(graph.knots().iter().map(|knot| circle(crate_name, &graph, knot)));
    faults
}

fn glob_of_the_door(source: &Source, path: &NamedPath) -> Fault {
    let message = format!("{} hides which rooms are used: name each item", path.text());
    Fault::new(&source.path, path.line, message)
}

/// The fault of rooms that all lead to each other: their shortest circle.
fn circle(crate_name: &str, graph: &Graph, knot: &[String]) -> Fault {
    let circle = graph.shortest_circle(knot);
    let pairs = circle.iter().zip(circle.iter().cycle().skip(1));
    let ties: Vec<String> = pairs.map(|(from, to)| tie_in_words(from, to, graph.ties(from, to))).collect();
    let first = match circle.as_slice() {
        [from, to, ..] => graph.ties(from, to).first(),
        _ => None,
    };
    let way: Vec<&str> = circle.iter().chain(circle.first()).map(String::as_str).collect();
    let mut message = format!("rooms of {crate_name} in a circle, {}: {}; ", way.join(" → "), ties.join("; "));
    if knot.len() > circle.len() {
        message.push_str(&format!("{} rooms hang together in circles: {}; ", knot.len(), knot.join(", ")));
    }
    message.push_str("move what both need to a room below them, or hand it over as a parameter");
    Fault::new(first.map_or("", |tie| &tie.path), first.map_or(0, |tie| tie.line), message)
}

fn tie_in_words(from: &str, to: &str, ties: &[Tie]) -> String {
    let mut names: Vec<&str> = ties.iter().map(|tie| tie.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let more = names.len().saturating_sub(NAMES_SHOWN);
    names.truncate(NAMES_SHOWN);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let place = ties.first().map_or_else(String::new, |tie| format!(" ({}:{})", tie.path, tie.line));
    format!("{from} uses {}{more} of {to}{place}", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::check;
    use crate::tree::Tree;

    /// The messages for a crate with these files below `src`.
    fn messages(files: &[(&str, &str)]) -> Vec<String> {
        let paths: Vec<String> = files.iter().map(|(path, _)| format!("crates/a/src/{path}")).collect();
        let files: Vec<(&str, &str)> =
            paths.iter().map(String::as_str).zip(files.iter().map(|(_, text)| *text)).collect();
        check(&Tree::of(&files)).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_circle_of_two_rooms_is_a_fault_with_its_names() {
        let found = messages(&[
            ("lib.rs", "mod north; mod south;"),
            ("north.rs", "\nuse crate::south::S;"),
            ("south/mod.rs", "mod deep;"),
            ("south/deep.rs", "fn f() { crate::north::n(); }"),
        ]);
        let expected = "crates/a/src/north.rs:2: rooms of a in a circle, north → south → north: \
                        north uses crate::south::S of south (crates/a/src/north.rs:2); \
                        south uses crate::north::n of north (crates/a/src/south/deep.rs:1); \
                        move what both need to a room below them, or hand it over as a parameter";
        assert_eq!(found, [expected]);
    }

    #[test]
    fn one_way_is_none() {
        assert!(
            messages(&[("lib.rs", "mod a; mod b;"), ("a.rs", "use crate::b::B;"), ("b.rs", "use std::fmt;")])
                .is_empty()
        );
        assert!(messages(&[("room/mod.rs", "use self::x::X;"), ("room/x.rs", "use super::Y;")]).is_empty());
    }

    #[test]
    fn names_through_the_door_lead_to_their_room() {
        let south = ("south.rs", "use crate::north::N;");
        for (door, north) in [
            ("mod north; mod south; pub use south::S;", "use crate::S;"),
            ("mod north; mod south; pub use crate::south::S as T;", "use super::T;"),
            ("mod north; mod south; pub use south::*;", "fn f(s: crate::Star) {}"),
            ("mod north; mod south; pub mod topic { pub use crate::south::S; }", "use crate::topic::S;"),
            ("mod north; mod south; pub mod topic { pub use super::south::S; } pub use topic::S;", "use crate::S;"),
        ] {
            let south = if door.contains('*') { ("south.rs", "use crate::north::N; pub struct Star;") } else { south };
            assert_eq!(messages(&[("lib.rs", door), ("north.rs", north), south]).len(), 1, "{door}");
        }
        let other_crate = "mod north; mod south; pub use other::S; pub struct T;";
        assert!(messages(&[("lib.rs", other_crate), ("north.rs", "use crate::{S, T};"), south]).is_empty());
    }

    #[test]
    fn paths_are_resolved_from_the_module_of_the_file() {
        let back = ("low.rs", "use crate::high::H;");
        assert_eq!(messages(&[("lib.rs", ""), ("high.rs", "use super::low::L;"), back]).len(), 1);
        assert_eq!(messages(&[("lib.rs", ""), ("high/mod.rs", "use super::low::L;"), back]).len(), 1);
        assert_eq!(messages(&[("lib.rs", ""), ("high/part.rs", "use super::super::low::L;"), back]).len(), 1);
        assert_eq!(messages(&[("lib.rs", ""), ("high/part/mod.rs", "use super::super::low::L;"), back]).len(), 1);
        assert_eq!(messages(&[("lib.rs", ""), ("high.rs", "mod m { use super::super::low::L; }"), back]).len(), 1);
        // `low` is here a part of `high`.
        assert_eq!(messages(&[("lib.rs", ""), ("high/part.rs", "use super::low::L;"), back]).len(), 0);
        assert_eq!(messages(&[("lib.rs", ""), ("high.rs", "use self::low::L; use low::M;"), back]).len(), 0);
    }

    #[test]
    fn tests_do_not_tie() {
        let back = ("low.rs", "use crate::high::H;");
        assert!(messages(&[("high.rs", "#[cfg(test)] mod tests { use crate::low::L; }"), back]).is_empty());
        assert!(messages(&[("high/mod.rs", ""), ("high/tests.rs", "use crate::low::L;"), back]).is_empty());
        assert!(messages(&[("high/mod.rs", ""), ("high/map_tests.rs", "use crate::low::L;"), back]).is_empty());
    }

    #[test]
    fn macros_tie() {
        let back = ("low.rs", "use crate::high::H;");
        assert_eq!(messages(&[("high.rs", "fn f() { assert!(crate::low::is_low(1)); }"), back]).len(), 1);
    }

    #[test]
    fn the_shortest_circle_of_each_knot_is_shown() {
        let found = messages(&[
            ("a.rs", "use crate::b::B;"),
            ("b.rs", "use crate::c::C;"),
            ("c.rs", "use crate::{a::A, b::B};"),
            ("x.rs", "use crate::y::Y;"),
            ("y.rs", "use crate::x::X;"),
        ]);
        assert_eq!(found.len(), 2);
        assert!(
            found[0].contains("in a circle, b → c → b:")
                && found[0].contains("3 rooms hang together in circles: a, b, c;")
        );
        assert!(found[1].contains("in a circle, x → y → x:") && !found[1].contains("hang together"));
    }

    #[test]
    fn a_glob_of_the_door_is_a_fault() {
        assert_eq!(
            messages(&[("lib.rs", ""), ("a.rs", "use super::*;"), ("b/c.rs", "use super::*;")]),
            ["crates/a/src/a.rs:1: super::* hides which rooms are used: name each item"]
        );
    }
}
