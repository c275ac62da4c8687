//! Numbers in XML that can be a fragment, and the parts of a whole file.

use super::ModelError;
use roxmltree::Document;
use std::ops::Range;

/// Prefixes that a fragment takes from the file around it.
const START: &str = "<fragment xmlns:xacro=\"xacro\" xmlns:gz=\"gz\">";
const END: &str = "</fragment>";

/// A text with one root element around it, so that fragments can be parsed.
pub(super) struct Rooted {
    pub(super) text: String,
    /// Length of the declaration that was left out.
    declaration: usize,
}

impl Rooted {
    pub(super) fn of(text: &str) -> Self {
        let plain = text.trim_start_matches('\u{feff}').trim_start();
        let body = match plain.strip_prefix("<?xml") {
            Some(rest) => rest.split_once("?>").map_or(plain, |(_, body)| body),
            None => plain,
        };
        Self { text: format!("{START}{body}{END}"), declaration: text.len() - body.len() }
    }

    /// The place in the original text of a place in this one.
    pub(super) fn range_in_original(&self, range: Range<usize>) -> Range<usize> {
        let moved = |place: usize| place - START.len() + self.declaration;
        moved(range.start)..moved(range.end)
    }
}

/// The text with one root element around it, so that fragments can be parsed.
pub(super) fn rooted(text: &str) -> String {
    Rooted::of(text).text
}

pub(super) fn parsed<'a>(text: &'a str, format: &'static str) -> Result<Document<'a>, ModelError> {
    Document::parse(text).map_err(|error| ModelError::Broken { format, reason: error.to_string() })
}

/// Words as the name of a model: letters, digits and underscores.
pub(super) fn model_name(words: &str) -> String {
    let letters = words.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' });
    let name: String = letters.collect();
    let parts: Vec<&str> = name.split('_').filter(|part| !part.is_empty()).collect();
    if parts.is_empty() { "vehicle".to_owned() } else { parts.join("_") }
}

/// The lines, indented.
pub(super) fn indented(text: &str, columns: usize) -> String {
    text.lines().map(|line| format!("{:columns$}{line}\n", "")).collect()
}

/// The numbers of all elements with a name.
pub(super) fn numbers_in(document: &Document<'_>, name: &str) -> Vec<f64> {
    let elements = document.descendants().filter(|node| node.tag_name().name() == name);
    elements.filter_map(|node| node.text()?.trim().parse().ok()).collect()
}

/// The number that an element or an attribute holds; unknown where there is none.
pub(super) fn constant_in(name: &str, text: Option<&str>) -> Result<f64, ModelError> {
    let text = text.ok_or(ModelError::Unknown)?.trim();
    let expression = || ModelError::Expression { name: name.to_owned(), value: text.to_owned() };
    text.parse().map_err(|_| expression())
}

/// A constant that all rotors have in common.
pub(super) fn shared(constants: &[f64]) -> Result<f64, ModelError> {
    let least = constants.iter().copied().fold(f64::INFINITY, f64::min);
    let most = constants.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if constants.is_empty() {
        Err(ModelError::Unknown)
    } else if most > least * (1.0 + 1e-9) {
        Err(ModelError::UnlikeRotors { least, most })
    } else {
        Ok(least)
    }
}
