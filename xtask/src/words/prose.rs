//! A text as words with their lines, and phrases in it.

/// Most words that `…` stands for.
const BETWEEN_MAX: usize = 4;
const BETWEEN: &str = "…";

struct Word {
    /// In lower case, without punctuation around it.
    letters: String,
    line: usize,
    /// Whether punctuation after it ends a phrase.
    is_last: bool,
}

/// The words of a text.
pub(super) struct Prose {
    words: Vec<Word>,
}

impl Prose {
    /// The words of a text that begins on a line.
    pub(super) fn of(text: &str, first_line: usize) -> Self {
        let of_line = |(index, line): (usize, &str)| -> Vec<Word> {
            line.split_whitespace().map(|word| Word::of(word, first_line + index)).collect()
        };
        Self { words: text.lines().enumerate().flat_map(of_line).collect() }
    }

    /// The lines on which a phrase begins, without those where it is part of an allowed phrase.
    pub(super) fn lines_with(&self, phrase: &str, allowed: &[String]) -> Vec<usize> {
        let right: Vec<std::ops::Range<usize>> = allowed.iter().flat_map(|phrase| self.places(phrase)).collect();
        let is_right = |place: &std::ops::Range<usize>| {
            right.iter().any(|right| right.start <= place.start && place.end <= right.end)
        };
        let wrong = self.places(phrase).into_iter().filter(|place| !is_right(place));
        wrong.filter_map(|place| self.words.get(place.start)).map(|word| word.line).collect()
    }

    /// Where a phrase stands, as ranges of words.
    fn places(&self, phrase: &str) -> Vec<std::ops::Range<usize>> {
        let phrase: Vec<&str> = phrase.split_whitespace().collect();
        let end_of = |start: usize| self.end(start, &phrase).map(|end| start..end);
        (0..self.words.len()).filter_map(end_of).collect()
    }

    /// The end of a phrase that begins at a word.
    fn end(&self, start: usize, phrase: &[&str]) -> Option<usize> {
        let Some((&first, others)) = phrase.split_first() else { return Some(start) };
        if first == BETWEEN {
            return (start..=start + BETWEEN_MAX)
                .take_while(|&at| at == start || self.words.get(at - 1).is_some_and(|word| !word.is_last))
                .find_map(|at| self.end(at, others));
        }
        let word = self.words.get(start).filter(|word| word.letters == first)?;
        if word.is_last && !others.is_empty() { None } else { self.end(start + 1, others) }
    }
}

impl Word {
    fn of(word: &str, line: usize) -> Self {
        let is_mark = |letter: char| !letter.is_alphanumeric();
        // a placeholder is not the word that names it
        let letters = if word.contains('{') { String::new() } else { word.trim_matches(is_mark).to_lowercase() };
        let is_last = word.ends_with(['.', ',', ';', ':', '!', '?', ')', '|', '"']);
        Self { letters, line, is_last }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str, phrase: &str, allowed: &[&str]) -> Vec<usize> {
        let allowed: Vec<String> = allowed.iter().map(|phrase| (*phrase).to_owned()).collect();
        Prose::of(text, 10).lines_with(phrase, &allowed)
    }

    #[test]
    fn a_phrase_is_found_across_lines_and_as_whole_words() {
        assert_eq!(lines("They are\ntold\napart.", "told apart", &[]), [11]);
        assert_eq!(lines("(Told apart)", "told apart", &[]), [10]);
        assert!(lines("untold apart; told, apart; told-apart", "told apart", &[]).is_empty());
        assert!(lines("{what} is missing", "what is", &[]).is_empty());
    }

    #[test]
    fn some_words_may_stand_between() {
        assert_eq!(lines("it tells the four rotors apart", "tells … apart", &[]), [10]);
        assert_eq!(lines("it tells apart", "tells … apart", &[]), [10]);
        assert!(lines("it tells one two three four five apart", "tells … apart", &[]).is_empty());
        assert!(lines("so it tells. Two stand apart", "tells … apart", &[]).is_empty());
    }

    #[test]
    fn a_phrase_is_right_in_an_allowed_one() {
        assert_eq!(lines("what is more, what is new", "what is", &["what is more"]), [10]);
    }
}
