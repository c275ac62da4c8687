//! How many recordings have a speed, and how many have none and why.

use hovertone_archive::Summary;
use hovertone_report::SpeedRecord;
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
    /// Whose speed must not be used.
    pub(crate) doubtful: usize,
    /// With a speed that a warning weakens.
    pub(crate) with_warnings: usize,
}

/// What is counted of a recording.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counted<'a> {
    pub(crate) status: &'a str,
    pub(crate) is_prefix: bool,
    pub(crate) is_doubtful: bool,
    pub(crate) has_warnings: bool,
}

impl<'a> From<&'a Summary> for Counted<'a> {
    fn from(Summary { status, is_prefix, is_doubtful, warnings, .. }: &'a Summary) -> Self {
        Self { status, is_prefix: *is_prefix, is_doubtful: *is_doubtful, has_warnings: !warnings.is_empty() }
    }
}

impl<'a> From<&'a SpeedRecord> for Counted<'a> {
    fn from(record: &'a SpeedRecord) -> Self {
        Self {
            status: record.status(),
            is_prefix: record.recording.as_ref().is_some_and(|facts| facts.is_prefix),
            is_doubtful: record.is_doubtful(),
            has_warnings: !record.notices.is_empty(),
        }
    }
}

impl Counted<'_> {
    /// Whether it was heard, and has no sure speed.
    pub(crate) fn is_unsure(self) -> bool {
        self.is_doubtful || !["ok", Counts::ERROR].contains(&self.status)
    }
}

impl Counts {
    /// The status of a recording that could not be heard.
    pub(crate) const ERROR: &str = "error";

    /// Counts a recording.
    pub(crate) fn add(&mut self, heard: Counted<'_>) {
        match heard.status {
            "ok" => self.ok += 1,
            "ambiguous" => self.ambiguous += 1,
            Self::ERROR => self.error += 1,
            _ => self.no_rotor_tone += 1,
        }
        self.cut_short += usize::from(heard.is_prefix);
        self.doubtful += usize::from(heard.is_doubtful);
        self.with_warnings += usize::from(heard.status == "ok" && heard.has_warnings);
    }

    /// How many recordings were heard, and have no sure speed.
    pub(crate) fn unsure(&self) -> usize {
        self.ambiguous + self.no_rotor_tone + self.doubtful
    }

    /// Number of recordings.
    pub(crate) fn total(&self) -> usize {
        self.ok + self.ambiguous + self.no_rotor_tone + self.error
    }

    /// Whether every recording has a speed to use, and was heard to its end.
    pub(crate) fn is_complete(&self) -> bool {
        self.ok == self.total() && self.cut_short == 0 && self.doubtful == 0
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} with a speed", self.ok)?;
        if self.with_warnings > 0 {
            write!(f, " ({} of them with warnings)", self.with_warnings)?;
        }
        write!(f, ", {} without a speed, {} failed", self.no_rotor_tone, self.error)?;
        if self.ambiguous > 0 {
            write!(f, ", {} with several possible speeds", self.ambiguous)?;
        }
        if self.cut_short > 0 {
            let are = if self.cut_short == 1 {
                "is not complete: the end of its file is"
            } else {
                "are not complete: the ends of their files are"
            };
            write!(f, "; {} of the {} recordings {are} missing", self.cut_short, self.total())?;
        }
        Ok(())
    }
}
