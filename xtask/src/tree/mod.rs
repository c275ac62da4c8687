//! The workspace as text: source files, parsed, with and without their tests; manifests; ARCHITECTURE.md.

mod test_code;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

pub(crate) struct Tree {
    pub(crate) sources: Vec<Source>,
    /// The manifest of the workspace.
    pub(crate) workspace_manifest: String,
    pub(crate) manifests: Vec<Manifest>,
    pub(crate) architecture: String,
}

/// The manifest of one crate.
pub(crate) struct Manifest {
    pub(crate) path: String,
    /// The folder of the crate: `X` of `crates/X`, or `xtask`.
    pub(crate) crate_name: String,
    pub(crate) text: String,
}

/// One Rust file.
pub(crate) struct Source {
    /// Below the root of the workspace, with `/` between folders.
    pub(crate) path: String,
    /// The folder of the crate: `X` of `crates/X`, or `xtask`.
    pub(crate) crate_name: String,
    pub(crate) text: String,
    /// The file as it stands.
    pub(crate) file: syn::File,
    /// The file without its tests; empty for a file of tests.
    pub(crate) code: syn::File,
}

impl Source {
    /// The path below the folder `src` of the crate; `None` for tests, benches and examples.
    pub(crate) fn below_src(&self) -> Option<&str> {
        let folder = folder_of_crate(&self.crate_name);
        self.path.strip_prefix(&folder)?.strip_prefix("/src/")
    }

    /// The modules that lead to this file from the root of its crate: `["room", "part"]` for `src/room/part.rs`.
    pub(crate) fn module(&self) -> Vec<String> {
        let Some(stem) = self.below_src().and_then(|below| below.strip_suffix(".rs")) else { return Vec::new() };
        let mut module: Vec<String> = stem.split('/').map(str::to_owned).collect();
        if module.last().is_some_and(|last| last == "mod") || matches!(stem, "lib" | "main") {
            module.pop();
        }
        module
    }
}

impl Tree {
    /// Reads all Rust files and manifests below `crates` and `xtask`.
    pub(crate) fn read(root: &Path) -> Result<Self, String> {
        let mut files = Vec::new();
        for folder in ["crates", "xtask"] {
            read_folder(root, folder, &mut files)?;
        }
        for name in ["Cargo.toml", "ARCHITECTURE.md"] {
            files.push((name.to_owned(), read(&root.join(name))?));
        }
        Self::from_files(files)
    }

    fn from_files(files: Vec<(String, String)>) -> Result<Self, String> {
        let mut tree = Self {
            sources: Vec::new(),
            workspace_manifest: String::new(),
            manifests: Vec::new(),
            architecture: String::new(),
        };
        for (path, text) in files {
            match path.as_str() {
                "Cargo.toml" => tree.workspace_manifest = text,
                "ARCHITECTURE.md" => tree.architecture = text,
                _ if path.ends_with(".rs") => tree.sources.push(source(path, text)?),
                _ => {
                    let crate_name = crate_name(&path);
                    if path == format!("{}/Cargo.toml", folder_of_crate(&crate_name)) {
                        tree.manifests.push(Manifest { path, crate_name, text });
                    }
                }
            }
        }
        if tree.sources.is_empty() {
            return Err("no source file was found".to_owned());
        }
        let test_paths: BTreeSet<String> = tree.sources.iter().flat_map(test_code::modules_for_tests).collect();
        for source in tree.sources.iter_mut().filter(|source| test_code::is_test_file(&source.path, &test_paths)) {
            source.code.items.clear();
        }
        Ok(tree)
    }

    /// A tree of these paths and texts.
    #[cfg(test)]
    pub(crate) fn of(files: &[(&str, &str)]) -> Self {
        Self::from_files(files.iter().map(|&(path, text)| (path.to_owned(), text.to_owned())).collect()).unwrap()
    }

    /// Names of all crates that have a source file or a manifest.
    pub(crate) fn crate_names(&self) -> BTreeSet<&str> {
        let of_sources = self.sources.iter().map(|source| source.crate_name.as_str());
        of_sources.chain(self.manifests.iter().map(|manifest| manifest.crate_name.as_str())).collect()
    }
}

