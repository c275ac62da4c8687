//! The recordings of an archive in the order of its tables, each with the name of its part.

use sha2::{Digest, Sha256};
use std::fmt::Write as _;

/// Bytes of a hash in the name of a part: by chance, two of a million million recordings share none.
const NAME_BYTES: usize = 16;

/// A recording that belongs to the archive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Planned {
    /// Its name in the tables.
    pub name: String,
    /// Name of its part, with one folder: `0f/0f…`.
    pub part: String,
}

impl Planned {
    /// Hexadecimal letters in the name of a part, without its folder.
    pub const HASH_LETTERS: usize = 2 * NAME_BYTES;
}

/// All recordings, sorted by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    recordings: Vec<Planned>,
}

impl Plan {
    /// From the names in any order. `state` tells a recording from an earlier one of the same name: a recording that changed has another part.
    pub fn of(mut names: Vec<String>, state: impl Fn(&str) -> String) -> Self {
        names.sort();
        names.dedup();
        let planned = |name: String| Planned { part: part_name(&name, &state(&name)), name };
        Self { recordings: names.into_iter().map(planned).collect() }
    }

    /// The recordings in the order of the tables.
    pub fn recordings(&self) -> &[Planned] {
        &self.recordings
    }
}

fn part_name(name: &str, state: &str) -> String {
    let hash = Sha256::new().chain_update(name).chain_update([0]).chain_update(state).finalize();
    let mut text = String::new();
    for byte in hash.iter().take(NAME_BYTES) {
        // writing to a string does not fail
        let _ = write!(text, "{byte:02x}");
    }
    format!("{}/{text}", text.get(..2).unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_is_that_of_the_names_and_a_changed_recording_has_another_part() {
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let one = Plan::of(names(&["b", "a", "b"]), |_| "1".to_owned());
        assert_eq!(one, Plan::of(names(&["a", "b"]), |_| "1".to_owned()));
        assert_eq!(one.recordings().iter().map(|planned| planned.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
        let changed = Plan::of(names(&["a", "b"]), |name| if name == "b" { "2" } else { "1" }.to_owned());
        let same = |index: usize| one.recordings()[index].part == changed.recordings()[index].part;
        assert!(same(0) && !same(1));
        assert_eq!(one.recordings()[0].part.len(), 2 + 1 + 2 * NAME_BYTES);
    }
}
