//! Separators and numbers of a CSV.

use crate::LogError;
use std::borrow::Cow;
use std::io::Read;

/// How the cells of a CSV are written.
pub(super) struct Cells {
    delimiter: u8,
    /// Whether "3,5" is a number.
    has_decimal_commas: bool,
}

impl Cells {
    /// From the first bytes of a file. The separator is the most frequent candidate of the first line. Commas are decimal commas where a cell
    /// proves it.
    ///
    /// # Errors
    /// No text, or JSON.
    pub(super) fn of_head(head: &[u8]) -> Result<Self, LogError> {
        let text = text_of(head);
        let text = text.trim_start_matches('\u{feff}');
        if text.trim().is_empty() {
            return Err(LogError::Empty);
        }
        if text.trim_start().starts_with(['{', '[']) {
            return Err(LogError::Json);
        }
        let first_line = text.lines().find(|line| !line.starts_with('#')).unwrap_or_default();
        let count = |delimiter: &u8| first_line.bytes().filter(|byte| byte == delimiter).count();
        // with equal counts the last candidate wins
        let delimiter = [b'\t', b';', b','].into_iter().max_by_key(count).unwrap_or(b',');
        let cells = Self { delimiter, has_decimal_commas: false };
        let records = cells.reader(text.as_bytes()).into_byte_records();
        let has_decimal_commas = records.map_while(Result::ok).any(|record| record.iter().any(is_decimal_comma));
        Ok(Self { has_decimal_commas, ..cells })
    }

    pub(super) fn reader<R: Read>(&self, source: R) -> csv::Reader<R> {
        csv::ReaderBuilder::new()
            .delimiter(self.delimiter)
            .trim(csv::Trim::All)
            .flexible(true)
            .comment(Some(b'#'))
            .from_reader(source)
    }

    /// The finite number in a cell.
    pub(super) fn number(&self, cell: &[u8]) -> Option<f64> {
        let text = std::str::from_utf8(cell).ok()?;
        let number: f64 = if self.has_decimal_commas && cell.contains(&b',') && !cell.contains(&b'.') {
            text.replacen(',', ".", 1).parse().ok()?
        } else {
            text.parse().ok()?
        };
        number.is_finite().then_some(number)
    }
}

/// Text of a cell.
pub(super) fn text_of(cell: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(cell)
}

/// Whether a cell says that there is no number.
pub(super) fn is_gap(cell: &[u8]) -> bool {
    cell.is_empty() || cell.eq_ignore_ascii_case(b"nan")
}

/// Whether the comma of a cell cannot separate thousands: "3,5", not "3,610".
fn is_decimal_comma(cell: &[u8]) -> bool {
    let Some(comma) = cell.iter().position(|byte| *byte == b',') else { return false };
    let (whole, part) = (&cell[..comma], &cell[comma + 1..]);
    let whole = whole.strip_prefix(b"-").or(whole.strip_prefix(b"+")).unwrap_or(whole);
    let are_digits = |digits: &[u8]| !digits.is_empty() && digits.iter().all(u8::is_ascii_digit);
    are_digits(whole) && are_digits(part) && (part.len() != 3 || whole.len() > 3)
}
