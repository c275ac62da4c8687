//! A share of the frames in words.

/// "37 %"; "less than 1 %" for a share that would be printed as 0 %.
pub fn percent_in_words(share: f64) -> String {
    let percent = 100.0 * share;
    if percent < 1.0 { "less than 1 %".to_owned() } else { format!("{percent:.0} %") }
}

#[cfg(test)]
mod tests {
    use super::percent_in_words;

    #[test]
    fn a_small_share_is_not_printed_as_none() {
        assert_eq!([0.0, 0.004, 0.01, 0.371].map(percent_in_words), ["less than 1 %", "less than 1 %", "1 %", "37 %"]);
    }
}
