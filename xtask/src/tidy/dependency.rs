//! A crate uses only the crates below it.

use super::fault::Fault;
use crate::tree::{Manifest, Tree};
use std::collections::BTreeMap;
use toml::de::{DeTable, DeValue};

/// A crate and all crates of the workspace that its `[dependencies]` may name.
struct Row {
    crate_name: &'static str,
    may_use: &'static [&'static str],
}

/// All crates but those at the top: `cli`, `web`, `bench` and `python`.
const LIBRARIES: [&str; 20] = [
    "vehicle",
    "fft",
    "signal",
    "analysis",
    "rotor-speed",
    "rotor-id",
    "dynamics",
    "live",
    "thrust",
    "hovertone",
    "media",
    "stores",
    "sim",
    "logs",
    "exchange",
    "report",
    "archive",
    "figures",
    "page",
    "workflow",
];

/// The line of the table.
const TABLE_LINE: usize = line!() as usize + 2;
/// From the lowest crate to the highest.
const TABLE: [Row; 25] = [
    Row { crate_name: "vehicle", may_use: &[] },
    Row { crate_name: "fft", may_use: &[] },
    Row { crate_name: "signal", may_use: &["fft"] },
    Row { crate_name: "analysis", may_use: &["vehicle"] },
    Row { crate_name: "rotor-speed", may_use: &["signal", "analysis", "vehicle"] },
    Row { crate_name: "rotor-id", may_use: &["rotor-speed", "signal", "analysis", "vehicle"] },
    Row { crate_name: "dynamics", may_use: &["signal", "analysis", "vehicle"] },
    Row { crate_name: "live", may_use: &["rotor-speed", "signal", "analysis", "vehicle"] },
    Row { crate_name: "thrust", may_use: &["analysis", "vehicle"] },
    Row {
        crate_name: "hovertone",
        may_use: &["rotor-id", "rotor-speed", "live", "thrust", "dynamics", "signal", "analysis", "vehicle"],
    },
    Row { crate_name: "media", may_use: &["signal"] },
    Row { crate_name: "stores", may_use: &["media"] },
    // The simulator does not know the estimator: so that recovering a simulated speed proves something.
    Row { crate_name: "sim", may_use: &["vehicle"] },
    Row { crate_name: "logs", may_use: &[] },
    Row { crate_name: "exchange", may_use: &["logs", "vehicle"] },
    Row { crate_name: "report", may_use: &["analysis", "thrust", "vehicle", "exchange", "logs", "dynamics"] },
    Row { crate_name: "archive", may_use: &["analysis", "report", "vehicle"] },
    Row { crate_name: "figures", may_use: &["analysis", "thrust", "vehicle", "signal", "dynamics"] },
    Row { crate_name: "page", may_use: &["analysis", "thrust", "vehicle", "signal", "figures", "report"] },
    Row {
        crate_name: "workflow",
        may_use: &["hovertone", "analysis", "vehicle", "media", "exchange", "report", "figures", "page"],
    },
    Row {
        crate_name: "web",
        may_use: &["workflow", "hovertone", "vehicle", "media", "sim", "exchange", "report", "figures", "page"],
    },
    Row { crate_name: "cli", may_use: &LIBRARIES },
    Row { crate_name: "bench", may_use: &LIBRARIES },
    // Python calls the commands, so that a flag has one meaning and a refusal one wording (decision 27).
    Row { crate_name: "python", may_use: &["cli", "analysis", "media", "report"] },
    Row { crate_name: "xtask", may_use: &[] },
];

pub(super) fn check(tree: &Tree) -> Vec<Fault> {
    let mut faults = faults(tree, &TABLE);
    let present = tree.crate_names();
    for row in TABLE.iter().filter(|row| !present.contains(row.crate_name)) {
        let message = format!("there is no crate {}: remove its row from TABLE", row.crate_name);
        faults.push(Fault::new(file!(), TABLE_LINE, message));
    }
    faults
}

fn faults(tree: &Tree, table: &[Row]) -> Vec<Fault> {
    let members: BTreeMap<String, &str> = tree
        .manifests
        .iter()
        .filter_map(|manifest| Some((package_name(manifest)?, manifest.crate_name.as_str())))
        .collect();
    let renamed = renamed_in_workspace(&tree.workspace_manifest);
    let mut faults = Vec::new();
    for manifest in &tree.manifests {
        let dependencies = match dependencies(&manifest.text) {
            Ok(dependencies) => dependencies,
            Err(message) => {
                faults.push(Fault::new(&manifest.path, 1, format!("{message}: repair the manifest")));
                continue;
            }
        };
        let name = manifest.crate_name.as_str();
        let Some(row) = table.iter().find(|row| row.crate_name == name) else {
            let message = format!("{name} has no row in TABLE of {}: add one with the crates that it may use", file!());
            faults.push(Fault::new(&manifest.path, 1, message));
            continue;
        };
        for dependency in dependencies {
            let package = renamed.get(&dependency.package).unwrap_or(&dependency.package);
            let Some(used) = members.get(package).filter(|used| !row.may_use.contains(used)) else { continue };
            let allowed =
                if row.may_use.is_empty() { "no crate of the workspace".to_owned() } else { row.may_use.join(", ") };
            let message = format!(
                "{name} must not use {used}; it may use {allowed}: move what it needs to a crate below both, or to the caller"
            );
            faults.push(Fault::new(&manifest.path, dependency.line, message));
        }
    }
    faults
}

struct Dependency {
    package: String,
    line: usize,
}

