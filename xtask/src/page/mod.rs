//! `cargo xtask page`: the page for the browser as a folder for any static host: WebAssembly, bindings, and one bundle of scripts.

#[cfg(feature = "page")]
mod bindings;
#[cfg(feature = "page")]
mod bundle;
#[cfg(feature = "page")]
mod icons;
mod toolchain;

use crate::target;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The crate whose WebAssembly the page runs.
#[cfg(feature = "page")]
const PACKAGE: &str = "hovertone-web";
/// Where the scripts of the page are.
#[cfg(feature = "page")]
const SCRIPTS: &str = "crates/web/page";

/// Builds the page into `target/page`, or into the folder after `--out`.
pub(crate) fn run(root: &Path, arguments: &[&str]) -> Result<(), String> {
    match arguments {
        [] => build(root, &target(root).join("page")),
        ["--out", folder] => build(root, &PathBuf::from(folder)),
        ["--test"] => test(root),
        _ => Err("cargo xtask page [--out FOLDER | --test]".to_owned()),
    }
}

/// Builds the page and runs its tests in a browser. Without the tools for it they are skipped, unless `HOVERTONE_REQUIRE_PAGE` is set.
fn test(root: &Path) -> Result<(), String> {
    let is_required = std::env::var_os("HOVERTONE_REQUIRE_PAGE").is_some();
    if let Some(missing) = missing_tool().filter(|_| !is_required) {
        println!("skipped: the tests of the page ({missing})");
        return Ok(());
    }
    build(root, &target(root).join("page"))?;
    // features of the whole workspace, so that what `cargo xtask ci` has built is used again
    let arguments =
        ["test", "--workspace", "--locked", "--features", "hovertone-cli/page", "--test", "command", "served::"];
    run_in(root, Command::new("cargo").args(arguments))
}

fn missing_tool() -> Option<String> {
    let has_npm = Command::new("npm").arg("--version").output().is_ok_and(|output| output.status.success());
    if has_npm { toolchain::Toolchain::found().err() } else { Some("no npm: install Node.js".to_owned()) }
}

/// The maker of bindings is a large library that no other task needs: it is built for this task alone.
#[cfg(not(feature = "page"))]
fn build(root: &Path, out: &Path) -> Result<(), String> {
    let out = std::path::absolute(out).map_err(|error| error.to_string())?;
    let mut again = Command::new("cargo");
    again.args(["run", "--quiet", "--package", "xtask", "--features", "page", "--", "page", "--out"]).arg(out);
    run_in(root, &mut again)
}

#[cfg(feature = "page")]
fn build(root: &Path, out: &Path) -> Result<(), String> {
    println!("== WebAssembly");
    let module = toolchain::Toolchain::found()?.build(root, PACKAGE)?;
    println!("== bindings");
    let bindings = target(root).join("web/bindings");
    bindings::write(&module, &bindings)?;
    println!("== bundle");
    bundle::write(&root.join(SCRIPTS), &bindings, out)?;
    println!("written: {}", out.display());
    Ok(())
}

/// Runs a program in a folder, with its output on the terminal.
fn run_in(folder: &Path, command: &mut Command) -> Result<(), String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let status = command.current_dir(folder).status();
    let status = status.map_err(|error| format!("{name} could not be started: {error}; install it"))?;
    if status.success() { Ok(()) } else { Err(format!("{name} failed: {status}")) }
}
