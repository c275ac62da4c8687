//! Why the chain ends before its last stage: it failed, or there is no rotor tone.

use crate::error::Error;
use hovertone_analysis::{Hover, NoTone, Outcome, Span, SpeedAnalysis, Warning};
use hovertone_signal::SignalError;

/// The chain ends here.
#[derive(Debug)]
pub(crate) enum Stop {
    /// Something failed.
    Failed(Error),
    /// The answer is "no rotor tone".
    Silent(Silence),
}

/// "No rotor tone", and what was found out on the way.
#[derive(Debug)]
pub(crate) struct Silence {
    pub(crate) reason: NoTone,
    pub(crate) hover: Hover,
    pub(crate) warnings: Vec<Warning>,
}

impl Silence {
    /// Before any hover was found.
    pub(crate) fn because(reason: NoTone) -> Self {
        Self { reason, hover: Hover::default(), warnings: Vec::new() }
    }

    /// The same as an answer for a recording that was heard over `heard`.
    pub(crate) fn analysis(self, heard: Span) -> SpeedAnalysis {
        let Self { reason, hover, warnings } = self;
        SpeedAnalysis { heard, hover, outcome: Outcome::NoRotorTone { reason }, warnings }
    }
}

impl Stop {
    /// The answer, where the reason is one.
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
