//! What can be typed after the name of an exam.

use std::str::FromStr;

/// The whole number after an option.
pub(crate) fn whole_number<N: FromStr>(option: &str, value: &str) -> Result<N, String> {
    value.parse().map_err(|_| format!("{option} {value}: not a whole number"))
}
