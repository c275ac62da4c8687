//! Rules of the house that no compiler knows, one file for each.
//!
//! ```text
//! circle               rooms of a crate do not use each other in a circle
//! dependency           crates use only crates below them
//! tuple_parameter      no function takes a tuple                    long_function       a function fits on a screen
//! unmarked_constant    a constant says what kind of number it is    unnamed_number      no tuning number inside an algorithm
//! outputs              the command line writes files in one place
//! architecture         ARCHITECTURE.md names every folder           file_length, file_name, purity, prose
//! ```
//!
//! `paths` and `functions` list the names and functions of a file.

mod architecture;
mod circle;
mod dependency;
mod fault;
mod file_length;
mod file_name;
mod functions;
mod long_function;
mod outputs;
mod paths;
mod prose;
mod purity;
mod tuple_parameter;
mod unmarked_constant;
mod unnamed_number;

use crate::tree::Tree;
use fault::Fault;
use std::collections::BTreeSet;
use std::path::Path;

struct Rule {
    name: &'static str,
    check: fn(&Tree) -> Vec<Fault>,
}

const RULES: [Rule; 12] = [
    Rule { name: "circle", check: circle::check },
    Rule { name: "dependency", check: dependency::check },
    Rule { name: "tuple parameter", check: tuple_parameter::check },
    Rule { name: "long function", check: long_function::check },
    Rule { name: "unmarked constant", check: unmarked_constant::check },
    Rule { name: "unnamed number", check: unnamed_number::check },
    Rule { name: "architecture", check: architecture::check },
    Rule { name: "file length", check: file_length::check },
    Rule { name: "file name", check: file_name::check },
    Rule { name: "purity", check: purity::check },
    Rule { name: "outputs", check: outputs::check },
    Rule { name: "prose", check: prose::check },
];

/// Checks the workspace at `root` against all rules. The error lists every fault.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let tree = Tree::read(root)?;
    let faults = faults(&tree);
    if faults.is_empty() {
        println!("{} source files are tidy", tree.sources.len());
        return Ok(());
    }
    let lines: Vec<String> = faults.iter().map(|(rule, fault)| format!("{fault} [{rule}]")).collect();
    Err(format!("{}\n\n{} faults; `cargo xtask tidy --list` counts them", lines.join("\n"), lines.len()))
}

/// Prints the number of faults of each rule, and the files that hold them.
pub(crate) fn list(root: &Path) -> Result<(), String> {
    let tree = Tree::read(root)?;
    let faults = faults(&tree);
    println!("{:>6}  {:<18} files", "faults", "rule");
    for rule in &RULES {
        let of_rule: Vec<&Fault> =
            faults.iter().filter(|(name, _)| *name == rule.name).map(|(_, fault)| fault).collect();
        let files: BTreeSet<&str> = of_rule.iter().map(|fault| fault.path.as_str()).collect();
        println!("{:>6}  {:<18} {}", of_rule.len(), rule.name, files.len());
        for file in files {
            let count = of_rule.iter().filter(|fault| fault.path == file).count();
            println!("{count:>6}      {file}");
        }
    }
    println!("{:>6}  in {} source files", faults.len(), tree.sources.len());
    Ok(())
}

fn faults(tree: &Tree) -> Vec<(&'static str, Fault)> {
    let mut faults = Vec::new();
    for rule in &RULES {
        let mut of_rule = (rule.check)(tree);
        of_rule.sort();
        faults.extend(of_rule.into_iter().map(|fault| (rule.name, fault)));
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::{list, run};
    use std::fs;

    /// A workspace with `source` as its one file.
    fn outcome(source: &str) -> Result<(), String> {
        let folder = tempfile::tempdir().unwrap();
        let write = |path: &str, text: &str| {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        fs::create_dir_all(folder.path().join("xtask")).unwrap();
        write("Cargo.toml", "[workspace]\n");
        write("ARCHITECTURE.md", "## crates/vehicle\n");
        write("crates/vehicle/Cargo.toml", "[package]\nname = \"hovertone-vehicle\"\n");
        write("crates/vehicle/src/lib.rs", source);
        list(folder.path())?;
        run(folder.path())
    }

    #[test]
    fn every_fault_is_listed_with_its_place_and_rule() {
        let message = outcome("fn a(b: (f64, f64)) -> f64 {\n    b.0 * 0.3\n}\n").unwrap_err();
        assert!(message.contains("crates/vehicle/src/lib.rs:1: "), "{message}");
        assert!(message.contains("[tuple parameter]"), "{message}");
        assert!(message.contains("crates/vehicle/src/lib.rs:2: "), "{message}");
        assert!(message.contains("[unnamed number]"), "{message}");
    }

    #[test]
    fn a_workspace_without_source_files_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["crates", "xtask"] {
            fs::create_dir_all(folder.path().join(name)).unwrap();
        }
        fs::write(folder.path().join("Cargo.toml"), "").unwrap();
        fs::write(folder.path().join("ARCHITECTURE.md"), "").unwrap();
        assert_eq!(run(folder.path()), Err("no source file was found".to_owned()));
        assert_eq!(list(folder.path()), Err("no source file was found".to_owned()));
    }

    #[test]
    fn a_file_that_does_not_parse_is_refused() {
        let message = outcome("fn a( {").unwrap_err();
        assert!(message.starts_with("crates/vehicle/src/lib.rs:1: "), "{message}");
    }
}
