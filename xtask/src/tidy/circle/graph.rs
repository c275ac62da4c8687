//! Which room uses which, and the circles in it.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// A name by which one room uses another, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Tie {
    pub(super) name: String,
    pub(super) path: String,
    pub(super) line: usize,
}

#[derive(Default)]
pub(super) struct Graph {
    edges: BTreeMap<String, BTreeMap<String, Vec<Tie>>>,
}

impl Graph {
    pub(super) fn add(&mut self, from: &str, to: &str, tie: Tie) {
        self.edges.entry(from.to_owned()).or_default().entry(to.to_owned()).or_default().push(tie);
    }

    pub(super) fn ties(&self, from: &str, to: &str) -> &[Tie] {
        self.edges.get(from).and_then(|to_all| to_all.get(to)).map_or(&[], Vec::as_slice)
    }

    /// The strongly connected components of more than one room, sorted.
    pub(super) fn knots(&self) -> Vec<Vec<String>> {
        let reached: BTreeMap<&str, BTreeSet<&str>> =
            self.edges.keys().map(|room| (room.as_str(), self.reached_from(room))).collect();
        let mut knots: BTreeSet<Vec<String>> = BTreeSet::new();
        for (room, reach) in &reached {
            if reach.contains(room) {
                let is_back = |other: &&&str| reached.get(**other).is_some_and(|back| back.contains(room));
                knots.insert(reach.iter().filter(is_back).map(|&other| other.to_owned()).collect());
            }
        }
        knots.into_iter().collect()
    }

    /// The rooms of a shortest circle within a knot, each used by the one before it, the first by the last.
    pub(super) fn shortest_circle(&self, knot: &[String]) -> Vec<String> {
        let circles = knot.iter().filter_map(|room| self.circle_from(room));
        circles.min_by_key(Vec::len).unwrap_or_default()
    }

    fn used_by<'graph>(&'graph self, room: &str) -> impl Iterator<Item = &'graph str> + use<'graph> {
        self.edges.get(room).into_iter().flat_map(BTreeMap::keys).map(String::as_str)
    }

    fn reached_from(&self, room: &str) -> BTreeSet<&str> {
        let mut reached = BTreeSet::new();
        let mut open: Vec<&str> = self.used_by(room).collect();
        while let Some(next) = open.pop() {
            if reached.insert(next) {
                open.extend(self.used_by(next));
            }
        }
        reached
    }

    /// The shortest way from a room back to itself.
    fn circle_from(&self, room: &str) -> Option<Vec<String>> {
        let mut before: BTreeMap<&str, &str> = BTreeMap::new();
        let mut open: VecDeque<&str> = VecDeque::from([room]);
        while let Some(at) = open.pop_front() {
            for next in self.used_by(at) {
                if next == room {
                    let mut circle = vec![at.to_owned()];
                    let mut last = at;
                    while last != room {
                        last = before.get(last)?;
                        circle.push(last.to_owned());
                    }
                    circle.reverse();
                    return Some(circle);
                }
                if !before.contains_key(next) {
                    before.insert(next, at);
                    open.push_back(next);
                }
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::{Graph, Tie};

    fn graph(edges: &[&str]) -> Graph {
        let mut graph = Graph::default();
        for edge in edges {
            let (from, to) = edge.split_at(1);
            graph.add(from, to, Tie { name: String::new(), path: String::new(), line: 1 });
        }
        graph
    }

    #[test]
    fn knots_are_separated() {
        assert!(graph(&["ab", "bc", "ac"]).knots().is_empty());
        assert_eq!(graph(&["ab", "ba", "bc", "cd", "dc"]).knots(), [["a", "b"], ["c", "d"]]);
        assert_eq!(graph(&["ab", "bc", "ca"]).knots(), [["a", "b", "c"]]);
    }

    #[test]
    fn the_shortest_circle_is_found() {
        let graph = graph(&["ab", "bc", "cd", "da", "db"]);
        assert_eq!(graph.shortest_circle(&graph.knots()[0]), ["b", "c", "d"]);
    }
}
