//! A recording in an experiment file: its name, or a table that names the log of its flight as well.

use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;

/// A recording as written: `"hover.wav"`, or `{ file = "hover.wav", log = "hover.ulg" }`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum RecordingSection {
    /// Name or pattern.
    Name(String),
    /// One recording with the log of its flight.
    WithLog(RecordingWithLog),
}

/// A recording and the log of its flight.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordingWithLog {
    /// Name of the recording.
    pub file: String,
    /// Name of the log.
    pub log: String,
}

impl RecordingSection {
    /// Name or pattern of the recording.
    pub fn file(&self) -> &str {
        match self {
            Self::Name(file) | Self::WithLog(RecordingWithLog { file, .. }) => file,
        }
    }

    /// Whether the name of the recording or of its log has no letter.
    pub(crate) fn has_empty_name(&self) -> bool {
        [Some(self.file()), self.log()].into_iter().flatten().any(|name| name.trim().is_empty())
    }

    /// Name of the log.
    pub fn log(&self) -> Option<&str> {
        match self {
            Self::Name(_) => None,
            Self::WithLog(RecordingWithLog { log, .. }) => Some(log),
        }
    }
}

/// By hand, so that the message of a fault names the key and not the two forms.
impl<'de> Deserialize<'de> for RecordingSection {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Written;

        impl<'de> Visitor<'de> for Written {
            type Value = RecordingSection;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a string")
            }

            fn visit_str<E: Error>(self, file: &str) -> Result<Self::Value, E> {
                Ok(RecordingSection::Name(file.to_owned()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                RecordingWithLog::deserialize(MapAccessDeserializer::new(map)).map(RecordingSection::WithLog)
            }
        }
        deserializer.deserialize_any(Written)
    }
}
