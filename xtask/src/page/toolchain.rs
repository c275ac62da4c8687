//! The compiler for WebAssembly: the one of this workspace, where it has the standard library for that target, or a distribution's, which
//! builds that library from its sources.

use super::run_in;
use crate::target;
use std::path::{Path, PathBuf};
use std::process::Command;

const TARGET: &str = "wasm32-unknown-unknown";
/// Fast transforms of four numbers at once; every browser since 2021 has them.
const SIMD: &str = "-C target-feature=+simd128";
/// Where a distribution puts its compiler.
const SYSTEM_FOLDER: &str = "/usr/bin";
const HOW_TO_INSTALL: &str = "no compiler for WebAssembly: run `rustup target add wasm32-unknown-unknown`, or, where rustup cannot \
    download, `apt-get install rustc-web cargo-web rust-web-src lld-19`";

/// A compiler for WebAssembly.
#[cfg_attr(not(feature = "page"), allow(dead_code))]
pub(super) enum Toolchain {
    /// The compiler of the workspace.
    Own,
    /// The compiler of the system, with the sources of its standard library and a linker.
    System {
        /// Name of the linker.
        linker: String,
    },
}

#[cfg_attr(not(feature = "page"), allow(dead_code))]
impl Toolchain {
    /// The first compiler that can build for the browser.
    pub(super) fn found() -> Result<Self, String> {
        if sysroot_of(Path::new("rustc")).is_some_and(|root| root.join("lib/rustlib").join(TARGET).is_dir()) {
            return Ok(Self::Own);
        }
        let folder = Path::new(SYSTEM_FOLDER);
        let has_sources = sysroot_of(&folder.join("rustc"))
            .is_some_and(|root| root.join("lib/rustlib/src/rust/library/std").is_dir());
        let linkers = ["wasm-ld", "wasm-ld-19", "wasm-ld-18", "wasm-ld-17", "wasm-ld-16"];
        let linker = linkers.into_iter().find(|name| folder.join(name).exists());
        match linker.filter(|_| has_sources && folder.join("cargo").exists()) {
            Some(linker) => Ok(Self::System { linker: linker.to_owned() }),
            None => Err(HOW_TO_INSTALL.to_owned()),
        }
    }

    /// Builds a package and returns its module.
    pub(super) fn build(&self, root: &Path, package: &str) -> Result<PathBuf, String> {
        let folder = target(root).join("web");
        let arguments = ["build", "--locked", "--profile", "web", "--target", TARGET, "--package", package];
        let mut command = match self {
            Self::Own => {
                let mut command = Command::new("cargo");
                command.env("RUSTFLAGS", SIMD).args(arguments);
                command
            }
            Self::System { linker } => {
                let bin = Path::new(SYSTEM_FOLDER);
                let mut command = Command::new(bin.join("cargo"));
                command.env("RUSTC", bin.join("rustc")).env("RUSTC_BOOTSTRAP", "1");
                command.env("RUSTFLAGS", format!("-C linker={linker} {SIMD}"));
                command.args(arguments).args(["-Z", "build-std=std,panic_abort"]);
                command
            }
        };
        // this task itself runs under the cargo of the workspace, whose variables are of another compiler
        for name in ["RUSTUP_TOOLCHAIN", "CARGO", "RUSTDOC", "CARGO_ENCODED_RUSTFLAGS", "RUSTC_WRAPPER"] {
            command.env_remove(name);
        }
        run_in(root, command.env("CARGO_TARGET_DIR", &folder))?;
        Ok(folder.join(TARGET).join("web").join(package.replace('-', "_") + ".wasm"))
    }
}

fn sysroot_of(compiler: &Path) -> Option<PathBuf> {
    let output = Command::new(compiler).args(["--print", "sysroot"]).output().ok()?;
    Some(PathBuf::from(String::from_utf8(output.stdout).ok()?.trim()))
}
