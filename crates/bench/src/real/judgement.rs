//! The judgement of one answer, as `../shared/data/real/score.py` judges it.

use super::answer::{Answer, Status};
use super::cases::{Mode, SpeedRange, Truth};
use super::truth_track::{TrueSpeeds, TruthTrack};
use serde::{Deserialize, Serialize};

/// An answer is an octave off if this many times its speed would be right.
const OCTAVES: [f64; 8] = [2.0, 0.5, 3.0, 1.0 / 3.0, 1.5, 2.0 / 3.0, 4.0, 0.25];
/// Of the speed: a wide uncertainty does not widen the accepted range further.
const STD_SHARE_MAX: f64 = 0.001;
/// One ridge of several rotors may lie anywhere between the slowest and the fastest, and this share beyond.
const RIDGE_MARGIN_SHARE: f64 = 0.003;

/// How an answer is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Verdict {
    /// The mean lies in the accepted range; for negatives, no speed was told.
    Right,
    /// Any other speed.
    Wrong,
    /// Wrong, but twice, half, three times, … of it would be right.
    Octave,
    /// Ambiguous, with the truth first among the readings.
    First,
    /// Ambiguous, with the truth among the other readings.
    Listed,
    /// No speed where a rotor sounds.
    Silent,
    /// Ambiguous, without the truth among the readings.
    Missing,
    /// Between the slowest and the fastest rotor, but not their mean, where the mean was asked for.
    MeanOff,
}

impl Verdict {
    pub(super) const ALL: [Self; 8] =
        [Self::Right, Self::Wrong, Self::Octave, Self::First, Self::Listed, Self::Silent, Self::Missing, Self::MeanOff];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Wrong => "wrong",
            Self::Octave => "octave",
            Self::First => "first",
            Self::Listed => "listed",
            Self::Silent => "silent",
            Self::Missing => "missing",
            Self::MeanOff => "mean off",
        }
    }
}

/// What a right answer would be.
pub(super) struct Expected<'a> {
    pub(super) accepted: Option<SpeedRange>,
    /// The range of any one rotor, where it is wider.
    any_rotor: Option<SpeedRange>,
    also: &'a [SpeedRange],
    /// True speeds of the rotors, where they are known.
    pub(super) speeds_rev_s: Vec<f64>,
    /// Is there no rotor whose speed is known?
    pub(super) is_negative: bool,
    declining_is_right: bool,
    /// The exact truth over the analysed stretch.
    pub(super) exact: Option<TrueSpeeds>,
}

impl<'a> Expected<'a> {
    /// The truth for these flags; with a table of speeds, over the stretch of the answer.
    pub(super) fn of(truth: &'a Truth, flags: &[String], answer: &Answer, track: Option<&TruthTrack>) -> Self {
        let mode = Mode::of(flags);
        let is_mean_asked = flags.iter().any(|flag| flag == "--rotors");
        let any_rotor = if mode.is_spanned { truth.accept_rev_s } else { truth.whole_range() };
        let is_same_stretch =
            mode.is_spanned || truth.accept_whole_rev_s.is_none_or(|whole| Some(whole) == truth.accept_rev_s);
        let mean = truth.accept_rotors_rev_s.filter(|_| is_mean_asked && truth.truth_csv.is_none() && is_same_stretch);
        let mut expected = Self {
            accepted: mean.or(any_rotor),
            any_rotor,
            also: &truth.also_accept_rev_s,
            speeds_rev_s: truth.speeds_rev_s.clone(),
            is_negative: truth.kind == "negative" || any_rotor.is_none(),
            declining_is_right: truth.declining_is_right,
            exact: None,
        };
        if let Some(track) = track.filter(|_| answer.status == Status::Ok) {
            let speeds = track.over(answer.from_s.unwrap_or(0.0), answer.to_s.unwrap_or(f64::INFINITY));
            let (mean_rev_s, tolerance_rev_s) = (speeds.mean_rev_s(), truth.mean_tolerance_rev_s.unwrap_or(0.0));
            expected.accepted = Some(if is_mean_asked || speeds.means_rev_s.len() == 1 {
                SpeedRange { low: mean_rev_s - tolerance_rev_s, high: mean_rev_s + tolerance_rev_s }
            } else {
                SpeedRange {
                    low: speeds.slowest_rev_s * (1.0 - RIDGE_MARGIN_SHARE),
                    high: speeds.fastest_rev_s * (1.0 + RIDGE_MARGIN_SHARE),
                }
            });
            expected.speeds_rev_s.clone_from(&speeds.means_rev_s);
            expected.exact = Some(speeds);
        }
        expected
    }

