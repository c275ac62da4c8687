//! A table as lines of text: aligned columns, folded to the width of a terminal.

use crate::number::DASH;
use crate::printable::{printable, width_of, wrapped};
use crate::text_table::{Row, TextTable};
use std::fmt;
use std::iter::zip;

/// Text between two columns.
const GAP: &str = "  ";
/// Fewest columns of the screen for the first column.
const FIRST_WIDTH_MIN: usize = 8;
/// Fewest columns of the screen for words that are wrapped.
const WORDS_WIDTH_MIN: usize = 20;

/// Titles, units, a rule and the rows. Each line ends with a line feed, and no line ends with a space.
///
/// A table that is wider than `width` columns of the screen is folded: each part has the first column and as many others as fit. Words in the
/// last column of a part are wrapped.
pub fn table_text(table: &TextTable, width: Option<usize>) -> String {
    let table = Shown::of(table).narrowed(width);
    let parts = width.map_or_else(|| vec![(1..table.heads.len()).collect()], |width| table.parts(width));
    // rows of words stand in the first part alone, and a part of gaps alone tells nothing
    let tells = |index: &usize, row: &Row| match row {
        Row::Cells(cells) => cells.get(*index).is_some_and(|cell| !cell.is_empty() && cell != DASH),
        Row::Words(..) => false,
    };
    let has_cells = |part: &[usize]| part.iter().any(|index| table.rows.iter().any(|row| tells(index, row)));
    let shown = parts.iter().enumerate().filter(|(index, part)| *index == 0 || has_cells(part));
    let texts: Vec<String> = shown.map(|(index, others)| table.part(others, width, index == 0)).collect();
    texts.join("\n")
}

/// A table without a limit of its width.
impl fmt::Display for TextTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&table_text(self, None))
    }
}

/// Title, unit and side of a column.
struct Head {
    title: String,
    unit: String,
    is_number: bool,
    width: usize,
}

/// A table with printable cells, and the widths of its columns.
struct Shown {
    heads: Vec<Head>,
    rows: Vec<Row>,
}

impl Shown {
    fn of(table: &TextTable) -> Self {
        let printed = |row: &Row| match row {
            Row::Cells(cells) => Row::Cells(cells.iter().map(|cell| printable(cell)).collect()),
            Row::Words(first, words) => Row::Words(printable(first), printable(words)),
        };
        let rows: Vec<Row> = table.rows().iter().map(printed).collect();
        let widest = |index: usize| {
            let of_row = |row: &Row| match row {
                Row::Cells(cells) => cells.get(index).map_or(0, |cell| width_of(cell)),
                Row::Words(first, _) if index == 0 => width_of(first),
                Row::Words(..) => 0,
            };
            rows.iter().map(of_row).max().unwrap_or(0)
        };
        let head = |(index, column): (usize, &crate::text_table::Column)| {
            let (title, unit) = (printable(column.title()), printable(column.unit()));
            let width = width_of(&title).max(width_of(&unit)).max(widest(index));
            Head { title, unit, is_number: column.is_number(), width }
        };
        Self { heads: table.columns().iter().enumerate().map(head).collect(), rows }
    }

    /// With a first column of at most half the width, where it leaves no room for another column beside it. Its longer cells then stand on
    /// lines of their own.
    fn narrowed(mut self, width: Option<usize>) -> Self {
        let Some(width) = width else { return self };
        let last = self.heads.len().saturating_sub(1);
        let least = |(index, head): (usize, &Head)| {
            if index == last && !head.is_number { head.width.min(WORDS_WIDTH_MIN) } else { head.width }
        };
        let widest = self.heads.iter().enumerate().skip(1).map(least).max().unwrap_or(0);
        if let Some(first) = self.heads.first_mut().filter(|first| first.width + GAP.len() + widest > width) {
            first.width = first.width.min(width.saturating_sub(GAP.len() + widest).max(FIRST_WIDTH_MIN));
        }
        self
    }

