//! Which rotor of the later archive is which of the earlier one, where only their speeds are known.
//!
//! By rank, the fastest rotor is compared with the fastest one, and so on. Ranks cross where a rotor changes its speed by more than the distance
//! to the next one. Then another pairing of the rotors leaves at least as many of them unchanged, and the sound alone does not say which pairing
//! is right.

use super::Change;
use super::tail::two_sided;

/// The changes from each earlier rotor (outer) to each later rotor (inner), both by rank; absent where an uncertainty is not known.
pub(super) struct Crossed {
    changes: Vec<Vec<Option<Change>>>,
    /// A chance below this one is that of a change.
    chance: f64,
}

impl Crossed {
    /// Of `count` rotors, with the change from each to each.
    pub(super) fn of(count: usize, chance: f64, change: impl Fn(usize, usize) -> Option<Change>) -> Self {
        let row = |earlier: usize| (1..=count).map(|later| change(earlier, later)).collect();
        Self { changes: (1..=count).map(row).collect(), chance }
    }

    /// For each rotor, another later rotor that it can be as well as the one of its own rank: in a pairing that leaves the most rotors unchanged,
    /// and with a change that differs by more than its uncertainty.
    pub(super) fn rivals(&self) -> Vec<Option<usize>> {
        let count = self.changes.len();
        let mut rivals = vec![None; count];
        let most = self.pairing(None).iter().flatten().count();
        for (earlier, later) in (0..count).flat_map(|earlier| (0..count).map(move |later| (earlier, later))) {
            if earlier == later || !self.is_unchanged(earlier, later) {
                continue;
            }
            let pairing = self.pairing(Some((earlier, later)));
            if pairing.iter().flatten().count() < most {
                continue;
            }
            for (rotor, other) in completed(&pairing).into_iter().enumerate() {
                if other != rotor && self.differs(rotor, other) {
                    rivals[rotor].get_or_insert(other + 1);
                }
            }
        }
        rivals
    }

    fn is_unchanged(&self, earlier: usize, later: usize) -> bool {
        self.changes[earlier][later].is_some_and(|change| change.p_value >= self.chance)
    }

    /// Whether the change of a rotor is another one where it is paired with another.
    fn differs(&self, rotor: usize, other: usize) -> bool {
        let (own, other) = (self.changes[rotor][rotor], self.changes[rotor][other]);
        own.zip(other).is_none_or(|(own, other)| are_different(&own, &other, self.chance))
    }

    /// The later rotor of each earlier one that is unchanged, for as many as possible: the largest matching (Kuhn 1955), with one pair given.
    fn pairing(&self, given: Option<(usize, usize)>) -> Vec<Option<usize>> {
        let count = self.changes.len();
        let mut earlier_of: Vec<Option<usize>> = vec![None; count];
        for earlier in (0..count).filter(|earlier| given.is_none_or(|(taken, _)| taken != *earlier)) {
            let mut tried: Vec<bool> = (0..count).map(|later| given.is_some_and(|(_, taken)| taken == later)).collect();
            self.place(earlier, &mut tried, &mut earlier_of);
        }
        if let Some((earlier, later)) = given {
            earlier_of[later] = Some(earlier);
        }
        let mut later_of = vec![None; count];
        for (later, earlier) in earlier_of.into_iter().enumerate() {
            if let Some(earlier) = earlier {
                later_of[earlier] = Some(later);
            }
        }
        later_of
    }

    /// Finds a place for one more rotor, where others may move to another place.
    fn place(&self, earlier: usize, tried: &mut [bool], earlier_of: &mut [Option<usize>]) -> bool {
        let count = self.changes.len();
        // its own rank first
        for later in std::iter::once(earlier).chain((0..count).filter(|later| *later != earlier)) {
            if tried[later] || !self.is_unchanged(earlier, later) {
                continue;
            }
            tried[later] = true;
            let is_free = earlier_of[later].is_none_or(|other| self.place(other, tried, earlier_of));
            if is_free {
                earlier_of[later] = Some(earlier);
                return true;
            }
        }
        false
    }
}

/// Whether two changes differ by more than the larger of their uncertainties explains.
pub(super) fn are_different(one: &Change, other: &Change, chance: f64) -> bool {
    let wider = if one.std_uncertainty_share >= other.std_uncertainty_share { one } else { other };
    let stds = (one.change_share - other.change_share) / wider.std_uncertainty_share;
    two_sided(stds, wider.degrees_of_freedom) < chance
}

/// A whole pairing: the rotors without a place have the free ones, in the order of their speeds.
fn completed(pairing: &[Option<usize>]) -> Vec<usize> {
    let mut free = (0..pairing.len()).filter(|later| !pairing.contains(&Some(*later)));
    pairing.iter().enumerate().map(|(rotor, later)| later.or_else(|| free.next()).unwrap_or(rotor)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drift::pooled::tested;

    /// Rivals of rotors whose speeds are known to 0.1 %.
    fn rivals(earlier: &[f64], later: &[f64]) -> Vec<Option<usize>> {
        let change = |from: usize, to: usize| Some(tested(later[to - 1] / earlier[from - 1] - 1.0, 1e-3, None));
        Crossed::of(earlier.len(), 0.01, change).rivals()
    }

    #[test]
    fn ranks_that_may_have_crossed_have_rivals() {
        assert_eq!(rivals(&[66.1, 61.3], &[61.3, 57.3]), [Some(2), Some(1)]);
        // the fastest of four falls below all others
        assert_eq!(rivals(&[70.0, 66.0, 62.0, 58.0], &[66.0, 62.0, 58.0, 50.0]), [Some(4), Some(1), Some(2), Some(3)]);
        // two of four cross, the others stay as they are
        assert_eq!(rivals(&[70.0, 66.0, 62.0, 58.0], &[70.0, 62.0, 60.0, 58.0]), [None, Some(3), Some(2), None]);
        // one of two equal rotors slows down: it can be each of them
        assert_eq!(rivals(&[66.05, 66.0], &[66.02, 60.0]), [Some(2), Some(1)]);
    }

    #[test]
    fn ranks_that_are_clear_have_no_rivals() {
        let clear: [(&[f64], &[f64]); 6] = [
            (&[66.1, 61.3], &[66.1, 61.3]),
            (&[66.1, 61.3], &[66.1, 57.3]),
            (&[66.1, 61.3], &[67.0, 62.0]),
            // too near to each other to matter
            (&[61.31, 61.3], &[61.32, 61.29]),
            // all change alike, by less than their distance
            (&[70.0, 66.0, 62.0, 58.0], &[68.6, 64.7, 60.8, 56.8]),
            (&[], &[]),
        ];
        for (earlier, later) in clear {
            assert!(rivals(earlier, later).iter().all(Option::is_none), "{earlier:?} {later:?}");
        }
    }

    #[test]
    fn a_rotor_without_an_uncertainty_does_not_hide_that_ranks_may_have_crossed() {
        let (earlier, later) = ([66.1, 61.3], [61.3, 57.3]);
        let change =
            |from: usize, to: usize| (from == 2).then(|| tested(later[to - 1] / earlier[from - 1] - 1.0, 1e-3, None));
        assert_eq!(Crossed::of(2, 0.01, change).rivals(), [Some(2), Some(1)]);
    }
}
