//! What a folder of results is of. A run may continue only a folder of the same inputs and settings.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Most differences that are named.
const DIFFERENCES_MAX: usize = 4;

/// Version of the parts and tables. It rises when their columns change.
pub const FORMAT: u32 = 1;

/// Inputs and settings of a batch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BatchIdentity {
    /// Version of the parts and tables.
    pub format: u32,
    /// Version of the program.
    pub version: String,
    /// What is heard, as typed.
    pub inputs: Vec<String>,
    /// Number and hash of the names that came from stdin, where a list did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub list_from_stdin: Option<String>,
    /// How it is heard.
    pub settings: Value,
}

impl BatchIdentity {
    /// What differs, as `NAME: OWN where, OTHER where; …`, the first few; `None` where a run may continue. `places` say where each of the two is:
    /// "in speeds".
    pub fn differences(&self, other: &Self, places: [&str; 2]) -> Option<String> {
        let (own, other) = (self.to_json(), other.to_json());
        let mut differences = Vec::new();
        differ("", [&own, &other], places, &mut differences);
        let more = differences.len().saturating_sub(DIFFERENCES_MAX);
        differences.truncate(DIFFERENCES_MAX);
        if more > 0 {
            differences.push(format!("and {more} more"));
        }
        (!differences.is_empty()).then(|| differences.join("; "))
    }

    fn to_json(&self) -> Value {
        serde_json::to_value(self).unwrap_or_default()
    }
}

fn differ(name: &str, [own, other]: [&Value; 2], places: [&str; 2], differences: &mut Vec<String>) {
    match (own, other) {
        (Value::Object(of_own), Value::Object(of_other)) => {
            let mut keys: Vec<&String> = of_own.keys().chain(of_other.keys()).collect();
            keys.sort();
            keys.dedup();
            for key in keys {
                let inner = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                differ(&inner, [value_of(of_own, key), value_of(of_other, key)], places, differences);
            }
        }
        _ if own == other => {}
        _ => {
            let outer = ["settings.", "analysis.", "known."];
            let name = outer.iter().fold(name, |name, outer| name.strip_prefix(outer).unwrap_or(name));
            differences.push(format!("{name}: {} {}, {} {}", shown(own), places[0], shown(other), places[1]));
        }
    }
}

fn value_of<'a>(object: &'a Map<String, Value>, key: &str) -> &'a Value {
    object.get(key).unwrap_or(&Value::Null)
}

fn shown(value: &Value) -> String {
    match value {
        Value::Object(entries) => {
            let entry = |(name, value): (&String, &Value)| format!("{name} {}", shown(value));
            entries.iter().map(entry).collect::<Vec<_>>().join(", ")
        }
        Value::Null => "none".to_owned(),
        Value::Array(values) => values.iter().map(shown).collect::<Vec<_>>().join(" "),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn identity(settings: Value) -> BatchIdentity {
        BatchIdentity {
            format: FORMAT,
            version: "1".to_owned(),
            inputs: vec!["DIR".to_owned()],
            list_from_stdin: None,
            settings,
        }
    }

    #[test]
    fn an_identity_equals_itself_after_it_was_written() {
        let there = identity(json!({"speed_rad_s_min": 94.247_779_607_693_79, "x": 0.1 + 0.2}));
        let read: BatchIdentity = serde_json::from_str(&serde_json::to_string_pretty(&there).unwrap()).unwrap();
        assert_eq!(read.differences(&there, ["there", "here"]), None);
    }

    #[test]
    fn what_differs_is_named_with_both_values() {
        let there = identity(
            json!({"known": {"rotor_count": 4, "shaft_speed": {"rev_s_high": 80, "rev_s_low": 20}}, "order": 2.0}),
        );
        assert_eq!(there.differences(&there, ["there", "here"]), None);
        let here = identity(json!({"known": {"rotor_count": 2}, "order": 2.0, "channel": 1}));
        let here = BatchIdentity { inputs: vec!["A".to_owned(), "B".to_owned()], ..here };
        assert_eq!(
            there.differences(&here, ["there", "here"]).unwrap(),
            "inputs: DIR there, A B here; channel: none there, 1 here; rotor_count: 4 there, 2 here; \
             shaft_speed: rev_s_high 80, rev_s_low 20 there, none here"
        );
        let many = identity(json!({"a": 1, "b": 1, "c": 1, "d": 1, "e": 1, "f": 1}));
        let words = many.differences(&identity(json!({})), ["there", "here"]).unwrap();
        assert!(words.ends_with("; d: 1 there, none here; and 2 more"), "{words}");
    }
}
