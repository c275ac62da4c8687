//! The scripts, the style and the first document of the page, as few files.

use super::run_in;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Files that are copied as they are.
const COPIED: [&str; 2] = ["index.html", "icon.svg"];
/// Name of the module in the folder.
const MODULE: &str = "hovertone_bg.wasm";

/// Installs the tools of the page where they are missing, checks its types, and writes its folder.
pub(super) fn write(scripts: &Path, bindings: &Path, out: &Path) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", out.display());
    let modules = scripts.join("node_modules");
    if !modules.join(".package-lock.json").exists() {
        run_in(scripts, Command::new("npm").args(["ci", "--no-audit", "--no-fund", "--ignore-scripts"]))?;
    }
    let tool = |name: &str| modules.join(".bin").join(name);
    run_in(scripts, Command::new(tool("tsc")).arg("--noEmit"))?;
    if out.exists() {
        fs::remove_dir_all(out).map_err(failed)?;
    }
    fs::create_dir_all(out).map_err(failed)?;
    let mut esbuild = Command::new(tool("esbuild"));
    esbuild.args(["src/main.tsx", "src/worker.ts", "--bundle", "--minify", "--format=esm", "--target=es2022"]);
    esbuild.args(["--jsx=automatic", "--jsx-import-source=preact", "--log-level=warning"]);
    esbuild.arg(format!("--alias:hovertone-bindings={}", bindings.join("hovertone.js").display()));
    run_in(scripts, esbuild.arg(format!("--outdir={}", out.display())))?;
    for name in COPIED {
        fs::copy(scripts.join(name), out.join(name)).map_err(failed)?;
    }
    fs::copy(bindings.join(MODULE), out.join(MODULE)).map_err(failed)?;
    Ok(())
}
