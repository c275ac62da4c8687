//! From the messages of the TOML parser to plain words: the fault, and what to do.

use crate::nearest::nearest;

/// A fault of a file in plain words.
#[derive(Debug, PartialEq)]
pub(crate) struct PlainFault {
    /// What is wrong, after "the experiment file ".
    pub(crate) what: String,
    /// What to do, where it follows from the fault.
    pub(crate) hint: Option<String>,
}

impl PlainFault {
    fn new(what: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { what: what.into(), hint: Some(hint.into()) }
    }
}

/// The fault that a message of the parser tells. A message of an unknown kind keeps its words.
pub(crate) fn in_plain_words(message: &str) -> PlainFault {
    let message = message.trim_end().replace('\n', " ");
    unknown_name(&message)
        .or_else(|| missing_name(&message))
        .or_else(|| wrong_value(&message))
        .or_else(|| syntax(&message))
        .unwrap_or(PlainFault { what: format!("has a fault: {message}"), hint: None })
}

/// From "unknown field `a`, expected one of `b`, `c`", or "variant", to the nearest known name.
fn unknown_name(message: &str) -> Option<PlainFault> {
    let (kind, list) = match message.strip_prefix("unknown field ") {
        Some(list) => ("key", list),
        None => ("value", message.strip_prefix("unknown variant ")?),
    };
    let mut quoted = list.split('`').skip(1).step_by(2);
    let (name, known) = (quoted.next()?, quoted.collect::<Vec<_>>());
    let list = known.join(", ");
    let hint = match nearest(name, known) {
        Some(nearest) => format!("did you mean \"{nearest}\"? Possible here: {list}"),
        None => format!("possible here: {list}"),
    };
    Some(PlainFault::new(format!("has an unknown {kind} \"{name}\""), hint))
}

/// From "missing field `a`".
fn missing_name(message: &str) -> Option<PlainFault> {
    let name = message.strip_prefix("missing field `")?.strip_suffix('`')?;
    Some(PlainFault::new(format!("lacks \"{name}\""), format!("add \"{name}\"")))
}

/// From "invalid type: integer `3`, expected a string", "invalid value: …" and "invalid length 2, expected …".
fn wrong_value(message: &str) -> Option<PlainFault> {
    let (found, expected) = message.strip_prefix("invalid ")?.split_once(", expected ")?;
    let found = match found.split_once(": ") {
        Some((_, "map")) if expected == "a sequence" => {
            let what = "has one table where a list of tables is needed";
            return Some(PlainFault::new(what, "write its name in double brackets, such as [[load]]"));
        }
        Some((_, found)) => shown(found),
        None => format!("a list of {}", found.strip_prefix("length ")?),
    };
    let wanted = wanted(expected);
    let hint = match wanted.as_str() {
        "a number" if found.starts_with('"') => {
            "write a number, without quotes and unit; the unit is at the end of the key's name: 413 g are mass_kg = 0.413".to_owned()
        }
        _ => format!("write {wanted}"),
    };
    Some(PlainFault::new(format!("has {found} where {wanted} is needed"), hint))
}

/// A value without the name of its type: "integer `3`" is 3.
fn shown(found: &str) -> String {
    match found {
        "map" => return "a table".to_owned(),
        "sequence" => return "a list".to_owned(),
        _ => {}
    }
    let value = found.strip_prefix("string ").or_else(|| found.split_once('`')?.1.strip_suffix('`'));
    value.unwrap_or(found).to_owned()
}

/// The type that the parser expects, for people.
fn wanted(expected: &str) -> String {
    let length = |text: &str| text.rsplit(' ').next().unwrap_or_default().to_owned();
    match expected {
        "a string" => "text in quotes".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "a sequence" => "a list [...]".to_owned(),
        "f64" | "f32" => "a number".to_owned(),
        "u8" | "u16" | "u32" | "u64" | "usize" => "a positive whole number".to_owned(),
        _ if expected.starts_with("struct ") => "a table { key = value, ... }".to_owned(),
        _ if expected.starts_with("an array of length") || expected.starts_with("a tuple of size") => {
            format!("a list of {} numbers", length(expected))
        }
        _ => expected.to_owned(),
    }
}

/// Faults of the text itself.
fn syntax(message: &str) -> Option<PlainFault> {
    let is = |start: &str| message.starts_with(start);
    if is("duplicate key") {
        let hint =
            "leave one of the two out; of a table that may come several times, write [[load]] with double brackets";
        return Some(PlainFault::new("has this name twice", hint));
    }
    if is("unclosed table") {
        return Some(PlainFault::new(
            "has a name in brackets that does not end",
            "write ] behind the name; a name has no spaces, as in [my-drone]",
        ));
    }
    if is("missing escaped value") || is("too few unicode value digits") {
        return Some(PlainFault::new(
            "has a backslash in text, where it has another meaning",
            "in a path write / in place of \\",
        ));
    }
    if is("string values must be quoted") {
        return Some(PlainFault::new(
            "has text without quotes, or a number with a unit",
            "write text as \"text\", and a number without its unit: 0.413 for 413 g where the name ends in _kg",
        ));
    }
    if message.starts_with("extra `") && message.ends_with("expected nothing") {
        return Some(PlainFault::new("has more than one = on this line", "write one key and one value on each line"));
    }
    if let Some((what, needed)) = message.split_once(", expected ").filter(|(_, needed)| !needed.contains(", ")) {
        return Some(PlainFault::new(
            format!("has a fault: {what}"),
            match needed {
                "nothing" => "remove it".to_owned(),
                needed => format!("{} is needed here", needed.replace('`', "")),
            },
        ));
    }
    let is_more = is("unexpected key or value, expected newline");
    is_more.then(|| {
        PlainFault::new(
            "has something after the value on this line",
            "write decimals with a point, as in 0.4, and only one key with its value on each line",
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_known_keys_are_read_from_the_parsers_message() {
        let key = in_plain_words("unknown field `mas_kg`, expected one of `mass_kg`, `rotors`");
        assert_eq!(key.what, "has an unknown key \"mas_kg\"");
        assert!(key.hint.unwrap().contains("did you mean \"mass_kg\"? Possible here: mass_kg, rotors"));
        let value = in_plain_words("unknown variant `hoover`, expected one of `hover`, `land`");
        assert_eq!(value.what, "has an unknown value \"hoover\"");
    }

    #[test]
    fn the_parsers_types_have_plain_names() {
        for (message, what) in [
            ("missing field `vehicle`\n", "lacks \"vehicle\""),
            ("invalid type: integer `3`, expected a string", "has 3 where text in quotes is needed"),
            ("invalid type: string \"0.4\", expected f64", "has \"0.4\" where a number is needed"),
            ("invalid type: floating point `4.5`, expected u32", "has 4.5 where a positive whole number is needed"),
            ("invalid type: integer `8`, expected struct Gear", "has 8 where a table { key = value, ... } is needed"),
            ("invalid length 2, expected an array of length 3", "has a list of 2 where a list of 3 numbers is needed"),
            ("invalid type: map, expected a sequence", "has one table where a list of tables is needed"),
            ("duplicate key", "has this name twice"),
            ("missing escaped value, expected `b`, `e`, `f`", "has a backslash in text, where it has another meaning"),
            ("unclosed table, expected `]`", "has a name in brackets that does not end"),
            ("extra `=`, expected nothing", "has more than one = on this line"),
            (
                "an order is a number above 0 without quotes, or \"auto\"",
                "has a fault: an order is a number above 0 without quotes, or \"auto\"",
            ),
        ] {
            assert_eq!(in_plain_words(message).what, what, "{message}");
        }
    }
}
