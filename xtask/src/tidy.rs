//! Rules of the house that no compiler knows.

use std::fs;
use std::path::{Path, PathBuf};

const LINES_MAX: usize = 400;
const VAGUE_NAMES: [&str; 5] = ["utils.rs", "util.rs", "helpers.rs", "common.rs", "misc.rs"];
/// What the pure crates must not touch.
const PURE: [&str; 7] = ["vehicle", "hovertone", "sim", "exchange", "report", "figures", "page"];
const IMPURE: [&str; 6] = ["std::fs", "std::env", "std::time", "std::thread", "std::net", "println!"];
/// Who must not know whom: the simulator and the estimator, so that one can examine the other.
const STRANGERS: [(&str, &str); 8] = [
    ("sim", "hovertone.workspace"),
    ("hovertone", "hovertone-sim"),
    ("hovertone", "hovertone-media"),
    ("media", "hovertone-sim"),
    ("report", "hovertone-sim"),
    ("report", "hovertone-figures"),
    ("figures", "hovertone-sim"),
    ("page", "hovertone-sim"),
];

pub(crate) fn run(root: &Path) -> Result<(), String> {
    let mut faults = Vec::new();
    let mut sources = Vec::new();
    for folder in ["crates", "xtask"] {
        rust_files(&root.join(folder), &mut sources)?;
    }
    if sources.is_empty() {
        return Err("tidy found no source file".to_owned());
    }
    for path in &sources {
        let text = read(path)?;
        let name = path.strip_prefix(root).unwrap_or(path).display().to_string().replace('\\', "/");
        check_source(&name, &text, &mut faults);
    }
    check_strangers(root, &mut faults)?;
    check_architecture(root, &mut faults)?;
    if faults.is_empty() {
        println!("{} source files are tidy", sources.len());
        Ok(())
    } else {
        Err(faults.join("\n"))
    }
}

fn check_source(name: &str, text: &str, faults: &mut Vec<String>) {
    let lines = text.lines().count();
    if lines > LINES_MAX {
        faults.push(format!("{name}: {lines} lines, at most {LINES_MAX}; is it more than one job?"));
    }
    if VAGUE_NAMES.iter().any(|vague| name.ends_with(&format!("/{vague}"))) {
        faults.push(format!("{name}: a file's name says what is in it"));
    }
    let is_pure = PURE.iter().any(|crate_name| name.starts_with(&format!("crates/{crate_name}/src/")));
    let code = text.split("#[cfg(test)]").next().unwrap_or(text);
    if is_pure && !name.ends_with("tests.rs") {
        for impure in IMPURE.iter().filter(|impure| code.contains(*impure)) {
            faults.push(format!("{name}: {impure} belongs at the edges, not in a pure crate"));
        }
    }
}

fn check_strangers(root: &Path, faults: &mut Vec<String>) -> Result<(), String> {
    for (crate_name, stranger) in STRANGERS {
        let manifest = read(&root.join("crates").join(crate_name).join("Cargo.toml"))?;
        if manifest.lines().any(|line| line.trim_start().starts_with(stranger)) {
            faults.push(format!("crates/{crate_name}: must not depend on {stranger}"));
        }
    }
    Ok(())
}

/// Every crate has its line in ARCHITECTURE.md.
fn check_architecture(root: &Path, faults: &mut Vec<String>) -> Result<(), String> {
    let architecture = read(&root.join("ARCHITECTURE.md"))?;
    for entry in fs::read_dir(root.join("crates")).map_err(|error| format!("crates: {error}"))? {
        let name = entry.map_err(|error| format!("crates: {error}"))?.file_name();
        let name = format!("crates/{}", name.to_string_lossy());
        if !architecture.contains(&name) {
            faults.push(format!("ARCHITECTURE.md does not mention {name}"));
        }
    }
    Ok(())
}

fn rust_files(folder: &Path, into: &mut Vec<PathBuf>) -> Result<(), String> {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for entry in entries {
        let path = entry.map_err(|error| format!("{}: {error}", folder.display()))?.path();
        if path.is_dir() && path.file_name().is_some_and(|name| name != "target") {
            rust_files(&path, into)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            into.push(path);
        }
    }
    Ok(())
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::check_source;

    #[test]
    fn faults_are_found() {
        let faults_of = |name: &str, text: &str| {
            let mut faults = Vec::new();
            check_source(name, text, &mut faults);
            faults.len()
        };
        assert_eq!(faults_of("crates/hovertone/src/a.rs", "fn a() {}"), 0);
        assert_eq!(faults_of("crates/hovertone/src/a.rs", "use std::fs;"), 1);
        assert_eq!(faults_of("crates/hovertone/src/a.rs", "#[cfg(test)]\nmod tests { use std::fs; }"), 0);
        assert_eq!(faults_of("crates/cli/src/a.rs", "use std::fs;"), 0);
        assert_eq!(faults_of("crates/cli/src/utils.rs", ""), 1);
        assert_eq!(faults_of("crates/cli/src/a.rs", &"\n".repeat(401)), 1);
    }
}
