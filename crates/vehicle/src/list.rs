//! Lists in messages.

/// "a, b and c", with `last` as the word before the last one; nothing for none.
pub fn in_list(words: &[impl AsRef<str>], last: &str) -> String {
    let words: Vec<&str> = words.iter().map(AsRef::as_ref).collect();
    match words.split_last() {
        None => String::new(),
        Some((only, [])) => (*only).to_owned(),
        Some((end, others)) => format!("{} {last} {end}", others.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_one_stands_behind_a_word() {
        let none: [&str; 0] = [];
        assert_eq!(in_list(&none, "and"), "");
        assert_eq!(in_list(&["a"], "and"), "a");
        assert_eq!(in_list(&["a", "b"], "or"), "a or b");
        assert_eq!(in_list(&["a".to_owned(), "b".to_owned(), "c".to_owned()], "and"), "a, b and c");
    }
}
