//! Two answers about one recording, one with a fact more than the other.

use super::subject::Ways;
use hovertone::vehicle::COVERAGE_FACTOR;

/// An answer further off is wrong.
const WRONG_SHARE: f64 = 0.01;

/// A mean speed against the truth, as shares of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SpeedError {
    pub(super) error_share: f64,
    /// Stated standard uncertainty.
    pub(super) std_share: f64,
}

impl SpeedError {
    fn is_wrong(self) -> bool {
        self.error_share.abs() > WRONG_SHARE
    }

    fn expanded_share(self) -> f64 {
        COVERAGE_FACTOR * self.std_share
    }
}

/// What became of the answer by saying more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    Better,
    Alike,
    Found,
    Withdrawn,
    Silent,
    Worse,
    Lost,
    Misled,
}

impl Outcome {
    pub(super) const ALL: [Self; 8] =
        [Self::Better, Self::Alike, Self::Found, Self::Withdrawn, Self::Silent, Self::Worse, Self::Lost, Self::Misled];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Better => "better",
            Self::Alike => "alike",
            Self::Found => "found",
            Self::Withdrawn => "withdrawn",
            Self::Silent => "silent",
            Self::Worse => "worse",
            Self::Lost => "lost",
            Self::Misled => "misled",
        }
    }

    pub(super) fn is_bad(self) -> bool {
        matches!(self, Self::Worse | Self::Lost | Self::Misled)
    }
}

/// One recording heard in two ways.
pub(super) struct Compared {
    pub(super) set: &'static str,
    pub(super) recording: String,
    pub(super) ways: Ways,
    /// Absent without a speed.
    pub(super) less: Option<SpeedError>,
    pub(super) more: Option<SpeedError>,
}

impl Compared {
    pub(super) fn outcome(&self) -> Outcome {
        match (self.less, self.more) {
            (None, None) => Outcome::Silent,
            (None, Some(more)) if more.is_wrong() => Outcome::Misled,
            (None, Some(_)) => Outcome::Found,
            (Some(less), None) if less.is_wrong() => Outcome::Withdrawn,
            (Some(_), None) => Outcome::Lost,
            (Some(less), Some(more)) => {
                let (growth, tolerance) = (grown(less, more), less.expanded_share());
                if growth > tolerance {
                    Outcome::Worse
                } else if growth < -tolerance {
                    Outcome::Better
                } else {
                    Outcome::Alike
                }
            }
        }
    }

    /// How much larger the error is with more said.
    pub(super) fn growth_share(&self) -> Option<f64> {
        Some(grown(self.less?, self.more?))
    }

    pub(super) fn is_within_own_uncertainty(&self) -> bool {
        self.more.is_some_and(|more| more.error_share.abs() <= more.expanded_share())
    }

    /// The row of the table: recording, both answers, outcome.
    pub(super) fn cells(&self) -> Vec<String> {
        let shown = |error: Option<SpeedError>| match error {
            Some(error) => {
                let sign = if error.error_share < 0.0 { "−" } else { "+" };
                format!("{sign}{:.3} ± {:.3}", 100.0 * error.error_share.abs(), 100.0 * error.expanded_share())
            }
            None => "no speed".to_owned(),
        };
        vec![
            self.recording.clone(),
            self.ways.less.name().to_owned(),
            shown(self.less),
            self.ways.more.name().to_owned(),
            shown(self.more),
            self.outcome().name().to_owned(),
        ]
    }
}

fn grown(less: SpeedError, more: SpeedError) -> f64 {
    more.error_share.abs() - less.error_share.abs()
}

#[cfg(test)]
mod tests {
    use super::super::subject::FACTS;
    use super::*;

    fn outcome(less: Option<(f64, f64)>, more: Option<(f64, f64)>) -> Outcome {
        let of = |told: Option<(f64, f64)>| told.map(|(error_share, std_share)| SpeedError { error_share, std_share });
        Compared { set: "", recording: String::new(), ways: FACTS[0], less: of(less), more: of(more) }.outcome()
    }

    #[test]
    fn an_error_may_grow_by_the_uncertainty_stated_without_the_fact() {
        assert_eq!(outcome(Some((0.001, 0.001)), Some((-0.003, 0.0001))), Outcome::Alike);
        assert_eq!(outcome(Some((0.001, 0.001)), Some((-0.0031, 0.5))), Outcome::Worse);
        assert_eq!(outcome(Some((-0.004, 0.001)), Some((0.001, 0.001))), Outcome::Better);
    }

    #[test]
    fn an_answer_may_come_or_go() {
        let (near, far) = (Some((0.001, 0.001)), Some((-0.5, 0.001)));
        assert_eq!((outcome(None, near), outcome(None, far)), (Outcome::Found, Outcome::Misled));
        assert_eq!((outcome(near, None), outcome(far, None)), (Outcome::Lost, Outcome::Withdrawn));
        assert_eq!(outcome(None, None), Outcome::Silent);
    }
}
