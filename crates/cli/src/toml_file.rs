//! Reading a TOML file of the user, with messages for its errors.

use crate::failure::Failure;
use crate::inputs::{IS_UTF16, is_utf16, read_bytes};
use crate::toml_words::{PlainFault, in_plain_words};
use hovertone_vehicle::find_preset;
use serde::de::DeserializeOwned;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What to do with a recording where the command hears none.
pub(crate) const NO_RECORDING: &str = "give the text file (TOML), not a recording";

/// A gear, which flags write as 8:69.
const GEAR: &str = "gear = { pinion = 8, wheel = 69 }";

/// A file that was read but not parsed.
pub(crate) struct TomlFile<'a> {
    /// Path of the file.
    pub(crate) path: &'a Path,
    /// Kind of the file in messages.
    kind: &'static str,
    /// Advice where to find an example.
    see_example: &'static str,
    /// Its text.
    pub(crate) text: String,
}

impl<'a> TomlFile<'a> {
    /// Reads a file of the given kind; `if_recording` says what to do with a recording, which users often give instead.
    pub(crate) fn read(
        path: &'a Path,
        kind: &'static str,
        if_recording: &str,
        see_example: &'static str,
    ) -> Result<Self, Failure> {
        let bytes = read_bytes(path, &format!("the {kind}"))?;
        let text = String::from_utf8(bytes).map_err(|error| {
            if is_utf16(error.as_bytes()) {
                return Failure::failed(IS_UTF16, "save the file as UTF-8", path);
            }
            let what = format!("this file is not text, so it cannot be the {kind}");
            Failure::failed(what, if_recording, path)
        })?;
        if text.trim_start().starts_with('{') {
            let what = format!("this file is JSON, so it cannot be the {kind}");
            return Err(Failure::failed(what, "give the TOML file", path));
        }
        Ok(Self { path, kind, see_example, text })
    }

    /// The same file, refused where nothing is in it.
    pub(crate) fn with_content(self) -> Result<Self, Failure> {
        if self.text.trim().is_empty() {
            let what = format!("this file is empty, but the {} is needed", self.kind);
            return Err(Failure::failed(what, self.see_example, self.path));
        }
        Ok(self)
    }

    /// A text that stands, or would stand, at a path.
    pub(crate) fn of_text(path: &'a Path, kind: &'static str, see_example: &'static str, text: &str) -> Self {
        Self { path, kind, see_example, text: text.to_owned() }
    }

    /// Parses the file. An unknown key is reported with the nearest known one.
    pub(crate) fn parse<T: DeserializeOwned>(&self) -> Result<T, Failure> {
        toml::from_str(&self.text).map_err(|error| fault(&error, self))
    }
}

/// The faulty line with a mark under the fault, and the nearest name for a misspelt one.
fn fault(error: &toml::de::Error, file: &TomlFile<'_>) -> Failure {
    if let Some((found, hint)) = other_kind(file) {
        return Failure::failed(format!("this is {found}, and no {}", file.kind), hint, file.path);
    }
    let PlainFault { what, hint } = in_plain_words(error.message());
    let what = format!("the {} {what}", file.kind);
    let hint = match hint {
        Some(hint) if error.message().starts_with("unknown") => mass_of_load(error, &file.text).unwrap_or(hint),
        Some(hint) => format!("{hint}; {}", file.see_example),
        None => file.see_example.to_owned(),
    };
    let span = error.span().map(|span| unknown_in(error.message(), &file.text, span.start).unwrap_or(span));
    let Some(place) = span.map(|span| Place::of(span, &file.text)) else {
        return Failure::Usage { what, hint, path: Some(file.path.to_owned()) };
    };
    let is_of_gear = place.line.trim_start().starts_with("gear");
    let (what, hint) = if error.message().starts_with("invalid time") {
        // 8:69 looks like a time
        let (thing, hint) = match is_of_gear {
            true => ("a gear", format!("write {GEAR}; {}", file.see_example)),
            false => ("a time", "write seconds as a number, as in from_s = 2.0".to_owned()),
        };
        (format!("the {} has {thing} in another form than TOML needs", file.kind), hint)
    } else if is_of_gear && error.message().starts_with("invalid type") {
        (what, format!("as in {GEAR}; {}", file.see_example))
    } else {
        (what, hint)
    };
    let what = format!("{what}\n{}", place.underlined());
    let path = PathBuf::from(format!("{}:{}:{}", file.path.display(), place.line_number, place.column));
    Failure::Usage { what, hint, path: Some(path) }
}

