//! Numbers in messages.

/// Most digits of a number in a message; a longer number is rounded, or has an exponent. *Decision.*
const DIGITS_MAX: usize = 12;

/// A number as a person typed it: "0.413", and "1e300" in place of 300 zeros.
pub fn number_in_words(value: f64) -> String {
    let rounded = format!("{value:.*e}", DIGITS_MAX - 1);
    let plain = rounded.parse::<f64>().map_or(rounded, |rounded| rounded.to_string());
    let digits = plain.bytes().filter(u8::is_ascii_digit).count();
    match plain.parse::<f64>() {
        Ok(rounded) if digits > DIGITS_MAX => format!("{rounded:e}"),
        _ => plain,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_in_a_message_is_short() {
        for (value, words) in [
            (0.413, "0.413"),
            (0.1 + 0.2, "0.3"),
            (90000.0, "90000"),
            (1e9, "1000000000"),
            (-1.5e15, "-1.5e15"),
            (1e300, "1e300"),
            (1e-200, "1e-200"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(number_in_words(value), words);
        }
    }
}
