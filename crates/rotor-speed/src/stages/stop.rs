//! The chain ends before its last stage: by an error, or because there is no rotor tone.

use crate::error::Error;
use hovertone_analysis::{Hover, NoTone, Outcome, Span, SpeedAnalysis, Warning};
use hovertone_signal::SignalError;

/// The reason for which the chain ends early.
#[derive(Debug)]
pub(crate) enum Stop {
    /// An error.
    Failed(Error),
    /// The answer "no rotor tone".
    Silent(Silence),
}

/// The answer "no rotor tone", with the results of the stages before.
#[derive(Debug)]
pub(crate) struct Silence {
    pub(crate) reason: NoTone,
    pub(crate) hover: Hover,
    pub(crate) warnings: Vec<Warning>,
}

impl Silence {
    /// The answer before any hover was found.
    pub(crate) fn because(reason: NoTone) -> Self {
        Self { reason, hover: Hover::default(), warnings: Vec::new() }
    }

    /// The analysis of a recording over the span `heard`.
    pub(crate) fn analysis(self, heard: Span) -> SpeedAnalysis {
        let Self { reason, hover, warnings } = self;
        SpeedAnalysis { heard, hover, outcome: Outcome::NoRotorTone { reason }, warnings }
    }
}

impl Stop {
    /// The answer, or the error.
    pub(crate) fn answer(self, heard: Span) -> Result<SpeedAnalysis, Error> {
        match self {
            Self::Failed(error) => Err(error),
            Self::Silent(silence) => Ok(silence.analysis(heard)),
        }
    }
}

impl From<Silence> for Stop {
    fn from(silence: Silence) -> Self {
        Self::Silent(silence)
    }
}

impl From<Error> for Stop {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

impl From<SignalError> for Stop {
    fn from(error: SignalError) -> Self {
        Self::Failed(error.into())
    }
}
