//! What a folder of results is of. A run may continue only a folder of the same inputs and settings.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

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
    /// What differs, each as `NAME: THERE there, HERE here`; empty where a run may continue.
    pub fn differences(&self, here: &Self) -> Vec<String> {
        let (there, here) = (self.to_json(), here.to_json());
        let mut differences = Vec::new();
        differ("", &there, &here, &mut differences);
        differences
    }

    /// As read from its text: a reader of JSON may round the last digit of a number, and both sides must be read alike.
    fn to_json(&self) -> Value {
        let text = serde_json::to_string(self).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or_default()
    }
}

fn differ(name: &str, there: &Value, here: &Value, differences: &mut Vec<String>) {
    match (there, here) {
        (Value::Object(of_there), Value::Object(of_here)) => {
            let mut keys: Vec<&String> = of_there.keys().chain(of_here.keys()).collect();
            keys.sort();
            keys.dedup();
            for key in keys {
                let inner = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                differ(&inner, value_of(of_there, key), value_of(of_here, key), differences);
            }
        }
        _ if there == here => {}
        _ => {
            let name = name.strip_prefix("settings.").unwrap_or(name);
            let name = in_words(name.strip_prefix("analysis.").unwrap_or(name));
            differences.push(format!("{name}: {} there, {} here", shown(there), shown(here)));
        }
    }
}

fn value_of<'a>(object: &'a Map<String, Value>, key: &str) -> &'a Value {
    object.get(key).unwrap_or(&Value::Null)
}

/// "known rotor count" of `known.rotor_count`.
fn in_words(name: &str) -> String {
    name.replace(['.', '_'], " ")
}

fn shown(value: &Value) -> String {
    match value {
        Value::Object(entries) => {
            let entry = |(name, value): (&String, &Value)| format!("{} {}", in_words(name), shown(value));
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
        assert_eq!(read.differences(&there), Vec::<String>::new());
    }

    #[test]
    fn what_differs_is_named_with_both_values() {
        let there = identity(
            json!({"known": {"rotor_count": 4, "shaft_speed": {"rev_s_high": 80, "rev_s_low": 20}}, "order": 2.0}),
        );
        assert!(there.differences(&there).is_empty());
        let here = identity(json!({"known": {"rotor_count": 2}, "order": 2.0, "channel": 1}));
        let here = BatchIdentity { inputs: vec!["A".to_owned(), "B".to_owned()], ..here };
        assert_eq!(
            there.differences(&here),
            [
                "inputs: DIR there, A B here",
                "channel: none there, 1 here",
                "known rotor count: 4 there, 2 here",
                "known shaft speed: rev s high 80, rev s low 20 there, none here"
            ]
        );
    }
}
