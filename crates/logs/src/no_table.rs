//! A text that is something else where a table is needed.

/// A text that is no table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoTable {
    /// Nothing in it.
    #[error("this file is empty")]
    Empty,
    /// JSON.
    #[error("this file is JSON and no table")]
    Json,
    /// TOML: an experiment or a scenario.
    #[error("this file is TOML and no table")]
    Toml,
    /// Rows of numbers without names above them.
    #[error("the first line of this table has numbers only, but it must name the columns")]
    NoHeader,
}

impl NoTable {
    /// Advice to the user.
    pub fn hint(self) -> &'static str {
        match self {
            Self::Empty => "copy or download the file again, or give another one",
            Self::Json => "give a CSV file whose first line names the columns",
            Self::NoHeader => {
                "write a first line with a name for each column: for `hovertone fit` as in speed_rpm,thrust_g; for a log as in time_s,rotor1_rpm"
            }
            Self::Toml => {
                "give a CSV file whose first line names the columns; `hovertone identify` takes an experiment file, `hovertone simulate` a scenario file"
            }
        }
    }

    /// Refuses a text whose beginning shows that it is no table.
    ///
    /// # Errors
    /// What the text is instead.
    pub fn check(text: &str) -> Result<(), Self> {
        let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
        match lines.next() {
            None if text.trim().is_empty() => Err(Self::Empty),
            Some(line) if is_toml(line) => Err(Self::Toml),
            Some(line) if line.starts_with(['{', '[']) => Err(Self::Json),
            Some(line) if are_numbers(line) => Err(Self::NoHeader),
            _ => Ok(()),
        }
    }
}

/// Whether all cells of a line are numbers, with decimal points or commas, and there are two or more.
fn are_numbers(line: &str) -> bool {
    let cells =
        || line.split([',', ';', '\t']).map(|cell| cell.trim().trim_matches('"')).filter(|cell| !cell.is_empty());
    cells().count() > 1 && cells().all(|cell| cell.parse::<f64>().is_ok_and(f64::is_finite))
}

/// Whether a line is `[name]`, `[[name]]` or `name = value`.
fn is_toml(line: &str) -> bool {
    let is_key = |name: &str| {
        let is_of_key = |letter: char| letter.is_ascii_alphanumeric() || "_-.".contains(letter);
        name.starts_with(|letter: char| letter.is_ascii_alphabetic()) && name.chars().all(is_of_key)
    };
    let in_brackets = line.trim_start_matches('[').trim_end_matches(']');
    let is_section = line.starts_with('[') && line.ends_with(']') && is_key(in_brackets.trim());
    is_section || line.split_once('=').is_some_and(|(name, _)| is_key(name.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_toml_and_nothing_are_no_tables() {
        for (text, expected) in [
            (" \n", Err(NoTable::Empty)),
            ("{\"a\": 1}", Err(NoTable::Json)),
            ("[1, 2]", Err(NoTable::Json)),
            ("# a comment\n\n[vehicle]\nblades = 2\n", Err(NoTable::Toml)),
            ("[[load]]", Err(NoTable::Toml)),
            ("duration_s = 20.0\n", Err(NoTable::Toml)),
            ("time_s,rotor1_rpm\n0,1\n", Ok(())),
            ("Time (s);Thrust [N]\n", Ok(())),
            ("# a comment alone\n", Ok(())),
            ("3600,1.2\n3700,1.3\n", Err(NoTable::NoHeader)),
            ("3600,5;1,2\n", Err(NoTable::NoHeader)),
            ("rpm,1\n3600,2\n", Ok(())),
        ] {
            assert_eq!(NoTable::check(text), expected, "{text}");
        }
    }
}
