//! "Did you mean …?"

use std::fs;
use std::path::{Path, PathBuf};

/// Names with a lower similarity are not suggested.
const LIKENESS_MIN: f64 = 0.5;

/// The name of the file of the same kind beside a missing one whose name is most like it; `None` where the file is there.
pub(crate) fn meant_file(path: &Path) -> Option<String> {
    // equal endings are no likeness
    let stem = |path: &Path| Some(path.file_stem()?.to_str()?.to_owned());
    let typed = stem(path).filter(|_| !path.exists())?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let is_of_kind = |file: &PathBuf| path.extension().is_none_or(|kind| file.extension() == Some(kind));
    let entries = fs::read_dir(folder).ok()?.filter_map(|entry| Some(entry.ok()?.path()));
    let files: Vec<PathBuf> = entries.filter(is_of_kind).collect();
    let stems: Vec<String> = files.iter().filter_map(|file| stem(file)).collect();
    let meant = nearest(&typed, stems.iter().map(String::as_str))?;
    let file = files.iter().find(|file| stem(file).is_some_and(|it| it == meant))?;
    Some(file.file_name()?.to_str()?.to_owned())
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
        fs::write(folder.path().join("hovr1.png"), "").unwrap();
        assert_eq!(meant_file(&folder.path().join("hovr1.wav")).as_deref(), Some("hover1.wav"));
        assert_eq!(meant_file(&folder.path().join("hover1.wav")), None);
        assert_eq!(meant_file(&folder.path().join("none.wav")), None);
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
