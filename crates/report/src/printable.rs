//! Names as a terminal shows them: without control characters, and with the width of wide letters.

use unicode_width::UnicodeWidthStr;

/// Text in which nothing moves the cursor, breaks a line, colours the screen or turns the direction of writing: such characters are shown
/// as their escapes, as in `\n` and `\u{1b}`.
pub fn printable(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for letter in text.chars() {
        if letter.is_control() || is_invisible(letter) {
            shown.extend(letter.escape_default());
        } else {
            shown.push(letter);
        }
    }
    shown
}

/// Marks of direction, zero-width characters and separators of lines.
fn is_invisible(letter: char) -> bool {
    matches!(letter, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{2069}' | '\u{feff}')
}

/// Columns that a text takes in a terminal. Letters of East Asia and most pictures take two.
pub(crate) fn width_of(text: &str) -> usize {
    text.width()
}

/// Text in lines of at most `width` columns; a longer word has a line of its own.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width_of(line) + 1 + width_of(word) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Lines that are wider than `width` columns, wrapped at their spaces; the rest of a line stands below its first word, two columns further in.
/// Without a width, and where lines are narrow enough, the text stays as it is.
pub fn folded(text: &str, width: Option<usize>) -> String {
    let Some(width) = width else { return text.to_owned() };
    let of_line = |line: &str| {
        if width_of(line) <= width {
            return line.to_owned();
        }
        let indent = &line[..line.len() - line.trim_start().len()];
        let hanging = format!("{indent}  ");
        // the first line has two columns more than the others, which are not used
        let lines = wrapped(line, width.saturating_sub(width_of(&hanging)));
        format!("{indent}{}", lines.join(&format!("\n{hanging}")))
    };
    text.split('\n').map(of_line).collect::<Vec<_>>().join("\n")
}

/// The folders that a name lies in, innermost first, each with its last separator.
fn folders_of(name: &str) -> impl Iterator<Item = &str> {
    let ends = name.rmatch_indices(std::path::is_separator).map(|(index, separator)| index + separator.len());
    ends.filter_map(|end| name.get(..end))
}

/// The folder of a name, with its last separator; empty without one.
pub(crate) fn folder_of(name: &str) -> &str {
    folders_of(name).next().unwrap_or("")
}

/// The folder that all names share, with its last separator; empty where they share none, or for a single name.
pub fn shared_folder<'a>(names: &[&'a str]) -> &'a str {
    let [first, others @ ..] = names else { return "" };
    if others.is_empty() {
        return "";
    }
    let is_shared = |folder: &&str| others.iter().all(|name| name.starts_with(*folder));
    folders_of(first).find(is_shared).unwrap_or("")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_moves_the_cursor_is_escaped_and_letters_stay() {
        assert_eq!(printable("a\u{1b}[31mb\nc\u{202e}d"), "a\\u{1b}[31mb\\nc\\u{202e}d");
        assert_eq!(printable("ωé漢 .wav"), "ωé漢 .wav");
    }

    #[test]
    fn wide_letters_take_two_columns() {
        assert_eq!((width_of("漢字.wav"), width_of("abc"), width_of("e\u{301}")), (8, 3, 1));
    }

    #[test]
    fn words_are_wrapped_and_none_is_lost() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("unbreakable a", 3), ["unbreakable", "a"]);
        assert!(wrapped(" ", 10).is_empty());
    }

    #[test]
    fn long_lines_are_folded_and_short_ones_stay() {
        let text = "a  table\n  one two three four\n";
        assert_eq!(folded(text, Some(14)), "a  table\n  one two\n    three four\n");
        assert_eq!((folded(text, None), folded(text, Some(20))), (text.to_owned(), text.to_owned()));
    }

    #[test]
    fn names_lose_the_folder_that_all_share() {
        assert_eq!(shared_folder(&["/a/b/x.wav", "/a/b/c/y.wav"]), "/a/b/");
        assert_eq!(shared_folder(&["data/x.wav", "database/y.wav"]), "");
        assert_eq!((shared_folder(&["/a/x.wav"]), shared_folder(&[])), ("", ""));
    }
}
