//! Separators and numbers of a CSV.

use crate::{LogError, NoTable, has_thousands_point};
use std::borrow::Cow;

/// Most characters of a number whose digits, without the point, are a whole number that a float holds.
const PLAIN_DIGITS_MAX: usize = 16;
/// Powers of ten that a float holds.
const POWERS: [f64; PLAIN_DIGITS_MAX + 1] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16];

/// How the cells of a CSV are written.
#[derive(Clone, Copy, Debug)]
pub struct CsvCells {
    delimiter: u8,
    /// Whether "3,5" is a number.
    has_decimal_commas: bool,
}

impl CsvCells {
    /// From the first bytes of a file.
    ///
    /// # Errors
    /// No text, or one that is no table.
    pub(super) fn of_head(head: &[u8]) -> Result<Self, LogError> {
        let text = text_of(head);
        let text = text.trim_start_matches('\u{feff}');
        NoTable::check(text)?;
        Ok(Self::of_text(text))
    }

    /// From a text that begins with its header. The separator is the most frequent candidate of the first line. Commas are decimal commas where a
    /// cell proves it: "3,5". Lines that begin with # are skipped.
    pub fn of_text(text: &str) -> Self {
        let first_line = text.lines().find(|line| !line.starts_with('#')).unwrap_or_default();
        let count = |delimiter: &u8| first_line.bytes().filter(|byte| byte == delimiter).count();
        // with equal counts the last candidate wins
        let delimiter = [b'\t', b';', b','].into_iter().max_by_key(count).unwrap_or(b',');
        let cells = Self { delimiter, has_decimal_commas: false };
        // where commas separate, a cell with a comma has quotes
        if delimiter == b',' && !text.contains('"') {
            return cells;
        }
        let records = cells.reader().from_reader(text.as_bytes()).into_byte_records();
        let has_decimal_commas = records.map_while(Result::ok).any(|record| record.iter().any(is_decimal_comma));
        Self { has_decimal_commas, ..cells }
    }

    /// A reader of such cells; rows may differ in length.
    pub fn reader(&self) -> csv::ReaderBuilder {
        let mut builder = csv::ReaderBuilder::new();
        builder.delimiter(self.delimiter).flexible(true).comment(Some(b'#'));
        builder
    }

    /// The finite number in a cell.
    pub fn number(&self, cell: &[u8]) -> Option<f64> {
        let cell = cell.trim_ascii();
        if self.has_decimal_commas && has_thousands_point(cell) {
            return None;
        }
        if let Some(number) = plain_number(cell) {
            return Some(number);
        }
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

/// The number of digits with at most one point between them: exact, since both parts of the quotient are. `None` for all other numbers.
fn plain_number(cell: &[u8]) -> Option<f64> {
    let (is_negative, digits) = match cell.split_first()? {
        (b'-', digits) => (true, digits),
        _ => (false, cell),
    };
    if !digits.first()?.is_ascii_digit() || digits.len() > PLAIN_DIGITS_MAX {
        return None;
    }
    let (mut whole, mut decimals, mut has_point) = (0_u64, 0, false);
    for byte in digits {
        match byte {
            b'0'..=b'9' => {
                whole = 10 * whole + u64::from(byte - b'0');
                decimals += usize::from(has_point);
            }
            b'.' if !has_point => has_point = true,
            _ => return None,
        }
    }
    let number = whole as f64 / POWERS[decimals];
    Some(if is_negative { -number } else { number })
}

/// Whether a cell says that there is no number.
pub(super) fn is_gap(cell: &[u8]) -> bool {
    let cell = cell.trim_ascii();
    cell.is_empty() || cell.eq_ignore_ascii_case(b"nan")
}

/// Whether the comma of a cell cannot separate thousands: "3,5" and "0,511", not "3,610".
fn is_decimal_comma(cell: &[u8]) -> bool {
    let cell = cell.trim_ascii();
    let Some(comma) = cell.iter().position(|byte| *byte == b',') else { return false };
    let (whole, part) = (&cell[..comma], &cell[comma + 1..]);
    let whole = whole.strip_prefix(b"-").or(whole.strip_prefix(b"+")).unwrap_or(whole);
    let are_digits = |digits: &[u8]| !digits.is_empty() && digits.iter().all(u8::is_ascii_digit);
    are_digits(whole) && are_digits(part) && (part.len() != 3 || whole.len() > 3 || whole.starts_with(b"0"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_numbers_are_as_the_library_reads_them() {
        for text in ["0", "-0.5", "3.14159", "16.800334930419", "123456789012345", "0.00000001", "12.", "-7"] {
            assert_eq!(plain_number(text.as_bytes()), text.parse().ok(), "{text}");
        }
        let random = (1_u64..2000).map(|at| at.wrapping_mul(6_364_136_223_846_793_005) >> 20);
        for number in random {
            let text = format!("{}.{:07}", number >> 24, number & 0xf_ffff);
            assert_eq!(plain_number(text.as_bytes()).unwrap(), text.parse::<f64>().unwrap(), "{text}");
        }
        for text in ["", "-", ".5", "1e3", "1.2.3", "+1", "inf", "12345678901234567", "1,5"] {
            assert_eq!(plain_number(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn a_comma_is_a_decimal_one_only_where_it_cannot_separate_thousands() {
        for (cell, expected) in
            [("3,5", true), ("-0,25", true), ("0,511", true), ("3610,343", true), ("3,610", false), ("a,b", false)]
        {
            assert_eq!(is_decimal_comma(cell.as_bytes()), expected, "{cell}");
        }
    }
}
