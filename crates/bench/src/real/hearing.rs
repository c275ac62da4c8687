//! Every case through the program, judged.

use super::answer::{Answer, Status};
use super::cases::{Case, Mode, TruthSet};
use super::judgement::{Expected, Verdict};
use super::program::Program;
use super::progress::Progress;
use super::rotors_told::{ExactRotors, RotorCount};
use super::rows::{Belief, Row};
use super::truth_track::TruthTrack;
use crate::accuracy::drawn;
use hovertone::sound::SignalSource;
use hovertone_media::{OpenOptions, Recording};
use std::path::Path;

/// Belief in a speed that was told without a choice among readings.
const BELIEF_OF_A_SPEED: f64 = 0.99;

/// Runs all cases of a set on all cores, in their order.
pub(super) fn heard(set: &TruthSet, program: &Program) -> Result<Vec<Row>, String> {
    let cases = set.cases();
    let progress = Progress::new(&format!("{} recordings", set.name), cases.len());
    drawn(cases.len(), |number| {
        let row = row_of(set, &cases[number], program)?;
        progress.step();
        Ok(row)
    })
}

fn row_of(set: &TruthSet, case: &Case<'_>, program: &Program) -> Result<Row, String> {
    let Case { truth, flags } = *case;
    let path = set.path(&truth.file);
    let answer = program.speed(flags, &path)?;
    let track = truth.truth_csv.as_ref().map(|file| TruthTrack::read(&set.path(file))).transpose()?;
    let expected = Expected::of(truth, flags, &answer, track.as_ref());
    let verdict = expected.verdict(&answer);
    Ok(Row {
        set: set.name.to_owned(),
        class: truth.class.clone(),
        mode: Mode::of(flags).name(),
        is_low_confidence: truth.is_low_confidence(),
        is_negative: expected.is_negative,
        file: truth.file.clone(),
        flags: flags.join(" "),
        verdict,
        status: answer.status,
        speed_rev_s: answer.speed_rev_s,
        combined_std_uncertainty_rev_s: answer.combined_std_uncertainty_rev_s,
        accepted_rev_s: expected.accepted,
        note: expected.note(&answer),
        reason: answer.reason.clone(),
        heard_s: if expected.is_negative { duration_s(&path) } else { None },
        beliefs: beliefs(&expected, &answer, verdict),
        rotor_count: RotorCount::of(truth, &expected, &answer),
        exact_rotors: ExactRotors::of(&expected, &answer),
    })
}

/// Beliefs in the told speed, or in each reading.
fn beliefs(expected: &Expected<'_>, answer: &Answer, verdict: Verdict) -> Vec<Belief> {
    match answer.status {
        Status::Ok => {
            let belief = answer.found.as_ref().map_or(BELIEF_OF_A_SPEED, |reading| reading.plausibility);
            vec![Belief { belief, is_right: matches!(verdict, Verdict::Right | Verdict::MeanOff) }]
        }
        Status::Ambiguous => {
            let readings = answer.alternatives.iter();
            let belief = readings.map(|reading| Belief {
                belief: reading.plausibility,
                is_right: expected.is_of_a_rotor(reading.speed_rev_s, 0.0),
            });
            belief.collect()
        }
        _ => Vec::new(),
    }
}

/// Length of the sound of a file; `None` where it cannot be read.
pub(super) fn duration_s(path: &Path) -> Option<f64> {
    let mut recording = Recording::open(path, &OpenOptions::default()).ok()?;
    let mut samples = 0usize;
    while let Some(block) = recording.next_block().ok()? {
        samples += block.len();
    }
    Some(samples as f64 / recording.sample_rate_hz())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::answer::ToldReading;
    use crate::real::cases::{SpeedRange, Truth};

    #[test]
    fn a_belief_is_that_of_the_reading_or_of_a_speed_without_choice() {
        let truth = Truth { accept_rev_s: Some(SpeedRange { low: 80.0, high: 82.0 }), ..Truth::default() };
        let reading = |speed_rev_s, plausibility| ToldReading { speed_rev_s, plausibility };
        let of = |answer: &Answer| {
            let expected = Expected::of(&truth, &[], answer, None);
            beliefs(&expected, answer, expected.verdict(answer))
        };
        let told = Answer {
            status: Status::Ok,
            speed_rev_s: Some(81.0),
            combined_std_uncertainty_rev_s: Some(0.1),
            ..Answer::default()
        };
        assert_eq!(of(&told), [Belief { belief: BELIEF_OF_A_SPEED, is_right: true }]);
        let found = Answer { speed_rev_s: Some(40.0), found: Some(reading(40.0, 0.93)), ..told };
        assert_eq!(of(&found), [Belief { belief: 0.93, is_right: false }]);
        let alternatives = vec![reading(162.0, 0.6), reading(81.0, 0.4)];
        let open = Answer { status: Status::Ambiguous, alternatives, ..Answer::default() };
        let expected = [Belief { belief: 0.6, is_right: false }, Belief { belief: 0.4, is_right: true }];
        assert_eq!(of(&open), expected);
        assert!(of(&Answer { status: Status::NoRotorTone, ..Answer::default() }).is_empty());
    }
}
