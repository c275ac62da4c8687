//! Whether the crates can be published: complete manifests, and packages that cargo accepts.

use crate::ci::cargo;
use std::fs;
use std::path::Path;
use toml::{Table, Value};

/// What a registry shows of a crate.
const NEEDED: [&str; 9] = [
    "description",
    "documentation",
    "license",
    "version",
    "edition",
    "rust-version",
    "readme",
    "keywords",
    "categories",
];
/// Crates for the development alone, and the package for Python, which pip builds.
const UNPUBLISHED: [&str; 6] = ["--exclude", "xtask", "--exclude", "hovertone-bench", "--exclude", "hovertone-python"];

/// Refuses manifests that a registry would refuse, or show without a word.
pub(super) fn check(root: &Path) -> Result<(), String> {
    let faults = faults(root)?;
    if faults.is_empty() { Ok(()) } else { Err(format!("not ready for publication:\n  {}", faults.join("\n  "))) }
}

/// The version of all crates.
pub(super) fn version(root: &Path) -> Result<String, String> {
    let workspace = manifest(&root.join("Cargo.toml"))?;
    let version = workspace.get("workspace").and_then(|table| table.get("package")?.get("version")?.as_str());
    version.map(str::to_owned).ok_or_else(|| "Cargo.toml: workspace.package.version is missing".to_owned())
}

/// Publishes every crate to nobody: packs it, and builds it from its package and from the packages of the crates that it uses.
pub(super) fn rehearse(root: &Path) -> Result<(), String> {
    println!("== packages");
    let publish = ["publish", "--dry-run", "--workspace", "--allow-dirty", "--locked"];
    cargo(root, &[&publish[..], &UNPUBLISHED[..]].concat(), &[])
}

fn faults(root: &Path) -> Result<Vec<String>, String> {
    let version = version(root)?;
    let workspace = manifest(&root.join("Cargo.toml"))?;
    let shared = workspace.get("workspace").and_then(|table| table.get("dependencies")?.as_table());
    let mut faults = Vec::new();
    for (name, dependency) in shared.into_iter().flatten().filter(|(_, dependency)| dependency.get("path").is_some()) {
        let stated = dependency.get("version").and_then(Value::as_str);
        if stated != Some(version.as_str()) {
            faults.push(format!("Cargo.toml: {name} needs version = \"{version}\" beside its path"));
        }
    }
    let crates = fs::read_dir(root.join("crates")).map_err(|error| format!("crates: {error}"))?;
    for folder in crates.filter_map(Result::ok).map(|entry| entry.path()) {
        let name = folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let table = manifest(&folder.join("Cargo.toml"))?;
        let package = table.get("package").and_then(Value::as_table).cloned().unwrap_or_default();
        // a crate for the development alone inherits the workspace's `publish = false`
        if package.contains_key("publish") {
            continue;
        }
        let missing = NEEDED.iter().filter(|key| !package.contains_key(**key));
        faults.extend(missing.map(|key| format!("crates/{name}/Cargo.toml: {key} is missing")));
    }
    faults.sort();
    Ok(faults)
}

fn manifest(path: &Path) -> Result<Table, String> {
    let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    text.parse().map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_crates_are_ready_for_publication() {
        assert_eq!(faults(&crate::root()).unwrap(), Vec::<String>::new());
    }

    #[test]
    fn what_a_registry_wants_is_named() {
        let root = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let path = root.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        write(
            "Cargo.toml",
            "[workspace.package]\nversion = \"1.2.3\"\n[workspace.dependencies]\nown = { path = \"crates/own\" }\nserde = \"1\"\n",
        );
        let all = NEEDED.map(|key| format!("{key}.workspace = true\n")).concat();
        write("crates/own/Cargo.toml", &format!("[package]\n{}", all.replace("readme.workspace = true\n", "")));
        write("crates/whole/Cargo.toml", &format!("[package]\n{all}"));
        write("crates/bench/Cargo.toml", "[package]\npublish.workspace = true\n");
        assert_eq!(
            faults(root.path()).unwrap(),
            ["Cargo.toml: own needs version = \"1.2.3\" beside its path", "crates/own/Cargo.toml: readme is missing"]
        );
    }
}
