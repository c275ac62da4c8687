//! A warning as text: the problem and the advice.

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
}

impl Notice {
    /// From a text and a hint.
    pub fn new(text: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { text: text.into(), hint: hint.into() }
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
        write!(f, "{} (hint: {})", self.text, self.hint)
    }
}

impl Serialize for Notice {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
