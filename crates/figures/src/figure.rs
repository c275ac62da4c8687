//! A figure: its name, its texts and its drawing.

/// A finished figure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Figure {
    /// Name, usable as a file name: `figure-6-spectrograms`.
    pub name: String,
    /// Title on one line.
    pub title: String,
    /// Description of the content, for a caption and for people who cannot see it.
    pub description: String,
    /// The drawing, with everything that it needs inside.
    pub svg: String,
}

/// A figure that could not be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// Error of the plotting library.
    #[error("a figure could not be drawn: {0}")]
    Drawing(String),
    /// Error of the PNG encoder.
    #[error("a picture could not be packed: {0}")]
    Packing(#[from] png::EncodingError),
    /// The drawing could not be turned into pixels.
    #[error("a figure could not be turned into pixels: {0}")]
    Pixels(String),
}

/// Text with the special characters of XML escaped.
pub(crate) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            // characters that XML does not allow
            '\u{0}'..='\u{8}' | '\u{b}' | '\u{c}' | '\u{e}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => {
                escaped.push('\u{fffd}');
            }
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// The name, or its beginning and end where it is longer than `letters`.
pub fn shortened(name: &str, letters: usize) -> String {
    let count = name.chars().count();
    if count <= letters {
        return name.chars().map(|letter| if letter.is_control() { '\u{fffd}' } else { letter }).collect();
    }
    let head = letters / 2;
    let tail = letters.saturating_sub(head + 1);
    let kept = name.chars().take(head).chain(['…']).chain(name.chars().skip(count - tail));
    kept.map(|letter| if letter.is_control() { '\u{fffd}' } else { letter }).collect()
}

/// A reason without the advice behind it, where there is room for a line alone.
pub fn without_advice(reason: &str) -> &str {
    reason.split_once("; ").map_or(reason, |(found, _)| found)
}

/// The beginning of a sentence, up to the last whole word of at most `letters`.
pub fn beginning(sentence: &str, letters: usize) -> String {
    if sentence.chars().count() <= letters {
        return shortened(sentence, letters);
    }
    let end = sentence.char_indices().take(letters).filter(|(_, letter)| *letter == ' ').last();
    let words = end.map_or("", |(end, _)| &sentence[..end]);
    shortened(&format!("{}…", words.trim_end_matches([',', ';', ':', ' '])), letters)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_no_markup() {
        assert_eq!(escaped("<b a='\"'>&\u{1}"), "&lt;b a=&#39;&quot;&#39;&gt;&amp;\u{fffd}");
        assert_eq!(shortened("no_hull/trial_1.wav", 11), "no_hu…1.wav");
        assert_eq!(shortened("a\nb", 11), "a\u{fffd}b");
    }

    #[test]
    fn a_reason_stands_without_its_advice() {
        assert_eq!(without_advice("nothing sounds; record nearer; again"), "nothing sounds");
        assert_eq!(without_advice("too short"), "too short");
    }

    #[test]
    fn a_sentence_ends_after_a_whole_word() {
        let sentence = "nothing resembles, as yet, a rotor";
        assert_eq!(beginning(sentence, 34), sentence);
        for letters in [28, 27] {
            assert_eq!(beginning(sentence, letters), "nothing resembles, as yet…");
        }
        assert_eq!(beginning(sentence, 26), "nothing resembles, as…");
        assert_eq!(beginning("rotor", 3), "…");
    }
}
