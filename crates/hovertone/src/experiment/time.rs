//! A time as people write it: seconds, or minutes and seconds as a player shows them.

use serde::{Deserialize, Deserializer, de::Error};

/// Seconds in a minute, and minutes in an hour. *Physics.*
const SIXTY: f64 = 60.0;
/// Most parts of a time: hours, minutes, seconds. *Numeric.*
const PARTS_MAX: usize = 3;

/// Seconds of a time: `62.5`, `1:02.5` or `0:01:02.5`. `None` where the text is no time: an unknown sign, minutes or seconds of 60 or more
/// behind a colon, a fraction before one.
///
/// ```
/// use hovertone::experiment::time_s_from_text;
///
/// assert_eq!(time_s_from_text("1:02.5"), Some(62.5));
/// assert_eq!(time_s_from_text("62.5"), Some(62.5));
/// assert_eq!(time_s_from_text("1:62"), None);
/// ```
pub fn time_s_from_text(text: &str) -> Option<f64> {
    let text = text.trim();
    if !text.contains(':') {
        return text.parse().ok();
    }
    let (sign, unsigned) = text.strip_prefix(['-', '−']).map_or((1.0, text), |rest| (-1.0, rest));
    let parts: Vec<&str> = unsigned.split(':').collect();
    let is_plain = |part: &str| part.starts_with(|c: char| c.is_ascii_digit()) && !part.contains(['e', 'E']);
    if parts.len() > PARTS_MAX || !parts.iter().all(|part| is_plain(part)) {
        return None;
    }
    let mut time_s = 0.0;
    for (index, part) in parts.iter().enumerate() {
        let is_last = index + 1 == parts.len();
        let number: f64 = if is_last { part.parse().ok()? } else { f64::from(part.parse::<u32>().ok()?) };
        if index > 0 && number >= SIXTY {
            return None;
        }
        time_s = time_s * SIXTY + number;
    }
    Some(sign * time_s)
}

/// A time in a file: a number of seconds, or a text such as `"1:02.5"`.
#[derive(Deserialize)]
#[serde(untagged, expecting = "a time must be a number of seconds, such as 62.5, or \"1:02.5\"")]
enum Written {
    Seconds(f64),
    Text(String),
}

/// Reads an optional time of a file.
pub(super) fn optional<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    match Written::deserialize(deserializer)? {
        Written::Seconds(time_s) => Ok(Some(time_s)),
        Written::Text(text) => {
            let no_time =
                || D::Error::custom(format!("{text:?} is no time: write seconds, such as 62.5, or \"1:02.5\""));
            time_s_from_text(&text).map(Some).ok_or_else(no_time)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_seconds_or_minutes_and_seconds() {
        for (text, time_s) in [
            ("0", 0.0),
            ("62.5", 62.5),
            (" 1:02.5 ", 62.5),
            ("01:02", 62.0),
            ("1:02:03.25", 3723.25),
            ("90:00", 5400.0),
            ("-0:05", -5.0),
            ("-3", -3.0),
        ] {
            assert_eq!(time_s_from_text(text), Some(time_s), "{text}");
        }
        for text in ["", ":", "1:", ":30", "1:60", "1:2:3:4", "1.5:00", "1:-3", "a:b", "1:1e1", "--1:00", "1:+2"] {
            assert_eq!(time_s_from_text(text), None, "{text}");
        }
    }
}