/// What to write in place of the whole mass of a load: the mass above that of the vehicle.
fn mass_of_load(error: &toml::de::Error, text: &str) -> Option<String> {
    let message = error.message();
    if !message.starts_with("unknown field `mass_kg`") || !message.contains("`added_mass_kg`") {
        return None;
    }
    let file: toml::Table = text.parse().ok()?;
    let vehicle = file.get("vehicle");
    let number = |value: &toml::Value| value.as_float().or_else(|| Some(value.as_integer()? as f64));
    let of_preset = || find_preset(vehicle?.get("preset")?.as_str()?)?.mass_kg.map(|mass| mass.value);
    let vehicle_kg = vehicle.and_then(|vehicle| number(vehicle.get("mass_kg")?)).or_else(of_preset);
    let loads = file.get("load").and_then(toml::Value::as_array);
    let whole_kg = loads.and_then(|loads| loads.iter().find_map(|load| number(load.get("mass_kg")?)));
    let added = match vehicle_kg.zip(whole_kg) {
        Some((vehicle_kg, whole_kg)) if whole_kg >= vehicle_kg => {
            format!("added_mass_kg = {:.6}", whole_kg - vehicle_kg)
                .trim_end_matches('0')
                .trim_end_matches('.')
                .to_owned()
        }
        _ => "added_mass_kg".to_owned(),
    };
    Some(format!("for a load, write only the mass that it adds to the vehicle: {added}"))
}

/// What a file is instead, and its command: an experiment has loads, a scenario has manoeuvres.
fn other_kind(file: &TomlFile<'_>) -> Option<(&'static str, &'static str)> {
    let has = |section: &str| file.text.lines().any(|line| line.trim().starts_with(section));
    match file.kind {
        "experiment file" if has("[[maneuver]]") => Some((
            "a scenario file",
            "`hovertone simulate` takes this file; `hovertone init` writes an experiment file",
        )),
        "experiment file" => None,
        _ if has("[[load]]") => Some((
            "an experiment file",
            "`hovertone identify` takes this file; the help of this command shows the file that it needs",
        )),
        _ => None,
    }
}

/// Where the name stands that the parser does not know, behind a position: of a table that comes several times, the parser names the header.
fn unknown_in(message: &str, text: &str, from: usize) -> Option<Range<usize>> {
    let name = message.strip_prefix("unknown ")?.split('`').nth(1)?;
    let rest = text.get(from..)?;
    let quoted = || rest.find(&format!("\"{name}\"")).map(|at| at + 1);
    let is_key = |at: &usize| {
        let line_start = rest[..*at].rfind('\n').map_or(0, |feed| feed + 1);
        rest[line_start..*at].trim().is_empty() && rest[at + name.len()..].trim_start().starts_with('=')
    };
    let key = || rest.match_indices(name).map(|(at, _)| at).find(is_key);
    let at = from + if message.starts_with("unknown field") { key()? } else { quoted()? };
    Some(at..at + name.len())
}

/// A position in a text, with line and column counted from 1.
struct Place<'a> {
    line: &'a str,
    line_number: usize,
    column: usize,
    length: usize,
}

impl<'a> Place<'a> {
    fn of(span: Range<usize>, text: &'a str) -> Self {
        let before = text.get(..span.start).unwrap_or(text);
        let line_start = before.rfind('\n').map_or(0, |feed| feed + 1);
        let line = text[line_start..].lines().next().unwrap_or("");
        let indent = before[line_start..].chars().count();
        let marked = text.get(span).unwrap_or("").lines().next().unwrap_or("").chars().count();
        Self { line, line_number: before.matches('\n').count() + 1, column: indent + 1, length: marked.max(1) }
    }

    fn underlined(&self) -> String {
        let number = self.line_number.to_string();
        let (margin, indent) = (" ".repeat(number.len()), " ".repeat(self.column - 1));
        format!("  {margin} |\n  {number} | {}\n  {margin} | {indent}{}", self.line, "^".repeat(self.length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_counted_from_one_and_underlined() {
        let text = "[vehicle]\n  mas_kg = 1\n";
        let place = Place::of(12..18, text);
        assert_eq!((place.line_number, place.column), (2, 3));
        assert_eq!(place.underlined(), "    |\n  2 |   mas_kg = 1\n    |   ^^^^^^");
        let end = Place::of(23..23, text);
        assert_eq!((end.line_number, end.line), (3, ""));
    }
}
