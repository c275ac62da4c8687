//! The scripts, the style and the first document of the page, as few files.
//!
//! Scripts, style and WebAssembly are in a folder whose name is the hash of their content: a browser never mixes two versions of the page.

use super::{icons, run_in};
use sha2::{Digest, Sha256};
use std::path::Path;
use std::process::Command;
use std::{fs, io};

/// Scripts with a file of their own: the page, its workers, and what runs in the audio thread.
const SCRIPTS: [&str; 4] = ["src/main.tsx", "src/worker.ts", "src/ear.ts", "src/microphone.worklet.ts"];
/// The script that keeps the page in the browser; it names all other files.
const SERVICE_WORKER: &str = "src/service_worker.ts";
/// The first document; `ASSETS` in it stands for the folder of the scripts.
const DOCUMENT: &str = "index.html";
/// Files that are copied as they are.
const COPIED: [&str; 2] = ["icon.svg", "manifest.webmanifest"];
/// Name of the module in the folder.
const MODULE: &str = "hovertone_bg.wasm";
/// Characters of a hash that name a version.
const HASH_CHARACTERS: usize = 12;

/// Installs the tools of the page where they are missing, checks its types, and writes its folder.
pub(super) fn write(scripts: &Path, bindings: &Path, out: &Path) -> Result<(), String> {
    let modules = scripts.join("node_modules");
    if !modules.join(".package-lock.json").exists() {
        run_in(scripts, Command::new("npm").args(["ci", "--no-audit", "--no-fund", "--ignore-scripts"]))?;
    }
    run_in(scripts, Command::new(modules.join(".bin/tsc")).arg("--noEmit"))?;
    let failed = |error: io::Error| format!("{}: {error}", out.display());
    if out.exists() {
        fs::remove_dir_all(out).map_err(failed)?;
    }
    let made = out.join("made");
    fs::create_dir_all(&made).map_err(failed)?;
    let alias = format!("--alias:hovertone-bindings={}", bindings.join("hovertone.js").display());
    bundled(scripts, &SCRIPTS, &made, &[alias])?;
    fs::copy(bindings.join(MODULE), made.join(MODULE)).map_err(failed)?;
    let assets = hash_of(&made).map_err(failed)?;
    fs::rename(&made, out.join(&assets)).map_err(failed)?;

    let document = fs::read_to_string(scripts.join(DOCUMENT)).map_err(failed)?;
    fs::write(out.join(DOCUMENT), document.replace("ASSETS", &assets)).map_err(failed)?;
    for name in COPIED {
        fs::copy(scripts.join(name), out.join(name)).map_err(failed)?;
    }
    icons::write(&scripts.join("icon.svg"), out)?;
    let version = hash_of(out).map_err(failed)?;
    let files: Vec<String> = names_in(out).map_err(failed)?.into_iter().filter(|name| name != DOCUMENT).collect();
    let define = [format!("--define:FILES={}", serde_json::json!(files)), format!("--define:VERSION={version:?}")];
    bundled(scripts, &[SERVICE_WORKER], out, &define)
}

fn bundled(scripts: &Path, sources: &[&str], out: &Path, more: &[String]) -> Result<(), String> {
    let mut esbuild = Command::new(scripts.join("node_modules/.bin/esbuild"));
    esbuild.args(sources).args(["--bundle", "--minify", "--format=esm", "--target=es2022"]);
    esbuild.args(["--jsx=automatic", "--jsx-import-source=preact", "--log-level=warning"]).args(more);
    run_in(scripts, esbuild.arg(format!("--outdir={}", out.display())))
}

/// The files of a folder and of the folders in it, by their paths from it.
fn names_in(folder: &Path) -> io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        match entry.file_type()?.is_dir() {
            true => names.extend(names_in(&entry.path())?.iter().map(|inner| format!("{name}/{inner}"))),
            false => names.push(name),
        }
    }
    names.sort();
    Ok(names)
}

/// A short hash of all files of a folder.
fn hash_of(folder: &Path) -> io::Result<String> {
    let mut hasher = Sha256::new();
    for name in names_in(folder)? {
        hasher.update(name.as_bytes());
        hasher.update(Sha256::digest(fs::read(folder.join(&name))?));
    }
    let hexadecimal: String = hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    Ok(hexadecimal[..HASH_CHARACTERS].to_owned())
}