/// What `[dependencies]` and `[build-dependencies]` name, for all targets; what only tests use is not among them.
fn dependencies(manifest: &str) -> Result<Vec<Dependency>, String> {
    let table = DeTable::parse(manifest).map_err(|error| error.message().to_owned())?;
    let table = table.get_ref();
    let mut found = Vec::new();
    let targets = table.get("target").and_then(|target| target.get_ref().as_table());
    let of_targets =
        targets.into_iter().flat_map(|targets| targets.values()).filter_map(|target| target.get_ref().as_table());
    for table in std::iter::once(table).chain(of_targets) {
        for section in ["dependencies", "build-dependencies"] {
            let Some(section) = table.get(section).and_then(|section| section.get_ref().as_table()) else { continue };
            for (name, value) in section {
                let line = manifest[..name.span().start].matches('\n').count() + 1;
                let package = renamed_to(value.get_ref()).unwrap_or_else(|| name.get_ref().to_string());
                found.push(Dependency { package, line });
            }
        }
    }
    Ok(found)
}

/// The package that a dependency has under another name.
fn renamed_to(dependency: &DeValue<'_>) -> Option<String> {
    dependency.get("package").and_then(|package| package.get_ref().as_str()).map(str::to_owned)
}

fn package_name(manifest: &Manifest) -> Option<String> {
    let table = DeTable::parse(&manifest.text).ok()?;
    let name = table.get_ref().get("package")?.get_ref().get("name")?;
    name.get_ref().as_str().map(str::to_owned)
}

/// Other names that `[workspace.dependencies]` gives to packages.
fn renamed_in_workspace(manifest: &str) -> BTreeMap<String, String> {
    let Ok(table) = DeTable::parse(manifest) else { return BTreeMap::new() };
    let dependencies = table.get_ref().get("workspace").and_then(|workspace| workspace.get_ref().get("dependencies"));
    let dependencies = dependencies.and_then(|dependencies| dependencies.get_ref().as_table());
    let pairs = dependencies.into_iter().flatten();
    pairs.filter_map(|(name, value)| Some((name.get_ref().to_string(), renamed_to(value.get_ref())?))).collect()
}

#[cfg(test)]
mod tests {
    use super::{LIBRARIES, TABLE, check, faults};
    use crate::tree::Tree;

    /// Messages for a workspace of vehicle, sim and media, where media has these lines in its manifest.
    fn messages(lines: &str) -> Vec<String> {
        let media = format!("[package]\nname = \"hovertone-media\"\n{lines}");
        let tree = Tree::of(&[
            ("Cargo.toml", "[workspace.dependencies]\nother = { package = \"hovertone-sim\", path = \"crates/sim\" }"),
            ("crates/media/Cargo.toml", &media),
            (
                "crates/sim/Cargo.toml",
                "[package]\nname = \"hovertone-sim\"\n[dependencies]\nhovertone-vehicle.workspace = true",
            ),
            ("crates/vehicle/Cargo.toml", "[package]\nname = \"hovertone-vehicle\""),
            ("crates/vehicle/src/lib.rs", ""),
        ]);
        faults(&tree, &TABLE).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn an_upward_use_is_a_fault_with_its_line() {
        assert_eq!(
            messages("\n[dependencies]\nserde.workspace = true\nhovertone-sim.workspace = true"),
            ["crates/media/Cargo.toml:6: media must not use sim; it may use signal: \
              move what it needs to a crate below both, or to the caller"]
        );
    }

    #[test]
    fn every_spelling_of_a_dependency_is_read() {
        for lines in [
            "[dependencies.hovertone-sim]\npath = \"../sim\"",
            "[dependencies]\nsound = { package = \"hovertone-sim\", path = \"../sim\" }",
            "[dependencies]\nother.workspace = true",
            "[target.'cfg(unix)'.dependencies]\nhovertone-sim = { workspace = true }",
            "[build-dependencies]\nhovertone-sim.workspace = true",
        ] {
            assert_eq!(messages(lines).len(), 1, "{lines}");
        }
    }

    #[test]
    fn lower_crates_foreign_crates_and_tests_are_none() {
        assert!(messages("[dependencies]\nserde.workspace = true").is_empty());
        assert!(messages("[dev-dependencies]\nhovertone-sim.workspace = true").is_empty());
    }

    #[test]
    fn a_crate_needs_a_row_and_a_row_a_crate() {
        let of = |files: &[(&str, &str)]| check(&Tree::of(files)).iter().map(ToString::to_string).collect::<Vec<_>>();
        let found =
            of(&[("crates/new/Cargo.toml", "[package]\nname = \"hovertone-new\""), ("crates/new/src/lib.rs", "")]);
        assert!(found.iter().any(|message| message.starts_with("crates/new/Cargo.toml:1: new has no row in TABLE")));
        assert!(found.iter().any(|message| message.contains("there is no crate vehicle: remove its row")));
        assert_eq!(found.len(), 1 + TABLE.len());
    }

    #[test]
    fn a_broken_manifest_is_a_fault() {
        assert_eq!(messages("[dependencies").len(), 1);
    }

    #[test]
    fn the_table_has_no_circle_and_all_libraries() {
        for (index, row) in TABLE.iter().enumerate() {
            let is_below = |used: &&str| TABLE[..index].iter().any(|lower| lower.crate_name == *used);
            assert!(row.may_use.iter().all(is_below), "{}", row.crate_name);
        }
        assert!(LIBRARIES.iter().zip(&TABLE).all(|(name, row)| *name == row.crate_name));
    }
}
