//! The licences of all crates that are part of the program, with their texts.

use super::spdx::is_allowed;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Beginnings of the names of files with a licence, in capitals.
const FILES: [&str; 6] = ["LICENSE", "LICENCE", "COPYING", "NOTICE", "UNLICENSE", "COPYRIGHT"];

/// A crate of other people.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Dependency {
    name: String,
    version: String,
    licence: String,
    place: String,
    authors: String,
    folder: String,
}

/// The text of the file of licences.
pub(super) fn text(root: &Path, triple: &str, package: &str) -> Result<String, String> {
    text_of(&dependencies(&metadata(root, triple)?, package)?)
}

fn metadata(root: &Path, triple: &str) -> Result<Value, String> {
    let output = Command::new("cargo")
        .args(["metadata", "--format-version", "1", "--locked", "--filter-platform", triple])
        .current_dir(root)
        .output()
        .map_err(|error| format!("cargo metadata: {error}"))?;
    if !output.status.success() {
        return Err(format!("cargo metadata failed: {}", String::from_utf8_lossy(&output.stderr).trim()));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| format!("cargo metadata: {error}"))
}

/// All crates from elsewhere that are linked into a package, in the order of their names.
fn dependencies(metadata: &Value, package: &str) -> Result<Vec<Dependency>, String> {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let packages: BTreeMap<String, Value> =
        list(&metadata["packages"]).into_iter().map(|package| (text(&package["id"]), package)).collect();
    let nodes: BTreeMap<String, Value> =
        list(&metadata["resolve"]["nodes"]).into_iter().map(|node| (text(&node["id"]), node)).collect();
    let start = packages.iter().find(|(_, known)| known["name"] == package).map(|(id, _)| id.clone());
    let mut open = vec![start.ok_or_else(|| format!("cargo metadata knows no package {package}"))?];
    let mut seen = BTreeSet::new();
    while let Some(id) = open.pop() {
        if !seen.insert(id.clone()) {
            continue;
        }
        for dependency in nodes.get(&id).map(|node| list(&node["deps"])).unwrap_or_default() {
            // a kind of null is a part of the program; others are for its build or its tests
            if list(&dependency["dep_kinds"]).iter().any(|kind| kind["kind"].is_null()) {
                open.push(text(&dependency["pkg"]));
            }
        }
    }
    let mut found: Vec<Dependency> = seen
        .iter()
        .filter_map(|id| packages.get(id))
        .filter(|package| !package["source"].is_null())
        .map(|package| Dependency {
            name: text(&package["name"]),
            version: text(&package["version"]),
            licence: text(&package["license"]),
            place: text(&package["repository"]),
            authors: list(&package["authors"]).iter().map(&text).collect::<Vec<_>>().join(", "),
            folder: Path::new(&text(&package["manifest_path"]))
                .parent()
                .map_or_else(String::new, |folder| folder.display().to_string()),
        })
        .collect();
    found.sort();
    Ok(found)
}

/// A table of all crates, and each text once, with the crates that it belongs to.
fn text_of(dependencies: &[Dependency]) -> Result<String, String> {
    let foreign: Vec<String> = dependencies
        .iter()
        .filter(|dependency| !is_allowed(&dependency.licence))
        .map(|dependency| format!("{} {}: \"{}\"", dependency.name, dependency.version, dependency.licence))
        .collect();
    if !foreign.is_empty() {
        return Err(format!("licences that nobody has allowed in xtask/src/dist/spdx.rs:\n  {}", foreign.join("\n  ")));
    }
    let mut table = String::from("| crate | version | licence | source |\n|---|---|---|---|\n");
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut without = Vec::new();
    for dependency in dependencies {
        let Dependency { name, version, licence, place, authors, folder } = dependency;
        table += &format!("| {name} | {version} | {licence} | {place} |\n");
        let found = texts_in(Path::new(folder));
        if found.is_empty() {
            let by = if authors.is_empty() { "its authors".to_owned() } else { authors.clone() };
            without.push(format!("- {name} {version}: {licence}, by {by}\n"));
        }
        for text in found {
            texts.entry(text).or_default().push(format!("{name} {version}"));
        }
    }
    let mut all = format!(
        "# Licences of the crates in this program\n\nhovertone itself is under the licence MIT or Apache-2.0: LICENSE-MIT, \
         LICENSE-APACHE. The program contains {} crates of other people.\n\n{table}",
        dependencies.len()
    );
    if !without.is_empty() {
        all += &format!("\nThese crates name their licence and hold no text of it:\n\n{}", without.concat());
    }
    for (text, crates) in &texts {
        all += &format!("\n## {}\n\n```text\n{}\n```\n", crates.join(", "), text.trim_end());
    }
    Ok(all)
}

