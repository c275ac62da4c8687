//! The numbers of the rotors: of their labels where all have one, else by speed.

use super::Archives;
use crate::summary::{RotorSummary, Summary};

/// How rotors are numbered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Numbering {
    /// The fastest is rotor 1.
    BySpeed,
    /// The number of the label.
    ByLabel,
}

impl Numbering {
    /// By label where every separated rotor of both archives has one.
    pub(super) fn of(archives: Archives<'_>) -> Self {
        let all = || archives.earlier.iter().chain(archives.later);
        let has_rotors = all().any(|summary| !summary.rotors.is_empty());
        if has_rotors && all().all(has_labels) { Self::ByLabel } else { Self::BySpeed }
    }

    /// The speed of a rotor, or of all with 0.
    pub(super) fn speed_of(self, summary: &Summary, rotor: usize) -> Option<RotorSummary> {
        let Some(index) = rotor.checked_sub(1) else { return summary.speed };
        match self {
            Self::BySpeed => summary.rotors.get(index).copied(),
            Self::ByLabel => summary.rotors.iter().find(|one| one.label_number == Some(rotor)).copied(),
        }
    }

    /// The largest number of a rotor in a recording.
    pub(super) fn last_of(self, summary: &Summary) -> usize {
        match self {
            Self::BySpeed => summary.rotors.len(),
            Self::ByLabel => summary.rotors.iter().filter_map(|rotor| rotor.label_number).max().unwrap_or(0),
        }
    }

    /// The largest number of a rotor that is in both archives.
    pub(super) fn most_rotors(self, archives: Archives<'_>) -> usize {
        let most = |all: &[Summary]| all.iter().map(|summary| self.last_of(summary)).max().unwrap_or(0);
        most(archives.earlier).min(most(archives.later))
    }
}

/// Whether all rotors have a label, and no two the same.
fn has_labels(summary: &Summary) -> bool {
    let mut numbers: Vec<Option<usize>> = summary.rotors.iter().map(|rotor| rotor.label_number).collect();
    numbers.sort_unstable();
    numbers.iter().all(Option::is_some) && numbers.windows(2).all(|two| two[0] != two[1])
}