    /// For each part, its columns beside the first.
    fn parts(&self, width: usize) -> Vec<Vec<usize>> {
        let first = self.heads.first().map_or(0, |head| head.width);
        let mut parts: Vec<Vec<usize>> = vec![Vec::new()];
        let mut used = first;
        for (index, head) in self.heads.iter().enumerate().skip(1) {
            let is_last_of_words = !head.is_number && index + 1 == self.heads.len();
            let least = if is_last_of_words { head.width.min(WORDS_WIDTH_MIN) } else { head.width };
            let is_full = parts.last().is_some_and(|part| !part.is_empty());
            if used + GAP.len() + least > width && is_full {
                parts.push(Vec::new());
                used = first;
            }
            used += GAP.len() + head.width;
            if let Some(part) = parts.last_mut() {
                part.push(index);
            }
        }
        parts
    }

    fn part(&self, others: &[usize], width: Option<usize>, is_first: bool) -> String {
        let columns: Vec<(usize, &Head)> =
            self.heads.iter().enumerate().filter(|(index, _)| *index == 0 || others.contains(index)).collect();
        let before = |count: usize| columns.iter().take(count).map(|(_, head)| head.width + GAP.len()).sum::<usize>();
        let last_width = width.map(|width| width.saturating_sub(before(columns.len().saturating_sub(1))));
        let mut text = line(&columns, |index| self.heads[index].title.as_str(), None);
        if columns.iter().any(|(_, head)| !head.unit.is_empty()) {
            text += &line(&columns, |index| self.heads[index].unit.as_str(), None);
        }
        let total = before(columns.len()).saturating_sub(GAP.len());
        text += &format!("{}\n", "─".repeat(width.map_or(total, |width| total.min(width))));
        for row in &self.rows {
            match row {
                Row::Cells(cells) => {
                    text += &line(&columns, |index| cells.get(index).map_or("", String::as_str), last_width);
                }
                Row::Words(first, words) if is_first => text += &self.words(first, words, width),
                Row::Words(..) => {}
            }
        }
        text
    }

    /// The first cell, and text across all others.
    fn words(&self, first: &str, words: &str, width: Option<usize>) -> String {
        let indent = self.heads.first().map_or(0, |head| head.width) + GAP.len();
        let lines = match width {
            Some(width) => wrapped(words, width.saturating_sub(indent).max(WORDS_WIDTH_MIN)),
            None => vec![words.to_owned()],
        };
        let is_long = width_of(first) + GAP.len() > indent;
        let space = if is_long { format!("\n{}", " ".repeat(indent)) } else { " ".repeat(indent - width_of(first)) };
        let text = lines.join(&format!("\n{}", " ".repeat(indent)));
        format!("{}\n", format!("{first}{space}{text}").trim_end())
    }
}

/// A line of padded cells. A first cell that is wider than its column stands on a line of its own above the others.
fn line<'a>(columns: &[(usize, &Head)], cell: impl Fn(usize) -> &'a str, last_width: Option<usize>) -> String {
    match columns.first() {
        Some((first, head)) if width_of(cell(*first)) > head.width => {
            let others = |index: usize| if index == *first { "" } else { cell(index) };
            format!("{}\n{}", cell(*first), padded_line(columns, others, last_width))
        }
        _ => padded_line(columns, cell, last_width),
    }
}