/// The texts of the licences in the folder of a crate.
fn texts_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    let is_licence = |name: &str| FILES.iter().any(|begin| name.to_uppercase().starts_with(begin));
    let mut places: Vec<_> = entries
        .filter(|entry| entry.file_name().to_str().is_some_and(is_licence))
        .map(|entry| entry.path())
        .filter(|path| path.is_file())
        .collect();
    places.sort();
    let texts = places.iter().filter_map(|path| fs::read_to_string(path).ok());
    texts.map(|text| text.replace("\r\n", "\n").trim().to_owned()).filter(|text| !text.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn metadata_of(licence: &str, folder: &Path) -> Value {
        let manifest = |name: &str| folder.join(name).join("Cargo.toml").display().to_string();
        let package = |name: &str, source: Value| {
            json!({"id": name, "name": name, "version": "1.0.0", "license": licence, "source": source,
                   "repository": null, "authors": ["A. Author"], "manifest_path": manifest(name)})
        };
        let dep = |name: &str, kind: Value| json!({"pkg": name, "dep_kinds": [{"kind": kind}]});
        json!({
            "packages": [package("program", Value::Null), package("own", Value::Null), package("used", json!("registry")),
                         package("deep", json!("registry")), package("tested-with", json!("registry"))],
            "resolve": {"nodes": [
                {"id": "program", "deps": [dep("own", Value::Null), dep("tested-with", json!("dev"))]},
                {"id": "own", "deps": [dep("used", Value::Null)]},
                {"id": "used", "deps": [dep("deep", Value::Null), dep("program", json!("build"))]},
                {"id": "deep", "deps": []},
                {"id": "tested-with", "deps": []},
            ]},
        })
    }

    #[test]
    fn what_is_linked_is_listed_with_its_text_once() {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in [("used/LICENSE-MIT", "Permission\r\n"), ("deep/license.txt", "Permission\n")] {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let metadata = metadata_of("MIT", folder.path());
        let found = dependencies(&metadata, "program").unwrap();
        assert_eq!(found.iter().map(|one| one.name.as_str()).collect::<Vec<_>>(), ["deep", "used"]);
        let text = text_of(&found).unwrap();
        assert!(text.contains("2 crates of other people") && text.contains("## deep 1.0.0, used 1.0.0"), "{text}");
        assert_eq!(text.matches("Permission").count(), 1, "{text}");
        fs::remove_file(folder.path().join("deep/license.txt")).unwrap();
        assert!(text_of(&found).unwrap().contains("- deep 1.0.0: MIT, by A. Author"));
        assert!(dependencies(&metadata, "other").is_err());
    }

    #[test]
    fn a_licence_that_nobody_allowed_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let found = dependencies(&metadata_of("GPL-3.0", folder.path()), "program").unwrap();
        assert!(text_of(&found).unwrap_err().contains("deep 1.0.0: \"GPL-3.0\""));
    }

    #[test]
    fn every_crate_of_the_program_may_be_given_away() {
        let triple = super::super::host_triple().unwrap();
        let text = text(&crate::root(), &triple, super::super::PACKAGE).unwrap();
        for name in ["| clap |", "| symphonia |", "| realfft |"] {
            assert!(text.contains(name), "{name}");
        }
        assert!(!text.contains("| hovertone"), "own crates are not of other people");
    }
}
