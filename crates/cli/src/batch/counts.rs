//! How many recordings have a speed, and how many have none and why.

use serde::Serialize;
use std::fmt;

/// Numbers of recordings by their status.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub(crate) struct Counts {
    /// With a speed.
    pub(crate) ok: usize,
    /// With a tone of which the order is open.
    pub(crate) ambiguous: usize,
    /// Without a rotor tone.
    pub(crate) no_rotor_tone: usize,
    /// That could not be heard.
    pub(crate) error: usize,
    /// That end before their sound does, whatever their status.
    pub(crate) cut_short: usize,
}

impl Counts {
    /// The status of a recording that could not be heard.
    pub(crate) const ERROR: &str = "error";

    /// Counts a recording.
    pub(crate) fn add(&mut self, status: &str, is_prefix: bool) {
        match status {
            "ok" => self.ok += 1,
            "ambiguous" => self.ambiguous += 1,
            Self::ERROR => self.error += 1,
            _ => self.no_rotor_tone += 1,
        }
        self.cut_short += usize::from(is_prefix);
    }

    /// Whether a recording of this status was heard, and has no sure speed.
    pub(crate) fn is_unsure(status: &str) -> bool {
        !["ok", Self::ERROR].contains(&status)
    }

    /// Number of recordings.
    pub(crate) fn total(&self) -> usize {
        self.ok + self.ambiguous + self.no_rotor_tone + self.error
    }

    /// Whether every recording has a speed, and was heard to its end.
    pub(crate) fn is_complete(&self) -> bool {
        self.ok == self.total() && self.cut_short == 0
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} with a speed, {} without a speed, {} failed", self.ok, self.no_rotor_tone, self.error)?;
        if self.ambiguous > 0 {
            write!(f, ", {} with several possible speeds", self.ambiguous)?;
        }
        if self.cut_short > 0 {
            write!(f, "; {} of them end too early", self.cut_short)?;
        }
        Ok(())
    }
}
