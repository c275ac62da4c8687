//! Code that some rules do not hold for yet: the one list of it, with a reason each.

use super::fault::Fault;
use crate::tree::Tree;

const FRONT_END: &str =
    "the decisions of the front end are replaced as a whole by the next step; until then they stay as they are";

/// A file, or a folder with `/` at its end, that the rules on tuple parameters, long functions, constants and numbers do not check. The
/// rules on circles, dependencies and the rest hold for it.
struct Exemption {
    path: &'static str,
    reason: &'static str,
}

/// The line of the list.
const LIST_LINE: usize = line!() as usize + 1;
const EXEMPT: [Exemption; 1] = [Exemption { path: "crates/rotor-speed/src/rotors/", reason: FRONT_END }];

/// Is the file exempt from the rules on tuple parameters, long functions, constants and numbers?
pub(super) fn is_exempt(path: &str) -> bool {
    EXEMPT.iter().any(|exemption| covers(exemption, path))
}

/// Every exemption covers a file.
pub(super) fn check(tree: &Tree) -> Vec<Fault> {
    let stale = EXEMPT.iter().filter(|exemption| !tree.sources.iter().any(|source| covers(exemption, &source.path)));
    stale
        .map(|exemption| {
            let what = format!("{} ({}) holds no source file: remove it from EXEMPT", exemption.path, exemption.reason);
            Fault::new(file!(), LIST_LINE, what)
        })
        .collect()
}

fn covers(exemption: &Exemption, path: &str) -> bool {
    if exemption.path.ends_with('/') { path.starts_with(exemption.path) } else { path == exemption.path }
}

#[cfg(test)]
mod tests {
    use super::{EXEMPT, check, is_exempt};
    use crate::tree::Tree;

    #[test]
    fn folders_and_files_are_exempt() {
        assert!(is_exempt("crates/rotor-speed/src/rotors/pace.rs"));
        assert!(!is_exempt("crates/rotor-speed/src/rotors.rs"));
        assert!(!is_exempt("crates/rotor-speed/src/harmonic/mod.rs"));
    }

    #[test]
    fn an_exemption_of_nothing_is_a_fault() {
        let faults = check(&Tree::of(&[("crates/a/src/lib.rs", "")]));
        assert_eq!(faults.len(), EXEMPT.len());
        assert!(faults[0].message.contains("crates/rotor-speed/src/rotors/"));
    }
}
