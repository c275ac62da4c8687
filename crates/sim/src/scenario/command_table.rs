//! Commands from the text of a CSV file.

use super::ScenarioError;
use hovertone_vehicle::Axis;

/// Commands over time; each row holds until the next row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CommandTable {
    times_s: Vec<f64>,
    /// A value for each axis that has a column.
    rows: Vec<[Option<f64>; 4]>,
}

impl CommandTable {
    /// Reads a table. Skips blank lines and lines that begin with `#`.
    pub(crate) fn parse(file: &str, text: &str) -> Result<Self, ScenarioError> {
        let fault = |line: usize, what: String| ScenarioError::CommandTable { file: file.to_owned(), line, what };
        let is_content = |line: &str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
        let mut lines = (1..).zip(text.trim_start_matches('\u{feff}').lines()).filter(|(_, line)| is_content(line));
        let (head_line, head) = lines.next().ok_or_else(|| fault(1, "the table is empty".to_owned()))?;
        let names: Vec<&str> = head.split(',').map(|name| name.trim().trim_matches('"')).collect();
        let column_of = |name: &str| names.iter().position(|known| *known == name);
        let of_axes = Axis::ALL.map(|axis| column_of(axis.name()));
        let known = |name: &str| name == "time_s" || Axis::ALL.iter().any(|axis| axis.name() == name);
        if let Some(unknown) = names.iter().find(|name| !known(name)) {
            let what = format!("unknown column {unknown:?}; known: time_s, roll, pitch, yaw_rate, climb");
            return Err(fault(head_line, what));
        }
        let time_column =
            column_of("time_s").ok_or_else(|| fault(head_line, "the column time_s is missing".to_owned()))?;
        if of_axes.iter().all(Option::is_none) {
            return Err(fault(
                head_line,
                "there is no column with a command: roll, pitch, yaw_rate or climb".to_owned(),
            ));
        }
        let mut table = Self { times_s: Vec::new(), rows: Vec::new() };
        for (number, line) in lines {
            let cells: Vec<&str> = line.split(',').map(str::trim).collect();
            let number_at = |column: usize| {
                let cell = cells.get(column).copied().unwrap_or("");
                let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
                value.ok_or_else(|| fault(number, format!("{cell:?} under {} is no number", names[column])))
            };
            let time_s = number_at(time_column)?;
            let earliest_s = table.times_s.last().copied().unwrap_or(0.0);
            if time_s < earliest_s || (time_s == earliest_s && !table.times_s.is_empty()) {
                return Err(fault(number, format!("time_s = {time_s} is not after {earliest_s}")));
            }
            let mut row = [None; 4];
            for (value, column) in row.iter_mut().zip(of_axes) {
                *value = column.map(number_at).transpose()?;
                if let Some(beyond) = value.filter(|value| value.abs() > 1.0) {
                    return Err(fault(number, format!("a command of {beyond} is beyond ±1")));
                }
            }
            table.times_s.push(time_s);
            table.rows.push(row);
        }
        if table.rows.is_empty() {
            return Err(fault(head_line, "the table has no row under its head".to_owned()));
        }
        Ok(table)
    }

    /// Time of the last row.
    pub(crate) fn end_s(&self) -> f64 {
        self.times_s.last().copied().unwrap_or(0.0)
    }

    /// The commands at a time from the start of the table; before its first row, no commands (the pilot flies).
    pub(crate) fn at(&self, time_s: f64) -> [Option<f64>; 4] {
        let after = self.times_s.partition_point(|row_s| *row_s <= time_s);
        after.checked_sub(1).map_or([None; 4], |row| self.rows[row])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_holds_until_the_next_and_other_axes_are_free() {
        let table = CommandTable::parse("c.csv", "# hand made\ntime_s, climb ,roll\n0.5,0.1,0\n1.5,-0.2,1\n").unwrap();
        assert_eq!(table.at(0.4), [None; 4]);
        assert_eq!(table.at(0.5), [Some(0.0), None, None, Some(0.1)]);
        assert_eq!(table.at(1.49), [Some(0.0), None, None, Some(0.1)]);
        assert_eq!(table.at(99.0), [Some(1.0), None, None, Some(-0.2)]);
        assert_eq!(table.end_s(), 1.5);
    }

    #[test]
    fn faults_name_their_line() {
        for (text, line, word) in [
            ("", 1, "empty"),
            ("time_s,rol\n0,0\n", 1, "rol"),
            ("roll\n0\n", 1, "time_s"),
            ("time_s\n0\n", 1, "no column with a command"),
            ("time_s,roll\n", 1, "no row"),
            ("time_s,roll\n0,0\n1,x\n", 3, "x"),
            ("time_s,roll\n1,0\n\n1,0.1\n", 4, "not after"),
            ("time_s,roll\n0,1.5\n", 2, "beyond"),
            ("time_s,roll\n0\n", 2, "roll"),
        ] {
            let error = CommandTable::parse("c.csv", text).unwrap_err();
            let ScenarioError::CommandTable { line: found, what, .. } = &error else { panic!("{error:?}") };
            assert!(*found == line && what.contains(word), "{text:?}: {error}");
        }
    }
}