    /// Would a speed with this uncertainty be right?
    pub(super) fn is_right(&self, speed_rev_s: f64, std_rev_s: f64) -> bool {
        self.accepted.iter().chain(self.also).any(|range| range.holds(speed_rev_s, std_rev_s))
    }

    /// Is it the speed of a rotor, if not of their mean?
    pub(super) fn is_of_a_rotor(&self, speed_rev_s: f64, std_rev_s: f64) -> bool {
        self.is_right(speed_rev_s, std_rev_s) || self.any_rotor.is_some_and(|range| range.holds(speed_rev_s, std_rev_s))
    }

    pub(super) fn verdict(&self, answer: &Answer) -> Verdict {
        let silent = if self.is_negative { Verdict::Right } else { Verdict::Silent };
        match answer.status {
            Status::Ok => self.verdict_of_speed(answer),
            Status::Error | Status::Timeout if self.is_negative => Verdict::Wrong,
            Status::Ambiguous if self.accepted.is_some() => {
                let place = answer.alternatives.iter().position(|reading| self.is_right(reading.speed_rev_s, 0.0));
                match place {
                    Some(0) => Verdict::First,
                    Some(_) => Verdict::Listed,
                    None => Verdict::Missing,
                }
            }
            Status::NoRotorTone if self.declining_is_right => Verdict::Right,
            _ => silent,
        }
    }

    fn verdict_of_speed(&self, answer: &Answer) -> Verdict {
        // an answer without its uncertainty is no answer
        let (Some(speed_rev_s), Some(std_rev_s)) = (answer.speed_rev_s, answer.combined_std_uncertainty_rev_s) else {
            return Verdict::Wrong;
        };
        let std_rev_s = std_rev_s.min(STD_SHARE_MAX * speed_rev_s);
        let is_right_times = |factor: &f64| self.is_right(speed_rev_s * factor, std_rev_s * factor);
        if self.is_right(speed_rev_s, std_rev_s) {
            Verdict::Right
        } else if self.accepted.is_some() && OCTAVES.iter().any(is_right_times) {
            Verdict::Octave
        } else if self.is_of_a_rotor(speed_rev_s, std_rev_s) {
            Verdict::MeanOff
        } else {
            Verdict::Wrong
        }
    }

