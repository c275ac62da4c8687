//! "Did you mean …?"

/// Names with a lower similarity are not suggested.
const LIKENESS_MIN: f64 = 0.5;

/// The known name with the highest similarity to the typed one, if any is similar.
pub(crate) fn nearest<'a>(typed: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let typed = typed.to_lowercase();
    let likeness = |name: &str| strsim::normalized_damerau_levenshtein(&typed, &name.to_lowercase());
    let (likeness, name) = names.into_iter().map(|name| (likeness(name), name)).max_by(|a, b| a.0.total_cmp(&b.0))?;
    (likeness >= LIKENESS_MIN).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn slips_are_understood_and_nonsense_is_not() {
        let names = ["ardrone", "crazyflie", "bebop2"];
        assert_eq!(nearest("crazyfly", names), Some("crazyflie"));
        assert_eq!(nearest("ARDrone", names), Some("ardrone"));
        assert_eq!(nearest("lode", ["vehicle", "load"]), Some("load"));
        assert_eq!(nearest("submarine", names), None);
    }
}
