//! Points that separate thousands.

/// Whether a point may separate thousands, as in "1.000" and "12.500", which is 12500 where commas are decimal.
pub fn has_thousands_point(cell: &[u8]) -> bool {
    let mut groups = cell.split(|byte| *byte == b'.');
    let are_digits = |group: &[u8]| group.iter().all(u8::is_ascii_digit);
    let is_first = |group: &[u8]| (1..=3).contains(&group.len()) && are_digits(group) && group[0] != b'0';
    let has_point = cell.contains(&b'.');
    has_point && groups.next().is_some_and(is_first) && groups.all(|group| group.len() == 3 && are_digits(group))
}

#[cfg(test)]
mod tests {
    use super::has_thousands_point;

    #[test]
    fn groups_of_three_digits_are_thousands() {
        for (cell, expected) in [
            ("1.000", true),
            ("12.500.000", true),
            ("0.125", false),
            ("1.25", false),
            ("1000", false),
            ("1.000,5", false),
        ] {
            assert_eq!(has_thousands_point(cell.as_bytes()), expected, "{cell}");
        }
    }
}
