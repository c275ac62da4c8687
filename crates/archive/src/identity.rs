//! What a folder of results is of. A run may continue only a folder of the same inputs and settings.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Most differences that are named.
const DIFFERENCES_MAX: usize = 4;

/// Version of the parts and tables. It rises when their columns change.
pub const FORMAT: u32 = 2;

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
        let mut all = Vec::new();
        differ("", [&own, &other], &mut all);
        // what follows from an argument is not said beside it
        let mut typed: Vec<&Difference> = all.iter().filter(|difference| difference.is_typed).collect();
        if typed.iter().any(|difference| difference.name == BLADES) {
            typed.retain(|difference| difference.name != ORDER);
        }
        let named = if typed.is_empty() { all.iter().collect() } else { typed };
        let mut differences: Vec<String> = named.into_iter().map(|difference| difference.in_words(places)).collect();
        differences.dedup();
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

/// The argument from which the order follows, and the order.
const BLADES: &str = "blades";
const ORDER: &str = "order";
/// Values that a person types, by the end of their place, and the names of their arguments.
const TYPED: [(&str, &str); 13] = [
    ("inputs", "inputs"),
    ("list_from_stdin", "list"),
    ("version", "version"),
    ("channel", "channel"),
    ("audio_track", "audio-track"),
    ("tone.blades", BLADES),
    ("tone.order", ORDER),
    ("tone.band_hz", "band"),
    ("span.from_s", "from"),
    ("span.to_s", "to"),
    ("known.rotor_count", "rotors"),
    ("known.diameter_m", "diameter-m"),
    ("known.mass_kg", "mass-kg"),
];

/// A value that differs.
struct Difference {
    /// Name of the argument, or place of the value.
    name: String,
    is_typed: bool,
    values: [String; 2],
}

impl Difference {
    fn of(place: &str, values: [&Value; 2]) -> Self {
        let typed = TYPED.iter().find(|(end, _)| place.ends_with(end)).map(|(_, argument)| (*argument).to_owned());
        let outer = ["settings.", "analysis.", "known."];
        let inner = || outer.iter().fold(place, |name, outer| name.strip_prefix(outer).unwrap_or(name)).to_owned();
        Self { is_typed: typed.is_some(), name: typed.unwrap_or_else(inner), values: values.map(shown) }
    }

    fn in_words(&self, places: [&str; 2]) -> String {
        let [own, other] = &self.values;
        format!("{}: {own} {}, {other} {}", self.name, places[0], places[1])
    }
}

fn differ(name: &str, [own, other]: [&Value; 2], differences: &mut Vec<Difference>) {
    match (own, other) {
        (Value::Object(of_own), Value::Object(of_other)) => {
            let mut keys: Vec<&String> = of_own.keys().chain(of_other.keys()).collect();
            keys.sort();
            keys.dedup();
            for key in keys {
                let inner = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                differ(&inner, [value_of(of_own, key), value_of(of_other, key)], differences);
            }
        }
        _ if own == other => {}
        _ => differences.push(Difference::of(name, [own, other])),
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
        Value::Null => "not given".to_owned(),
        Value::Array(values) => values.iter().map(shown).collect::<Vec<_>>().join(" and "),
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
            "inputs: DIR there, A and B here; channel: not given there, 1 here; rotors: 4 there, 2 here"
        );
        let there = identity(json!({"tone": {"blades": 2, "order": 2.0}, "search": {"known": {"blade_count": 2}}}));
        let here = identity(json!({"tone": {"blades": 3, "order": 3.0}, "search": {"known": {"blade_count": 3}}}));
        assert_eq!(there.differences(&here, ["there", "here"]).unwrap(), "blades: 2 there, 3 here");
        let there = identity(json!({"tone": {"order": 69.0}}));
        let here = identity(json!({"tone": {"order": 2.0}}));
        assert_eq!(there.differences(&here, ["there", "here"]).unwrap(), "order: 69.0 there, 2.0 here");
        let many = identity(json!({"a": 1, "b": 1, "c": 1, "d": 1, "e": 1, "f": 1}));
        let words = many.differences(&identity(json!({})), ["there", "here"]).unwrap();
        assert!(words.ends_with("; d: 1 there, not given here; and 2 more"), "{words}");
    }
}
