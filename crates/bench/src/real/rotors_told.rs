//! The separated rotors of an answer against the truth, and four rotors against their exact truth.

use super::answer::{Answer, Status, ToldRotor};
use super::cases::Truth;
use super::judgement::Expected;
use serde::{Deserialize, Serialize};

/// Largest error of a mean, a mean square or a rotor that counts as told.
const TOLD_SHARE: f64 = 0.003;
/// Rotors whose means are at least so far apart, as a share, can be told apart: those of the clips that are said to be 1 % apart are.
const APART_SHARE: f64 = 0.009;
/// A rotor this share outside the range of all is none of them.
const OUTSIDE_SHARE: f64 = 0.02;
/// Tolerance of a rotor where the truth states none.
const TOLERANCE_REV_S: f64 = 1.0;

/// Several rotors whose truth is known at every instant.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub(super) struct ExactRotors {
    pub(super) is_mean_told: bool,
    pub(super) is_mean_square_told: bool,
    /// Is the mean within twice its uncertainty?
    pub(super) is_within_2u: bool,
    /// Is each rotor told, and no other?
    pub(super) is_each_told: bool,
    /// Are more rotors told than turn?
    pub(super) are_too_many: bool,
    /// Are the means of no two rotors close to each other?
    pub(super) are_apart: bool,
    /// Of the rotors that are told, where all are: those within twice their uncertainty.
    pub(super) rotors_within_2u: usize,
    pub(super) rotors_told: usize,
}

/// The separated rotors of one answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
pub(super) struct RotorCount {
    /// Within the tolerance of a true rotor.
    pub(super) good: usize,
    pub(super) told: usize,
    /// Outside the range of all rotors.
    pub(super) outside: usize,
}

impl ExactRotors {
    /// `None` without an answer, or without the exact truth of several rotors.
    pub(super) fn of(expected: &Expected<'_>, answer: &Answer) -> Option<Self> {
        let exact = expected.exact.as_ref().filter(|exact| exact.means_rev_s.len() > 1)?;
        let speed_rev_s = answer.speed_rev_s.filter(|_| answer.status == Status::Ok)?;
        let is_told = |told: f64, truth: f64| (told / truth - 1.0).abs() < TOLD_SHARE;
        let square = answer.mean_square_rad2_s2.unwrap_or((std::f64::consts::TAU * speed_rev_s).powi(2));
        let std_rev_s = answer.combined_std_uncertainty_rev_s.unwrap_or(0.0);
        let mut told = answer.rotors.clone();
        let mut truth = exact.means_rev_s.clone();
        told.sort_by(|a, b| a.speed_rev_s.total_cmp(&b.speed_rev_s));
        truth.sort_by(f64::total_cmp);
        let are_all = told.len() == truth.len();
        let pairs = || told.iter().zip(&truth).filter(|_| are_all);
        let is_within = |(rotor, truth): &(&ToldRotor, &f64)| {
            (rotor.speed_rev_s - **truth).abs() <= 2.0 * rotor.combined_std_uncertainty_rev_s.unwrap_or(0.0)
        };
        Some(Self {
            is_mean_told: is_told(speed_rev_s, exact.mean_rev_s()),
            is_mean_square_told: is_told(square, exact.mean_square_rad2_s2),
            is_within_2u: (speed_rev_s - exact.mean_rev_s()).abs() <= 2.0 * std_rev_s,
            is_each_told: are_all && pairs().all(|(rotor, truth)| is_told(rotor.speed_rev_s, *truth)),
            are_too_many: told.len() > truth.len(),
            are_apart: truth.windows(2).all(|pair| pair[1] / pair[0] - 1.0 >= APART_SHARE),
            rotors_within_2u: pairs().filter(is_within).count(),
            rotors_told: pairs().count(),
        })
    }
}