    /// The place of the truth among the readings of an ambiguous answer.
    pub(super) fn note(&self, answer: &Answer) -> String {
        if answer.status != Status::Ambiguous || self.accepted.is_none() {
            return String::new();
        }
        let place = answer.alternatives.iter().position(|reading| self.is_right(reading.speed_rev_s, 0.0));
        let place = place.map_or_else(|| "none".to_owned(), |place| (place + 1).to_string());
        format!("truth is reading {place} of {}", answer.alternatives.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::answer::{ToldReading, ToldRotor};

    const TABLE: &str = "time_s,a,b\n0,90,110\n1,92,112\n2,94,114\n";

    fn range(low: f64, high: f64) -> Option<SpeedRange> {
        Some(SpeedRange { low, high })
    }

    fn flags(text: &str) -> Vec<String> {
        text.split_whitespace().map(str::to_owned).collect()
    }

    fn told(speed_rev_s: f64, std_rev_s: f64) -> Answer {
        Answer {
            status: Status::Ok,
            speed_rev_s: Some(speed_rev_s),
            combined_std_uncertainty_rev_s: Some(std_rev_s),
            ..Answer::default()
        }
    }

    fn ambiguous(speeds_rev_s: &[f64]) -> Answer {
        let reading = |&speed_rev_s: &f64| ToldReading { speed_rev_s, plausibility: 0.4 };
        let alternatives = speeds_rev_s.iter().map(reading).collect();
        Answer { status: Status::Ambiguous, alternatives, ..Answer::default() }
    }

    fn silent() -> Answer {
        Answer { status: Status::NoRotorTone, ..Answer::default() }
    }

    fn verdict(truth: &Truth, words: &str, answer: &Answer) -> Verdict {
        Expected::of(truth, &flags(words), answer, None).verdict(answer)
    }

    #[test]
    fn a_speed_is_right_within_its_range_and_three_uncertainties_but_not_more() {
        let truth = Truth { accept_rev_s: range(80.0, 90.0), ..Truth::default() };
        let of = |speed, std| verdict(&truth, "--blades 2", &told(speed, std));
        assert_eq!(of(85.0, 0.0), Verdict::Right);
        assert_eq!((of(90.2, 0.07), of(90.2, 0.06)), (Verdict::Right, Verdict::Wrong));
        assert_eq!(of(91.0, 5.0), Verdict::Wrong, "at most 0.1 % of the speed");
        let without_uncertainty = Answer { combined_std_uncertainty_rev_s: None, ..told(85.0, 0.0) };
        assert_eq!(verdict(&truth, "--blades 2", &without_uncertainty), Verdict::Wrong);
    }

    #[test]
    fn multiples_are_octaves() {
        let truth = Truth { accept_rev_s: range(80.0, 82.0), ..Truth::default() };
        for speed in [40.5, 162.0, 27.0, 243.0, 54.0, 121.5, 20.25, 324.0] {
            assert_eq!(verdict(&truth, "", &told(speed, 0.0)), Verdict::Octave, "{speed}");
        }
        assert_eq!(verdict(&truth, "", &told(100.0, 0.0)), Verdict::Wrong);
    }

    #[test]
    fn readings_are_first_listed_or_missing() {
        let truth = Truth { accept_rev_s: range(80.0, 82.0), ..Truth::default() };
        assert_eq!(verdict(&truth, "", &ambiguous(&[81.0, 40.5])), Verdict::First);
        assert_eq!(verdict(&truth, "", &ambiguous(&[162.0, 81.0])), Verdict::Listed);
        assert_eq!(verdict(&truth, "", &ambiguous(&[162.0])), Verdict::Missing);
        let expected = Expected::of(&truth, &[], &silent(), None);
        assert_eq!(expected.note(&ambiguous(&[162.0, 81.0])), "truth is reading 2 of 2");
        assert_eq!(expected.note(&ambiguous(&[162.0])), "truth is reading none of 1");
    }

    #[test]
    fn silence_is_right_where_nothing_sounds_or_declining_is_right() {
        let rotor = Truth { accept_rev_s: range(80.0, 82.0), ..Truth::default() };
        let error = Answer::default();
        assert_eq!(verdict(&rotor, "", &silent()), Verdict::Silent);
        assert_eq!(verdict(&rotor, "", &error), Verdict::Silent);
        let shy = Truth { declining_is_right: true, ..rotor };
        assert_eq!((verdict(&shy, "", &silent()), verdict(&shy, "", &error)), (Verdict::Right, Verdict::Silent));
        assert_eq!(verdict(&shy, "", &ambiguous(&[162.0])), Verdict::Missing);
    }

    #[test]
    fn a_speed_of_nothing_is_a_false_alarm_unless_it_is_also_accepted() {
        let also = vec![SpeedRange { low: 70.0, high: 106.0 }];
        let negative = Truth { kind: "negative".to_owned(), also_accept_rev_s: also, ..Truth::default() };
        assert_eq!(verdict(&negative, "", &silent()), Verdict::Right);
        assert_eq!(verdict(&negative, "", &told(80.0, 0.1)), Verdict::Right);
        assert_eq!(verdict(&negative, "", &told(40.0, 0.1)), Verdict::Wrong, "nothing sounds: no octave of it");
        assert_eq!(verdict(&negative, "", &ambiguous(&[40.0])), Verdict::Right);
        assert_eq!(verdict(&negative, "", &Answer::default()), Verdict::Wrong);
        assert_eq!(verdict(&negative, "", &Answer::timeout()), Verdict::Wrong);
        let helicopter = Truth { kind: "multi".to_owned(), ..negative };
        assert!(Expected::of(&helicopter, &[], &silent(), None).is_negative);
    }

    #[test]
    fn the_whole_file_has_its_own_range_and_the_mean_of_the_rotors_another() {
        let truth = Truth {
            accept_rev_s: range(76.0, 89.0),
            accept_whole_rev_s: range(72.0, 102.0),
            accept_rotors_rev_s: range(82.0, 84.0),
            ..Truth::default()
        };
        let (whole, span) = (flags("--blades 2"), flags("--blades 2 --from 3 --to 9"));
        let accepted = |words: &[String]| Expected::of(&truth, words, &silent(), None).accepted;
        assert_eq!((accepted(&whole), accepted(&span)), (range(72.0, 102.0), range(76.0, 89.0)));
        assert_eq!(accepted(&flags("--rotors 4")), range(72.0, 102.0), "the mean is known of the stretch only");
        let spanned = "--rotors 4 --from 3 --to 9";
        assert_eq!(accepted(&flags(spanned)), range(82.0, 84.0));
        assert_eq!(verdict(&truth, spanned, &told(83.0, 0.1)), Verdict::Right);
        assert_eq!(verdict(&truth, spanned, &told(78.0, 0.01)), Verdict::MeanOff);
        assert_eq!(verdict(&truth, spanned, &told(166.0, 0.01)), Verdict::Octave);
        assert_eq!(verdict(&truth, spanned, &told(70.0, 0.01)), Verdict::Wrong);
        let same = Truth { accept_whole_rev_s: range(76.0, 89.0), ..truth };
        assert_eq!(Expected::of(&same, &flags("--rotors 4"), &silent(), None).accepted, range(82.0, 84.0));
    }

    #[test]
    fn a_table_is_judged_over_the_analysed_stretch() {
        let truth = Truth {
            truth_csv: Some("a.csv".to_owned()),
            accept_rev_s: range(89.0, 115.0),
            accept_rotors_rev_s: range(1.0, 2.0),
            mean_tolerance_rev_s: Some(0.5),
            speeds_rev_s: vec![92.0, 112.0],
            ..Truth::default()
        };
        let track = TruthTrack::of_text(TABLE);
        let of = |words: &str, answer: &Answer| {
            let words = flags(words);
            let expected = Expected::of(&truth, &words, answer, Some(&track));
            (expected.verdict(answer), expected.speeds_rev_s)
        };
        let late = |speed| Answer { from_s: Some(1.5), to_s: Some(9.0), ..told(speed, 0.01) };
        assert_eq!(of("--rotors 2", &late(104.0)), (Verdict::Right, vec![94.0, 114.0]));
        assert_eq!(of("--rotors 2", &late(102.0)), (Verdict::MeanOff, vec![94.0, 114.0]));
        assert_eq!(of("--rotors 2", &told(102.0, 0.01)), (Verdict::Right, vec![92.0, 112.0]));
        assert_eq!(of("--blades 2", &late(93.8)).0, Verdict::Right);
        assert_eq!(of("--blades 2", &late(90.0)).0, Verdict::MeanOff, "of another stretch");
        assert_eq!(of("--blades 2", &late(52.0)).0, Verdict::Octave);
        assert_eq!(of("--blades 2", &ambiguous(&[90.0])).0, Verdict::First, "without a stretch, the range of the file");
        assert_eq!(of("--rotors 2", &silent()), (Verdict::Silent, vec![92.0, 112.0]));
    }

    #[test]
    fn one_rotor_with_a_table_is_held_to_its_mean() {
        let truth = Truth {
            accept_rev_s: range(80.0, 100.0),
            mean_tolerance_rev_s: Some(0.1),
            truth_csv: Some("a.csv".to_owned()),
            ..Truth::default()
        };
        let track = TruthTrack::of_text("time_s,a\n0,90\n1,92\n");
        let answer = Answer {
            rotors: vec![ToldRotor { speed_rev_s: 91.0, combined_std_uncertainty_rev_s: None }],
            ..told(91.05, 0.0)
        };
        let words = flags("--blades 2");
        assert_eq!(Expected::of(&truth, &words, &answer, Some(&track)).verdict(&answer), Verdict::Right);
        let off = told(91.4, 0.01);
        assert_eq!(Expected::of(&truth, &words, &off, Some(&track)).verdict(&off), Verdict::MeanOff);
    }
}
