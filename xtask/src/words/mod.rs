//! One term for one thing: no string, help text, page or document has an expression that the glossary forbids.

mod glossary;
mod prose;
mod texts;

use crate::tree::Tree;
use glossary::forbidden;
use prose::Prose;
use std::path::Path;
use texts::{README, Text, texts};

const GLOSSARY: &str = "docs/glossary.md";
/// A newcomer reads the README in five minutes.
const README_WORDS_MAX: usize = 1200;

/// Prints each forbidden expression with its file and line, and the words to use.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let glossary = std::fs::read_to_string(root.join(GLOSSARY)).map_err(|error| format!("{GLOSSARY}: {error}"))?;
    let forbidden = forbidden(&glossary)?;
    let texts = texts(root, &Tree::read(root)?)?;
    check_length(&texts)?;
    let mut count = 0;
    for text in &texts {
        let prose = Prose::of(&text.content, text.line);
        for expression in &forbidden {
            for line in prose.lines_with(&expression.phrase, &expression.allowed) {
                println!("{}:{line}: \"{}\": say {}", text.path, expression.phrase, expression.instead);
                count += 1;
            }
        }
    }
    match count {
        0 => {
            println!("{} texts have none of the {} forbidden expressions", texts.len(), forbidden.len());
            Ok(())
        }
        1 => Err(format!("1 forbidden expression; the list stands in {GLOSSARY}, \"Do not use\"")),
        _ => Err(format!("{count} forbidden expressions; the list stands in {GLOSSARY}, \"Do not use\"")),
    }
}

/// Refuses a README that is too long to be read.
fn check_length(texts: &[Text]) -> Result<(), String> {
    let readme =
        texts.iter().find(|text| text.path == README).ok_or_else(|| format!("{README} is not among the texts"))?;
    match readme.content.split_whitespace().count() {
        count if count > README_WORDS_MAX => Err(format!("{README} has {count} words, {README_WORDS_MAX} are allowed")),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn readme(words: usize) -> Text {
        Text { path: README.to_owned(), line: 1, content: "word\n".repeat(words) }
    }

    #[test]
    fn a_readme_that_is_too_long_or_missing_is_refused() {
        assert!(check_length(&[readme(README_WORDS_MAX)]).is_ok());
        assert!(check_length(&[readme(README_WORDS_MAX + 1)]).unwrap_err().contains("1201 words"));
        assert!(check_length(&[]).is_err());
    }

    /// The strings of the programs, the documents, and the README.
    #[test]
    fn the_readme_is_read() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let texts = texts(root, &Tree::read(root).unwrap()).unwrap();
        assert!(texts.iter().any(|text| text.path == README));
    }
}
