//! Names of recordings for titles: the file without its folders, as far as that is unique. Names of rotors in tables.

/// One short name for each path, in order: the last part, with as many folders before it as make it unlike all other paths in `paths`.
pub fn short_names(paths: &[&str]) -> Vec<String> {
    paths
        .iter()
        .map(|path| {
            let parts: Vec<&str> = path.split(['/', '\\']).filter(|part| !part.is_empty()).collect();
            let with = |count: usize| parts[parts.len().saturating_sub(count)..].join("/");
            let is_unique = |name: &String| {
                let ends = |other: &&&str| other.ends_with(name.as_str()) && other != &path;
                !paths.iter().any(|other| ends(&other) && is_whole_part(other, name))
            };
            (1..parts.len()).map(with).find(is_unique).unwrap_or_else(|| with(parts.len().max(1)))
        })
        .collect()
}

/// The label of a rotor in a table. Without any label it is its number in the order of the speeds, which beside labels would be taken for the number
/// of a motor.
pub(crate) fn rotor_name(label: Option<&str>, has_labels: bool, index: usize) -> String {
    match label {
        Some(label) => format!("  {label}"),
        None if has_labels => "  not named".to_owned(),
        None if index == 0 => "  rotor 1, the fastest".to_owned(),
        None => format!("  rotor {}", index + 1),
    }
}

/// Whether a name begins at a folder's border of the path that ends with it.
fn is_whole_part(path: &str, name: &str) -> bool {
    let before = path.strip_suffix(name).unwrap_or_default();
    before.is_empty() || before.ends_with(['/', '\\'])
}

#[cfg(test)]
mod tests {
    use super::{rotor_name, short_names};

    #[test]
    fn a_rotor_without_a_label_has_no_number_beside_labels() {
        let names = |labels: [Option<&str>; 3]| {
            let has_labels = labels.iter().any(Option::is_some);
            let named = labels.into_iter().enumerate();
            named.map(|(index, label)| rotor_name(label, has_labels, index)).collect::<Vec<_>>()
        };
        assert_eq!(names([Some("motor 3"), None, Some("motor 1")]), ["  motor 3", "  not named", "  motor 1"]);
        assert_eq!(names([None; 3]), ["  rotor 1, the fastest", "  rotor 2", "  rotor 3"]);
    }

    #[test]
    fn names_are_as_short_as_they_are_unique() {
        let names = short_names(&["a/no_hull/trial_1.wav", "a/no_hull/trial_2.wav", "/x/y.mov", "trial_12.wav"]);
        assert_eq!(names, ["trial_1.wav", "trial_2.wav", "y.mov", "trial_12.wav"]);
        assert_eq!(short_names(&["a/b/1.wav", "a/c/1.wav", "11.wav"]), ["b/1.wav", "c/1.wav", "11.wav"]);
        assert_eq!(short_names(&["1.wav", "a/1.wav"]), ["1.wav", "a/1.wav"]);
        assert_eq!(short_names(&["C:\\sound\\1.wav"]), ["1.wav"]);
    }
}
