//! One term for one thing: no string, help text, page or document has an expression that the glossary forbids.

mod glossary;
mod prose;
mod texts;

use crate::tree::Tree;
use glossary::forbidden;
use prose::Prose;
use std::path::Path;
use texts::texts;

const GLOSSARY: &str = "docs/glossary.md";

/// Prints each forbidden expression with its file and line, and the words to use.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let glossary = std::fs::read_to_string(root.join(GLOSSARY)).map_err(|error| format!("{GLOSSARY}: {error}"))?;
    let forbidden = forbidden(&glossary)?;
    let texts = texts(root, &Tree::read(root)?)?;
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
