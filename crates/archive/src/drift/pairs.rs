//! Recordings of the same name in both archives, and the change of each.

use super::tail::two_sided;
use super::{Archives, Change, RecordingChange};
use crate::summary::{RotorSummary, Summary};
use std::collections::BTreeMap;

/// A recording in both archives, with a speed in each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair<'a> {
    pub(super) earlier: &'a Summary,
    pub(super) later: &'a Summary,
}

/// A speed in both archives, whose uncertainties are known.
#[derive(Clone, Copy, Debug)]
pub(super) struct PairOfSpeeds {
    pub(super) earlier_rev_s: f64,
    pub(super) later_rev_s: f64,
    /// Standard uncertainty of the change as a share.
    pub(super) std_share: f64,
    /// The part of it that all recordings of the two archives share.
    pub(super) clock_std_share: f64,
}

impl PairOfSpeeds {
    pub(super) fn change_share(self) -> f64 {
        self.later_rev_s / self.earlier_rev_s - 1.0
    }
}

/// The speed of a rotor, or of all with 0.
pub(super) fn speed_of(summary: &Summary, rotor: usize) -> Option<RotorSummary> {
    match rotor.checked_sub(1) {
        None => summary.speed,
        Some(index) => summary.rotors.get(index).copied(),
    }
}

impl Pair<'_> {
    /// Rotors are compared where both recordings separate as many.
    fn rotors(&self) -> std::ops::RangeInclusive<usize> {
        let count = self.earlier.rotors.len();
        0..=if count == self.later.rotors.len() { count } else { 0 }
    }

    pub(super) fn speeds(&self, rotor: usize) -> Option<PairOfSpeeds> {
        if !self.rotors().contains(&rotor) {
            return None;
        }
        let (earlier, later) = (speed_of(self.earlier, rotor)?, speed_of(self.later, rotor)?);
        let shares = |std_of_earlier: f64, std_of_later: f64| {
            (std_of_earlier / earlier.speed_rev_s).hypot(std_of_later / later.speed_rev_s)
        };
        Some(PairOfSpeeds {
            earlier_rev_s: earlier.speed_rev_s,
            later_rev_s: later.speed_rev_s,
            std_share: shares(earlier.std_rev_s?, later.std_rev_s?),
            clock_std_share: clock_std_share(self.earlier).hypot(clock_std_share(self.later)),
        })
    }
}

/// The uncertainty of the clock as a share of the speed.
pub(super) fn clock_std_share(summary: &Summary) -> f64 {
    summary.speed.map_or(0.0, |speed| summary.clock_std_rev_s / speed.speed_rev_s)
}

/// The pairs in the order of their names.
pub(super) fn pairs_of(archives: Archives<'_>) -> Vec<Pair<'_>> {
    let later: BTreeMap<&str, &Summary> =
        archives.later.iter().map(|summary| (summary.file.as_str(), summary)).collect();
    let pair = |earlier: &'_ Summary| later.get(earlier.file.as_str()).copied();
    let pairs = archives.earlier.iter().filter_map(|earlier| Some(Pair { earlier, later: pair(earlier)? }));
    pairs.filter(|pair| pair.earlier.speed.is_some() && pair.later.speed.is_some()).collect()
}

/// The change of every speed of every pair, tested by the reported uncertainties.
pub(super) fn changes_of_pairs(pairs: &[Pair<'_>]) -> Vec<RecordingChange> {
    let changes_of = |pair: &Pair<'_>| {
        let of_rotor = |rotor: usize| {
            let speeds = pair.speeds(rotor)?;
            Some(RecordingChange {
                file: pair.earlier.file.clone(),
                rotor,
                earlier_rev_s: speeds.earlier_rev_s,
                later_rev_s: speeds.later_rev_s,
                change: Change {
                    change_share: speeds.change_share(),
                    std_uncertainty_share: speeds.std_share,
                    degrees_of_freedom: None,
                    p_value: two_sided(speeds.change_share() / speeds.std_share, None),
                    p_value_holm: 1.0,
                    has_changed: false,
                },
            })
        };
        pair.rotors().filter_map(of_rotor).collect::<Vec<_>>()
    };
    pairs.iter().flat_map(changes_of).collect()
}