/// A line of padded cells. Words in the last column are wrapped to `last_width`.
fn padded_line<'a>(columns: &[(usize, &Head)], cell: impl Fn(usize) -> &'a str, last_width: Option<usize>) -> String {
    let padded = |(index, head): &(usize, &Head)| {
        let (text, space) = (cell(*index), " ".repeat(head.width.saturating_sub(width_of(cell(*index)))));
        if head.is_number { format!("{space}{text}") } else { format!("{text}{space}") }
    };
    let cells: Vec<String> = columns.iter().map(padded).collect();
    let whole = cells.join(GAP);
    let (Some(limit), Some((index, head))) = (last_width, columns.last()) else {
        return format!("{}\n", whole.trim_end());
    };
    if head.is_number || columns.len() < 2 || width_of(cell(*index)) <= limit.max(WORDS_WIDTH_MIN) {
        return format!("{}\n", whole.trim_end());
    }
    let begin = cells[..cells.len() - 1].join(GAP) + GAP;
    let lines = wrapped(cell(*index), limit.max(WORDS_WIDTH_MIN));
    zip(std::iter::once(begin.clone()).chain(std::iter::repeat(" ".repeat(width_of(&begin)))), lines)
        .map(|(begin, words)| format!("{begin}{words}\n"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text_table::Column;

    fn table() -> TextTable {
        let mut table = TextTable::new(vec![
            Column::words("file"),
            Column::numbers("speed", "rev/s"),
            Column::numbers("spread", "rev/s"),
            Column::words("because"),
        ]);
        table.push(vec!["a.wav".into(), "60.17".into(), "0.3".into(), "six words that say why here".into()]);
        table.push(vec!["long name.wav".into(), "1.5 ± 0.2".into(), "0.1".into(), "short".into()]);
        table
    }

    #[test]
    fn columns_are_aligned_and_lines_end_without_spaces() {
        let mut table = TextTable::new(vec![Column::words("file"), Column::numbers("speed", "rev/s")]);
        table.push(vec!["a.wav".to_owned(), "60.17".to_owned()]);
        table.push(vec!["long name.wav".to_owned(), "1.5 ± 0.2".to_owned()]);
        table.push_words("b.wav".to_owned(), "no rotor tone".to_owned());
        let expected = "\
file               speed
                   rev/s
────────────────────────
a.wav              60.17
long name.wav  1.5 ± 0.2
b.wav          no rotor tone
";
        assert_eq!(table.to_string(), expected);
        assert_eq!(table_text(&table, Some(80)), expected);
    }

    #[test]
    fn a_table_folds_to_the_width_and_loses_nothing() {
        for width in [38, 45, 60, 70] {
            let text = table_text(&table(), Some(width));
            assert!(text.lines().all(|line| width_of(line) <= width), "{width}:\n{text}");
            for word in "60.17 0.3 six words that say why here short".split(' ') {
                assert!(text.contains(word), "{width}, {word}:\n{text}");
            }
        }
        let folded = "\
file               speed  spread
                   rev/s   rev/s
────────────────────────────────
a.wav              60.17     0.3
long name.wav  1.5 ± 0.2     0.1

file           because
──────────────────────────────────────
a.wav          six words that say why
               here
long name.wav  short
";
        assert_eq!(table_text(&table(), Some(38)), folded);
    }

    #[test]
    fn a_part_without_a_cell_is_left_out() {
        let mut table = TextTable::new(table().columns().to_vec());
        table.push_words("b.wav".to_owned(), "no rotor tone".to_owned());
        let text = table_text(&table, Some(20));
        assert!(text.ends_with("no rotor tone\n") && text.matches("file").count() == 1, "{text}");
    }

    #[test]
    fn a_part_of_gaps_alone_is_left_out() {
        let mut table = TextTable::new(table().columns()[..3].to_vec());
        table.push(vec!["a rather long name.wav".to_owned(), "60.17".to_owned(), DASH.to_owned()]);
        let text = table_text(&table, Some(30));
        assert!(text.contains("60.17") && !text.contains("spread") && text.matches("file").count() == 1, "{text}");
        table.push(vec!["b.wav".to_owned(), "60.17".to_owned(), "0.3".to_owned()]);
        assert!(table_text(&table, Some(30)).contains("spread"));
    }

    #[test]
    fn a_long_first_cell_stands_alone_where_it_leaves_no_room() {
        let mut table = TextTable::new(vec![Column::words("file"), Column::numbers("speed", "rev/s")]);
        table.push(vec!["a/very/long/name/of/a.wav".to_owned(), "60.17 ± 0.12".to_owned()]);
        table.push_words("b.wav".to_owned(), "no rotor tone".to_owned());
        let expected = "\
file             speed
                 rev/s
──────────────────────
a/very/long/name/of/a.wav
          60.17 ± 0.12
b.wav     no rotor tone
";
        assert_eq!(table_text(&table, Some(22)), expected);
    }

    #[test]
    fn names_with_control_and_wide_letters_stay_in_their_column() {
        let mut table = TextTable::new(vec![Column::words("file"), Column::numbers("speed", "")]);
        table.push(vec!["a\u{1b}[2Jb\n.wav".to_owned(), "1".to_owned()]);
        table.push(vec!["漢字.wav".to_owned(), "2".to_owned()]);
        let text = table.to_string();
        assert!(!text.contains('\u{1b}') && text.lines().count() == 4, "{text}");
        let widths: Vec<usize> = text.lines().skip(2).map(width_of).collect();
        assert_eq!(widths[0], widths[1], "{text}");
    }
}
