//! A warning as text: the problem and the advice.

use crate::wording::Wording;
use hovertone_analysis::Warning;
use hovertone_thrust::ThrustWarning;
use serde::{Serialize, Serializer};
use std::fmt;

/// A warning and its hint, from any part of the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// The problem.
    pub text: String,
    /// The advice.
    pub hint: String,
    /// What it is about, where another part of the program must know it.
    pub kind: NoticeKind,
}

/// What a notice is about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoticeKind {
    /// Anything else.
    #[default]
    Other,
    /// The sound contradicts the facts that were given.
    AnotherRotorFits,
    /// No multirotor does what the facts and the speed mean together.
    Impossible,
    /// The vehicle cannot hover with its mass at the speed.
    CannotHover,
    /// No rotor has a name, although names were asked for.
    NoNames,
    /// A part of the log of the flight is lost.
    DamagedLog,
    /// The ± of the speed is large, and the answer is the same.
    LargeUncertainty,
}

impl NoticeKind {
    /// What a warning about a recording is about.
    pub fn of_warning(warning: &Warning) -> Self {
        match warning {
            Warning::FitsElsewhere(_) => Self::AnotherRotorFits,
            Warning::RotorsNotApart { .. } | Warning::RotorCountUnknown { .. } | Warning::FewFrames { .. } => {
                Self::LargeUncertainty
            }
            _ => Self::Other,
        }
    }

    /// Whether nobody should use a speed with such a notice.
    pub(crate) fn forbids_use(self) -> bool {
        matches!(self, Self::Impossible | Self::CannotHover)
    }

    /// Whether the answer is not complete with such a notice.
    pub(crate) fn is_incomplete(self) -> bool {
        self.forbids_use() || matches!(self, Self::NoNames | Self::DamagedLog)
    }
}

impl Notice {
    /// From a text and a hint.
    pub fn new(text: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { text: text.into(), hint: hint.into(), kind: NoticeKind::Other }
    }

    /// The same, of a kind.
    pub fn of_kind(self, kind: NoticeKind) -> Self {
        Self { kind, ..self }
    }

    /// The same, with its advice in the words of a command.
    pub fn worded(self, wording: Wording) -> Self {
        Self { hint: wording.of(&self.hint), ..self }
    }
}

impl From<&ThrustWarning> for Notice {
    fn from(warning: &ThrustWarning) -> Self {
        Self::new(warning.to_string(), warning.hint())
    }
}

/// The notice on one line, with its hint.
impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.hint.as_str() {
            "" => f.write_str(&self.text),
            hint => write!(f, "{} (hint: {hint})", self.text),
        }
    }
}

impl Serialize for Notice {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is read of a damaged log may be used, but a part is missing.
    #[test]
    fn a_damaged_log_leaves_an_answer_incomplete() {
        assert!(NoticeKind::DamagedLog.is_incomplete() && !NoticeKind::DamagedLog.forbids_use());
        assert!(!NoticeKind::Other.is_incomplete() && !NoticeKind::LargeUncertainty.is_incomplete());
    }
}