impl RotorCount {
    /// `None` where no rotor was separated, or the speeds of the rotors are unknown.
    pub(super) fn of(truth: &Truth, expected: &Expected<'_>, answer: &Answer) -> Option<Self> {
        let (speeds, rotors) = (&expected.speeds_rev_s, &answer.rotors);
        if speeds.is_empty() || rotors.is_empty() {
            return None;
        }
        let tolerance_rev_s = truth.tolerance_rev_s.filter(|tolerance| *tolerance > 0.0).unwrap_or(TOLERANCE_REV_S);
        let slowest = speeds.iter().copied().fold(f64::INFINITY, f64::min) * (1.0 - OUTSIDE_SHARE);
        let fastest = speeds.iter().copied().fold(f64::NEG_INFINITY, f64::max) * (1.0 + OUTSIDE_SHARE);
        let is_good = |told: f64| speeds.iter().any(|speed| (told - speed).abs() <= tolerance_rev_s);
        Some(Self {
            good: rotors.iter().filter(|rotor| is_good(rotor.speed_rev_s)).count(),
            told: rotors.len(),
            outside: rotors.iter().filter(|rotor| !(slowest..=fastest).contains(&rotor.speed_rev_s)).count(),
        })
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self { good: self.good + other.good, told: self.told + other.told, outside: self.outside + other.outside }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::truth_track::TruthTrack;

    fn answer(speed_rev_s: f64, rotors: &[f64]) -> Answer {
        Answer {
            status: Status::Ok,
            speed_rev_s: Some(speed_rev_s),
            combined_std_uncertainty_rev_s: Some(0.05),
            rotors: rotors
                .iter()
                .map(|&speed_rev_s| ToldRotor { speed_rev_s, combined_std_uncertainty_rev_s: Some(0.08) })
                .collect(),
            ..Answer::default()
        }
    }

    #[test]
    fn rotors_are_held_to_their_exact_truth() {
        let truth = Truth { truth_csv: Some(String::new()), tolerance_rev_s: Some(0.3), ..Truth::default() };
        let track = TruthTrack::of_text("time_s,a,b\n0,90,110\n1,90,110\n");
        let of = |answer: &Answer| {
            let flags = vec!["--rotors".to_owned(), "2".to_owned()];
            let expected = Expected::of(&truth, &flags, answer, Some(&track));
            (ExactRotors::of(&expected, answer).unwrap(), RotorCount::of(&truth, &expected, answer))
        };
        let (exact, count) = of(&answer(100.02, &[110.1, 90.1]));
        assert!(exact.is_mean_told && exact.is_within_2u && exact.is_each_told && !exact.are_too_many);
        assert_eq!((exact.are_apart, exact.rotors_within_2u, exact.rotors_told), (true, 2, 2));
        // ⟨n⟩² is 1 % less than ⟨n²⟩ here
        assert!(!exact.is_mean_square_told);
        assert_eq!(count, Some(RotorCount { good: 2, told: 2, outside: 0 }));
        let square = std::f64::consts::TAU.powi(2) * (8100.0 + 12_100.0) / 2.0;
        let (exact, count) = of(&Answer { mean_square_rad2_s2: Some(square), ..answer(100.2, &[110.1, 92.0, 130.0]) });
        assert!(exact.is_mean_square_told && exact.is_mean_told && !exact.is_within_2u && !exact.is_each_told);
        assert!(exact.are_too_many);
        assert_eq!(count, Some(RotorCount { good: 1, told: 3, outside: 1 }));
        assert_eq!(of(&answer(100.0, &[])).1, None);
    }

    #[test]
    fn one_rotor_or_no_table_has_no_such_truth() {
        let truth = Truth { speeds_rev_s: vec![90.0], ..Truth::default() };
        let answer = answer(90.0, &[90.5]);
        let expected = Expected::of(&truth, &[], &answer, None);
        assert_eq!(ExactRotors::of(&expected, &answer), None);
        assert_eq!(RotorCount::of(&truth, &expected, &answer).map(|count| count.good), Some(1), "within 1 rev/s");
    }
}
