//! Why cases are not right, as a person found: a table kept by hand.

use super::judgement::Verdict;
use super::rows::Row;
use std::fs;
use std::path::Path;

/// The table, in the repository: one line for each file and mode.
pub(super) const TABLE: &str = "crates/bench/src/real/causes.csv";
/// Stands for every mode of a file.
const ANY_MODE: &str = "*";

/// The table of causes.
pub(super) struct Causes {
    entries: Vec<Entry>,
}

struct Entry {
    file: String,
    mode: String,
    cause: String,
}

impl Entry {
    fn is_of(&self, row: &Row) -> bool {
        self.file == row.file_name() && (self.mode == row.mode || self.mode == ANY_MODE)
    }
}

impl Causes {
    pub(super) fn read(root: &Path) -> Result<Self, String> {
        let text = fs::read_to_string(root.join(TABLE)).map_err(|error| format!("{TABLE}: {error}"))?;
        Self::from_csv(&text)
    }

    /// A line of heads, then `file,mode,cause`; the cause may hold commas.
    fn from_csv(text: &str) -> Result<Self, String> {
        let lines = text.lines().enumerate().skip(1).filter(|(_, line)| !line.trim().is_empty());
        let entries = lines.map(|(index, line)| {
            let cells: Vec<&str> = line.splitn(3, ',').map(str::trim).collect();
            match cells.as_slice() {
                [file, mode, cause] if !cause.is_empty() => {
                    Ok(Entry { file: (*file).to_owned(), mode: (*mode).to_owned(), cause: (*cause).to_owned() })
                }
                _ => Err(format!("{TABLE}:{}: a line is `file,mode,cause`", index + 1)),
            }
        });
        Ok(Self { entries: entries.collect::<Result<_, _>>()? })
    }

    #[cfg(test)]
    pub(super) fn for_test(text: &str) -> Self {
        Self::from_csv(text).unwrap()
    }

    /// The cause of a case; empty where no one knows it. A line for the mode wins over one for all modes.
    pub(super) fn of(&self, row: &Row) -> &str {
        let entries = || self.entries.iter().filter(|entry| entry.is_of(row));
        let exact = entries().find(|entry| entry.mode != ANY_MODE);
        exact.or_else(|| entries().next()).map_or("", |entry| entry.cause.as_str())
    }

    /// Lines whose cases are all right by now, or that name no case.
    pub(super) fn stale(&self, rows: &[Row]) -> Vec<String> {
        let is_wanted = |entry: &&Entry| rows.iter().any(|row| row.verdict != Verdict::Right && entry.is_of(row));
        let stale = self.entries.iter().filter(|entry| !is_wanted(entry));
        stale.map(|entry| format!("{},{}", entry.file, entry.mode)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Causes;
    use crate::real::judgement::Verdict;
    use crate::real::rows::Row;
    use crate::real::rows::tests::row;

    const TABLE: &str = "file,mode,cause\na.wav,blades,\"b, c\na.wav,*,any\nold.wav,blind,gone\n";

    #[test]
    fn the_mode_wins_over_all_modes() {
        let causes = Causes::from_csv(TABLE).unwrap();
        assert_eq!(causes.of(&row("c", "blades", Verdict::Wrong)), "\"b, c");
        assert_eq!(causes.of(&row("c", "blind", Verdict::Wrong)), "any");
        let other = Row { file: "real/b.wav".to_owned(), ..row("c", "blind", Verdict::Wrong) };
        assert_eq!(causes.of(&other), "");
    }

    #[test]
    fn lines_that_explain_nothing_are_named() {
        let causes = Causes::from_csv(TABLE).unwrap();
        assert_eq!(causes.stale(&[row("c", "blades", Verdict::Octave)]), ["old.wav,blind"]);
        assert_eq!(causes.stale(&[row("c", "blades", Verdict::Right)]).len(), 3);
        assert!(Causes::from_csv("file,mode,cause\na.wav,blades\n").err().unwrap().contains(":2:"));
    }
}
