//! Two archives of the same rotors → which speeds have changed, with tests and their uncertainties.

mod holm;
mod pairs;
mod pooled;
mod tail;
mod text;

pub use text::{drift_json, drift_text};

use crate::summary::Summary;
use pairs::{changes_of_pairs, pairs_of};
use pooled::{change_of_groups, change_of_pairs};
use serde::Serialize;
use std::collections::BTreeSet;

/// Chance of at least one false "has changed" among all tests of one kind. *Decision.*
pub const FALSE_ALARM_CHANCE: f64 = 0.05;

/// Two archives.
#[derive(Clone, Copy, Debug)]
pub struct Archives<'a> {
    /// The earlier one, with names of its recordings below the folder that was heard.
    pub earlier: &'a [Summary],
    /// The later one.
    pub later: &'a [Summary],
}

/// A change of one speed between two recordings of the same name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RecordingChange {
    /// Name of the recording in both archives.
    pub file: String,
    /// Number of the rotor, fastest first; 0 for the mean of all.
    pub rotor: usize,
    /// Shaft speed in the earlier archive.
    pub earlier_rev_s: f64,
    /// Shaft speed in the later archive.
    pub later_rev_s: f64,
    /// The change and its test.
    #[serde(flatten)]
    pub change: Change,
}

/// A change over all recordings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotorChange {
    /// Number of the rotor, fastest first; 0 for the mean of all.
    pub rotor: usize,
    /// Recordings of the earlier archive with this rotor.
    pub earlier_count: usize,
    /// Recordings of the later archive with this rotor.
    pub later_count: usize,
    /// The change and its test.
    #[serde(flatten)]
    pub change: Change,
}

/// A change of a speed as a share of the speed, with its test against no change.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Change {
    /// Later over earlier speed, less 1.
    pub change_share: f64,
    /// Its standard uncertainty.
    pub std_uncertainty_share: f64,
    /// Degrees of freedom of that uncertainty; absent where it does not come from a scatter.
    pub degrees_of_freedom: Option<f64>,
    /// Chance of a change as large as this where there is none.
    pub p_value: f64,
    /// The same where all tests of this kind together may be wrong once: Holm (1979).
    pub p_value_holm: f64,
    /// Whether it has changed.
    pub has_changed: bool,
}

/// What has changed between two archives.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Drift {
    /// Whether recordings of the same name were compared; else the archives as wholes.
    pub is_paired: bool,
    /// Each rotor over all recordings.
    pub rotors: Vec<RotorChange>,
    /// Each recording of the same name.
    pub recordings: Vec<RecordingChange>,
    /// Recordings of the earlier archive that have no speed, or no recording of the same name with one.
    pub earlier_unused: usize,
    /// The same of the later archive.
    pub later_unused: usize,
}

/// The changes from the earlier archive to the later one.
///
/// Recordings of the same name are compared one by one, and each rotor by the weighted mean of its changes (DerSimonian & Laird 1986, with the
/// correction of Knapp & Hartung 2003). Where no name is in both, the means of all recordings are compared by the test of Welch (1947).
pub fn drift_of(archives: Archives<'_>) -> Drift {
    let pairs = pairs_of(archives);
    let is_paired = !pairs.is_empty();
    let mut recordings = changes_of_pairs(&pairs);
    let rotors: BTreeSet<usize> = match is_paired {
        true => recordings.iter().map(|change| change.rotor).collect(),
        false => (0..=most_rotors(archives)).collect(),
    };
    let of_rotor = |rotor| match is_paired {
        true => change_of_pairs(&pairs, rotor),
        false => change_of_groups(archives, rotor),
    };
    let mut rotors: Vec<RotorChange> = rotors.into_iter().filter_map(of_rotor).collect();
    holm::adjust(recordings.iter_mut().map(|row| &mut row.change).collect());
    holm::adjust(rotors.iter_mut().map(|row| &mut row.change).collect());
    let used = |all: &[Summary]| match is_paired {
        true => pairs.len(),
        false => all.iter().filter(|summary| summary.speed.is_some()).count(),
    };
    Drift {
        is_paired,
        earlier_unused: archives.earlier.len() - used(archives.earlier),
        later_unused: archives.later.len() - used(archives.later),
        rotors,
        recordings,
    }
}

/// The largest number of rotors that are separated in both archives.
fn most_rotors(archives: Archives<'_>) -> usize {
    let most = |all: &[Summary]| all.iter().map(|summary| summary.rotors.len()).max().unwrap_or(0);
    most(archives.earlier).min(most(archives.later))
}