/// Where a crate stands, below the root.
pub(crate) fn folder_of_crate(crate_name: &str) -> String {
    if crate_name == "xtask" { crate_name.to_owned() } else { format!("crates/{crate_name}") }
}

fn crate_name(path: &str) -> String {
    let name = path.strip_prefix("crates/").unwrap_or(path);
    name.split('/').next().unwrap_or(name).to_owned()
}

fn source(path: String, text: String) -> Result<Source, String> {
    let parse =
        || syn::parse_file(&text).map_err(|error| format!("{path}:{}: {error}; repair it", error.span().start().line));
    let file = parse()?;
    let mut code = parse()?;
    test_code::remove_tests(&mut code.items);
    Ok(Source { crate_name: crate_name(&path), path, text, file, code })
}

fn read_folder(root: &Path, folder: &str, into: &mut Vec<(String, String)>) -> Result<(), String> {
    let entries = fs::read_dir(root.join(folder)).map_err(|error| format!("{folder}: {error}"))?;
    for entry in entries {
        let entry = entry.map_err(|error| format!("{folder}: {error}"))?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = format!("{folder}/{name}");
        if entry.path().is_dir() {
            if name != "target" {
                read_folder(root, &path, into)?;
            }
        } else if name.ends_with(".rs") || name == "Cargo.toml" {
            let text = read(&entry.path())?;
            into.push((path, text));
        }
    }
    into.sort();
    Ok(())
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::Tree;
    use std::fs;

    #[test]
    fn modules_follow_folders_and_mod_files() {
        let modules = |path: &str| Tree::of(&[(path, "")]).sources[0].module().join("::");
        assert_eq!(modules("crates/a/src/lib.rs"), "");
        assert_eq!(modules("crates/a/src/room.rs"), "room");
        assert_eq!(modules("crates/a/src/room/mod.rs"), "room");
        assert_eq!(modules("crates/a/src/room/part/mod.rs"), "room::part");
        assert_eq!(modules("xtask/src/room/part.rs"), "room::part");
    }

    #[test]
    fn files_of_tests_have_no_code() {
        let tree = Tree::of(&[
            ("crates/a/src/room/mod.rs", "#[cfg(test)] mod builder; #[cfg(test)] mod tests { fn t() {} } fn f() {}"),
            ("crates/a/src/room/builder.rs", "fn b() {}"),
            ("crates/a/src/room/part.rs", "#[cfg(test)] #[path = \"strange.rs\"] mod tests; fn f() {}"),
            ("crates/a/src/room/strange.rs", "fn s() {}"),
            ("crates/a/src/room/part_tests.rs", "fn t() {}"),
            ("crates/a/tests/exam.rs", "fn t() {}"),
        ]);
        let with_code: Vec<(&str, usize)> =
            tree.sources.iter().map(|source| (source.path.as_str(), source.code.items.len())).collect();
        let names = ["mod.rs", "builder.rs", "part.rs", "strange.rs", "part_tests.rs", "exam.rs"];
        for ((path, items), (name, expected)) in with_code.iter().zip(names.iter().zip([1, 0, 1, 0, 0, 0])) {
            assert!(path.ends_with(name));
            assert_eq!(*items, expected, "{path}");
        }
    }

    #[test]
    fn a_folder_is_read_without_what_cargo_built() {
        let root = tempfile::tempdir().unwrap();
        for (path, text) in [
            ("Cargo.toml", "[workspace]"),
            ("ARCHITECTURE.md", "# Architecture"),
            ("crates/a/Cargo.toml", "[package]"),
            ("crates/a/src/lib.rs", "fn a() {}"),
            ("crates/a/target/b.rs", "not Rust"),
            ("xtask/src/main.rs", "fn main() {}"),
        ] {
            let path = root.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let tree = Tree::read(root.path()).unwrap();
        let paths: Vec<&str> = tree.sources.iter().map(|source| source.path.as_str()).collect();
        assert_eq!(paths, ["crates/a/src/lib.rs", "xtask/src/main.rs"]);
        assert_eq!(tree.manifests[0].crate_name, "a");
        assert_eq!(tree.architecture, "# Architecture");
    }
}
