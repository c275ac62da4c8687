//! Two archives of the same rotors → which speeds have changed, with tests and their uncertainties.

mod holm;
mod numbering;
mod pairing;
mod pairs;
mod pooled;
mod tail;
mod text;

pub use text::{drift_json, drift_text};

use crate::summary::Summary;
use numbering::Numbering;
use pairing::{Crossed, are_different};
use pairs::{Pair, changes_of_pairs, pairs_of};
use pooled::{change_of_groups, change_of_pairs, change_of_rivals};
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
    /// Number of the rotor, fastest first or of its label; 0 for the mean of all.
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
    /// Number of the rotor, fastest first or of its label; 0 for the mean of all.
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
    /// Whether it is known that the rotors of this number are the same one. Where not, another pairing of the rotors leaves at least as many of them
    /// unchanged, and the change is the one of the pairing by rank.
    pub is_rotor_known: bool,
    /// Whether it has changed; false where the rotor is not known.
    pub has_changed: bool,
}

/// A recording that is not compared.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Unused {
    /// Its name.
    pub file: String,
    /// Whether it has a speed; then the other archive has no recording of the same name with one.
    pub has_speed: bool,
}

/// What has changed between two archives.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Drift {
    /// Whether recordings of the same name were compared; else the archives as wholes.
    pub is_paired: bool,
    /// Whether rotors have the numbers of their labels; else they are numbered by speed, fastest first.
    pub is_labelled: bool,
    /// Each rotor over all recordings.
    pub rotors: Vec<RotorChange>,
    /// Each recording of the same name.
    pub recordings: Vec<RecordingChange>,
    /// Recordings of the earlier archive without a speed, or without a recording of the same name with one.
    pub earlier_unused: Vec<Unused>,
    /// The same of the later archive.
    pub later_unused: Vec<Unused>,
}

/// The changes from the earlier archive to the later one.
///
/// Recordings of the same name are compared one by one, and each rotor by the weighted mean of its changes (DerSimonian & Laird 1986, with the
/// correction of Knapp & Hartung 2003). Where no name is in both, the means of all recordings are compared by the test of Welch (1947).
///
/// Rotors are paired by the numbers of their labels where all have one, else by their rank in speed. Ranks may cross: where another pairing leaves at
/// least as many rotors unchanged, no change of the rotors in question is claimed, and only the mean of all is tested.
pub fn drift_of(archives: Archives<'_>) -> Drift {
    let numbering = Numbering::of(archives);
    let pairs = pairs_of(archives, numbering);
    let is_paired = !pairs.is_empty();
    let mut recordings = changes_of_pairs(&pairs);
    let numbers: BTreeSet<usize> = match is_paired {
        true => recordings.iter().flatten().map(|change| change.rotor).collect(),
        false => (0..=numbering.most_rotors(archives)).collect(),
    };
    let of_rotors = |earlier, later| match is_paired {
        true => change_of_pairs(&pairs, earlier, later),
        false => change_of_groups(archives, numbering, earlier, later),
    };
    let mut rotors: Vec<RotorChange> = numbers.into_iter().filter_map(|rotor| of_rotors(rotor, rotor)).collect();
    if numbering == Numbering::BySpeed {
        let rivals = mark_recordings(&pairs, &mut recordings);
        mark_rotors(&mut rotors, &pairs, &rivals, of_rotors);
        // flights scatter by more than their reported uncertainties, which all of them together show and a single one does not
        let not_known: BTreeSet<usize> =
            rotors.iter().filter(|row| !row.change.is_rotor_known).map(|row| row.rotor).collect();
        for row in recordings.iter_mut().flatten().filter(|row| not_known.contains(&row.rotor)) {
            row.change.is_rotor_known = false;
        }
    }
    let mut recordings: Vec<RecordingChange> = recordings.into_iter().flatten().collect();
    holm::adjust(recordings.iter_mut().map(|row| &mut row.change).collect());
    holm::adjust(rotors.iter_mut().map(|row| &mut row.change).collect());
    let unused = |all: &[Summary], in_pairs: BTreeSet<&str>| -> Vec<Unused> {
        let is_used = |summary: &&Summary| match is_paired {
            true => in_pairs.contains(summary.file.as_str()),
            false => summary.speed.is_some(),
        };
        let unused = |summary: &Summary| Unused { file: summary.file.clone(), has_speed: summary.speed.is_some() };
        all.iter().filter(|summary| !is_used(summary)).map(unused).collect()
    };
    Drift {
        is_paired,
        is_labelled: numbering == Numbering::ByLabel,
        earlier_unused: unused(archives.earlier, pairs.iter().map(|pair| pair.earlier.file.as_str()).collect()),
        later_unused: unused(archives.later, pairs.iter().map(|pair| pair.later.file.as_str()).collect()),
        rotors,
        recordings,
    }
}

/// Marks the rotors of single recordings that are not known, and returns the rivals of each recording.
fn mark_recordings(pairs: &[Pair<'_>], recordings: &mut [Vec<RecordingChange>]) -> Vec<Vec<Option<usize>>> {
    let chance = FALSE_ALARM_CHANCE / recordings.iter().map(Vec::len).sum::<usize>().max(1) as f64;
    let rivals_of = |pair: &Pair<'_>| {
        let change = |earlier, later| Some(pair.speeds(earlier, later)?.change());
        Crossed::of(pair.rotor_count(), chance, change).rivals()
    };
    let rivals: Vec<Vec<Option<usize>>> = pairs.iter().map(rivals_of).collect();
    for (rows, rivals) in recordings.iter_mut().zip(&rivals) {
        for row in rows.iter_mut().filter(|row| row.rotor > 0) {
            row.change.is_rotor_known = rivals.get(row.rotor - 1).is_none_or(Option::is_none);
        }
    }
    rivals
}

/// Marks the rotors that are not known over all recordings: by their changes over all of them, or by those of single recordings.
fn mark_rotors(
    rotors: &mut [RotorChange],
    pairs: &[Pair<'_>],
    rivals: &[Vec<Option<usize>>],
    of_rotors: impl Fn(usize, usize) -> Option<RotorChange>,
) {
    let count = rotors.iter().map(|row| row.rotor).max().unwrap_or(0);
    let chance = FALSE_ALARM_CHANCE / rotors.len().max(1) as f64;
    let rivals_of_all = Crossed::of(count, chance, |earlier, later| Some(of_rotors(earlier, later)?.change)).rivals();
    for row in rotors.iter_mut().filter(|row| row.rotor > 0) {
        let with_rivals = change_of_rivals(pairs, row.rotor, rivals);
        let is_other = with_rivals.is_some_and(|other| is_other(&row.change, &other, chance));
        row.change.is_rotor_known = rivals_of_all[row.rotor - 1].is_none() && !is_other;
    }
}

/// Whether the rivals of single recordings lead to another verdict, or to another change, over all recordings.
fn is_other(by_rank: &Change, with_rivals: &Change, chance: f64) -> bool {
    (by_rank.p_value < chance) != (with_rivals.p_value < chance) || are_different(by_rank, with_rivals, chance)
}
