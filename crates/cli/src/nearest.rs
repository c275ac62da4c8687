//! "Did you mean …?"

use std::fs;
use std::path::Path;

/// Names with a lower similarity are not suggested.
const LIKENESS_MIN: f64 = 0.5;

/// The name of the file beside a missing one whose name is most like it; `None` where the file is there.
pub(crate) fn meant_file(path: &Path) -> Option<String> {
    let typed = path.file_name().filter(|_| !path.exists())?.to_str()?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let names: Vec<String> =
        fs::read_dir(folder).ok()?.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
    nearest(typed, names.iter().map(String::as_str)).map(str::to_owned)
}

/// The known name with the highest similarity to the typed one, if any is similar.
pub(crate) fn nearest<'a>(typed: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let typed = typed.to_lowercase();
    let likeness = |name: &str| strsim::normalized_damerau_levenshtein(&typed, &name.to_lowercase());
    let (likeness, name) = names.into_iter().map(|name| (likeness(name), name)).max_by(|a, b| a.0.total_cmp(&b.0))?;
    (likeness >= LIKENESS_MIN).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::{meant_file, nearest};
    use std::fs;

    #[test]
    fn a_file_that_is_not_there_was_meant_to_be_the_one_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("hover1.wav"), "").unwrap();
        assert_eq!(meant_file(&folder.path().join("hovr1.wav")).as_deref(), Some("hover1.wav"));
        assert_eq!(meant_file(&folder.path().join("hover1.wav")), None);
        assert_eq!(meant_file(&folder.path().join("loads.csv")), None);
    }

    #[test]
    fn slips_are_understood_and_nonsense_is_not() {
        let names = ["ardrone", "crazyflie", "bebop2"];
        assert_eq!(nearest("crazyfly", names), Some("crazyflie"));
        assert_eq!(nearest("ARDrone", names), Some("ardrone"));
        assert_eq!(nearest("lode", ["vehicle", "load"]), Some("load"));
        assert_eq!(nearest("submarine", names), None);
    }
}
