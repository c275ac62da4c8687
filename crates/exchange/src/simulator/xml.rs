//! Numbers in XML that can be a fragment.

use super::ModelError;
use roxmltree::Document;

/// The text with one root element around it, so that fragments can be parsed.
pub(super) fn rooted(text: &str) -> String {
    let body = match text.trim_start().strip_prefix("<?") {
        Some(rest) => rest.split_once("?>").map_or(rest, |(_, body)| body),
        None => text,
    };
    // prefixes that a fragment takes from the file around it
    format!("<fragment xmlns:xacro=\"xacro\" xmlns:gz=\"gz\">{body}</fragment>")
}

pub(super) fn parsed<'a>(text: &'a str, format: &'static str) -> Result<Document<'a>, ModelError> {
    Document::parse(text).map_err(|error| ModelError::Broken { format, reason: error.to_string() })
}

/// The numbers of all elements with a name.
pub(super) fn numbers_in(document: &Document<'_>, name: &str) -> Vec<f64> {
    let elements = document.descendants().filter(|node| node.tag_name().name() == name);
    elements.filter_map(|node| node.text()?.trim().parse().ok()).collect()
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
