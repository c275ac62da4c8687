//! Recordings of the same name in both archives, and the change of each.

use super::numbering::Numbering;
use super::pooled::tested;
use super::{Archives, Change, RecordingChange};
use crate::summary::Summary;
use std::collections::BTreeMap;

/// A recording in both archives, with a speed in each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair<'a> {
    pub(super) earlier: &'a Summary,
    pub(super) later: &'a Summary,
    pub(super) numbering: Numbering,
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

    /// The change, tested by the reported uncertainties.
    pub(super) fn change(self) -> Change {
        tested(self.change_share(), self.std_share, None)
    }
}

impl Pair<'_> {
    /// The largest number of a rotor. Without labels, rotors are compared where both recordings separate as many.
    pub(super) fn rotor_count(&self) -> usize {
        let (earlier, later) = (self.numbering.last_of(self.earlier), self.numbering.last_of(self.later));
        match self.numbering {
            Numbering::BySpeed if earlier != later => 0,
            _ => earlier.min(later),
        }
    }

    /// The speeds of an earlier and a later rotor, or of all with 0.
    pub(super) fn speeds(&self, earlier: usize, later: usize) -> Option<PairOfSpeeds> {
        if earlier.max(later) > self.rotor_count() {
            return None;
        }
        let earlier = self.numbering.speed_of(self.earlier, earlier)?;
        let later = self.numbering.speed_of(self.later, later)?;
        let ratio = later.speed_rev_s / earlier.speed_rev_s;
        let shares = |std_of_earlier: f64, std_of_later: f64| {
            ratio * (std_of_earlier / earlier.speed_rev_s).hypot(std_of_later / later.speed_rev_s)
        };
        Some(PairOfSpeeds {
            earlier_rev_s: earlier.speed_rev_s,
            later_rev_s: later.speed_rev_s,
            std_share: shares(earlier.std_rev_s?, later.std_rev_s?),
            clock_std_share: ratio * clock_std_share(self.earlier).hypot(clock_std_share(self.later)),
        })
    }
}

/// The uncertainty of the clock as a share of the speed.
pub(super) fn clock_std_share(summary: &Summary) -> f64 {
    summary.speed.map_or(0.0, |speed| summary.clock_std_rev_s / speed.speed_rev_s)
}

/// The pairs in the order of their names.
pub(super) fn pairs_of(archives: Archives<'_>, numbering: Numbering) -> Vec<Pair<'_>> {
    let later: BTreeMap<&str, &Summary> =
        archives.later.iter().map(|summary| (summary.file.as_str(), summary)).collect();
    let pair = |earlier: &'_ Summary| later.get(earlier.file.as_str()).copied();
    let pairs = archives.earlier.iter().filter_map(|earlier| Some(Pair { earlier, later: pair(earlier)?, numbering }));
    pairs.filter(|pair| pair.earlier.speed.is_some() && pair.later.speed.is_some()).collect()
}

/// For each pair, the change of every speed, tested by the reported uncertainties.
pub(super) fn changes_of_pairs(pairs: &[Pair<'_>]) -> Vec<Vec<RecordingChange>> {
    let changes_of = |pair: &Pair<'_>| {
        let of_rotor = |rotor: usize| {
            let speeds = pair.speeds(rotor, rotor)?;
            Some(RecordingChange {
                file: pair.earlier.file.clone(),
                rotor,
                earlier_rev_s: speeds.earlier_rev_s,
                later_rev_s: speeds.later_rev_s,
                change: speeds.change(),
            })
        };
        (0..=pair.rotor_count()).filter_map(of_rotor).collect::<Vec<_>>()
    };
    pairs.iter().map(changes_of).collect()
}
