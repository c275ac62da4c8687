//! The forbidden expressions, from the table "Do not use" of the glossary.

/// The heading of the table.
const SECTION: &str = "## Do not use";
/// Columns of the table: word, its only use, the words to use instead, the phrases to look for, the phrases in which they are right.
const COLUMNS: usize = 5;

/// One forbidden expression.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Forbidden {
    /// Words in lower case; `…` stands for up to four words.
    pub(super) phrase: String,
    /// The words to use.
    pub(super) instead: String,
    /// Longer phrases in which it is right.
    pub(super) allowed: Vec<String>,
}

/// All phrases in backticks of the fourth column, with the words of the third and the phrases of the fifth.
///
/// # Errors
/// No such table, a row with another number of cells, no phrase at all.
pub(super) fn forbidden(glossary: &str) -> Result<Vec<Forbidden>, String> {
    let (_, section) =
        glossary.split_once(SECTION).ok_or_else(|| format!("the glossary has no section \"{SECTION}\""))?;
    let section = section.split("\n## ").next().unwrap_or(section);
    let mut all = Vec::new();
    for row in section.lines().filter(|line| line.starts_with('|')).skip(2) {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [_, _, instead, phrases, allowed] = cells.as_slice() else {
            return Err(format!("{} cells in place of {COLUMNS} in the glossary's row {row}", cells.len()));
        };
        let allowed = in_backticks(allowed);
        all.extend(in_backticks(phrases).into_iter().map(|phrase| Forbidden {
            phrase,
            instead: (*instead).to_owned(),
            allowed: allowed.clone(),
        }));
    }
    if all.is_empty() { Err("the glossary forbids no expression".to_owned()) } else { Ok(all) }
}

/// The parts of a cell in backticks, in lower case.
fn in_backticks(cell: &str) -> Vec<String> {
    cell.split('`').skip(1).step_by(2).map(str::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str =
        "# Words\n## Do not use\n\n| word | only for | say | found | right in |\n|---|---|---|---|---|\n";

    #[test]
    fn each_phrase_has_the_words_to_use_and_where_it_is_right() {
        let glossary = format!(
            "{TABLE}| told apart | never | *separated* | `told apart`, `Tell … apart` | `told apart by name` |\n\n## Sources\n| `x` |"
        );
        let found = forbidden(&glossary).unwrap();
        let phrases: Vec<&str> = found.iter().map(|forbidden| forbidden.phrase.as_str()).collect();
        assert_eq!(phrases, ["told apart", "tell … apart"]);
        assert_eq!(
            (found[0].instead.as_str(), found[1].allowed.as_slice()),
            ("*separated*", &["told apart by name".into()][..])
        );
    }

    #[test]
    fn a_table_that_forbids_nothing_is_an_error() {
        assert!(forbidden("# Words").is_err() && forbidden(TABLE).is_err());
        assert!(forbidden(&format!("{TABLE}| told apart | never | `x` |\n")).is_err());
    }
}
