//! The command line as typed, for repeating the run.

use crate::caller::typed_words;
use hovertone_report::printable;

/// The whole command line, quoted for a shell. Invalid UTF-8 and control characters are replaced.
pub(crate) fn typed_command() -> String {
    let words = typed_words();
    let words = words.iter().skip(1).map(|word| printable(&quoted(&word.to_string_lossy())));
    ["hovertone".to_owned()].into_iter().chain(words).collect::<Vec<_>>().join(" ")
}

/// A word, quoted if a shell would split or change it.
pub(crate) fn quoted(word: &str) -> String {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./=:,+@%".contains(letter);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn a_shell_reads_every_word_as_one() {
        assert_eq!(quoted("no_hull/trial-1.wav"), "no_hull/trial-1.wav");
        assert_eq!(quoted("it's $HOME"), "'it'\\''s $HOME'");
        assert_eq!(quoted(""), "''");
    }
}
