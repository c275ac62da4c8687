//! Filters of the templates.
#![expect(unreachable_pub, reason = "the macro of a filter writes a public function")]

use askama::filters::{Html, Safe, escape};
use std::fmt::{Display, Write};

/// Escaped text whose flags (`--band`) stay whole at the end of a line: a browser breaks a line after a hyphen.
#[askama::filter_fn]
pub(crate) fn whole_flags(text: impl Display, _: &dyn askama::Values) -> askama::Result<Safe<String>> {
    Ok(Safe(with_whole_flags(&text.to_string())?))
}

fn with_whole_flags(text: &str) -> askama::Result<String> {
    let mut html = String::new();
    for word in text.split_inclusive(char::is_whitespace) {
        let (word, space) = word.split_at(word.trim_end().len());
        let escaped = escape(word, Html)?;
        if word.contains("--") {
            write!(html, "<span class=\"nowrap\">{escaped}</span>{space}")?;
        } else {
            write!(html, "{escaped}{space}")?;
        }
    }
    Ok(html)
}

#[cfg(test)]
mod tests {
    use super::with_whole_flags;

    #[test]
    fn flags_stay_whole_and_nothing_is_markup() {
        let html = with_whole_flags("give <b> or --mass-kg,\nor (--band)").unwrap();
        assert_eq!(
            html,
            "give &#60;b&#62; or <span class=\"nowrap\">--mass-kg,</span>\nor <span class=\"nowrap\">(--band)</span>"
        );
    }
}
