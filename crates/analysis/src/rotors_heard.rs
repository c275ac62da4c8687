//! How the rotors of a recording are heard: each by itself, as a group, or by one tone for all.

use crate::{Method, RotorTone};
use serde::Serialize;

/// How a method hears the rotors of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum RotorsHeard {
    /// More than half of the rotors are separated; each of these has a speed of its own.
    Separated,
    /// At most half of the rotors can be separated: they have a common mean speed and a common mean square.
    Group,
    /// One tone is used for all rotors.
    OneTone,
}

impl RotorTone {
    /// How this method hears the rotors; `None` where it has no speed.
    pub fn rotors_heard(&self, method: Method) -> Option<RotorsHeard> {
        let speed = self.speed(method)?;
        Some(match speed.method {
            Method::Separated if self.rotors.is_empty() => RotorsHeard::Group,
            Method::Separated => RotorsHeard::Separated,
            _ => RotorsHeard::OneTone,
        })
    }
}

/// Number of recordings in which the rotors are heard in each way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RotorsHeardCounts {
    /// Recordings in which they are separated.
    pub separated: usize,
    /// Recordings in which they are heard as a group.
    pub group: usize,
    /// Recordings in which one tone is used for all.
    pub one_tone: usize,
}

impl FromIterator<RotorsHeard> for RotorsHeardCounts {
    fn from_iter<I: IntoIterator<Item = RotorsHeard>>(all: I) -> Self {
        let mut counts = Self::default();
        for heard in all {
            *match heard {
                RotorsHeard::Separated => &mut counts.separated,
                RotorsHeard::Group => &mut counts.group,
                RotorsHeard::OneTone => &mut counts.one_tone,
            } += 1;
        }
        counts
    }
}
