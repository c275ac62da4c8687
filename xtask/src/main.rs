//! What CI does and a person types: `cargo xtask ci`, `tidy`, `words`, `python`, `validate`, `dist`, `page`.

#![allow(clippy::print_stdout, clippy::print_stderr)] // a tool for people at a terminal

mod ci;
mod dist;
mod page;
mod python;
mod tidy;
mod tree;
mod validate;
mod words;

use ci::Extent;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const HELP: &str = "cargo xtask <task>

  ci           tidy, words, format, clippy, tests, documentation; without the exams
  ci --all     the same, with the exams, which are tests marked #[ignore = \"exam: …\"]: continuous integration runs this
  tidy         rules of the house that no compiler knows: each fault with file, line and what to do
  tidy --list  the number of faults of each rule, and in which files
  words        no string, help text, page or document has an expression that docs/glossary.md forbids
  python       the Python package: built, installed with pip, its types checked (mypy, stubtest), its tests, examples, documents and notebook run;
               in the Python of HOVERTONE_PYTHON, or in target/python
  dist         what a release page holds, in target/dist: a stripped program without libraries of the system, completions, man pages,
               a wheel for Python where maturin is, licences of all dependencies, checksums; and whether every crate can be published (cargo publish --dry-run)
  page         the page for the browser in target/page, for any static host; --out FOLDER puts it elsewhere, --test tries it in a browser. It needs a compiler for
               WebAssembly (rustup target add wasm32-unknown-unknown) and npm; `hovertone serve` of a build with --features page serves it
  validate     exported and changed files, in the hands of other programs: rotorpy, pybullet and xacro (installed by pip); sdformat and
               urdfdom (apt-get install ignition-tools libsdformat-dev liburdfdom-tools), without which that part is left out and said; where CI is set, that is an error

Exams and benchmarks: cargo run --release -p hovertone-bench
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let outcome = match words.as_slice() {
        ["ci"] => ci::run(&root(), Extent::Quick),
        ["ci", "--all"] => ci::run(&root(), Extent::All),
        ["tidy"] => tidy::run(&root()),
        ["tidy", "--list"] => tidy::list(&root()),
        ["words"] => words::run(&root()),
        ["python"] => python::run(&root()),
        ["validate"] => validate::run(&root()),
        ["dist"] => dist::run(&root()),
        ["page", arguments @ ..] => page::run(&root(), arguments),
        _ => Err(HELP.to_owned()),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// The root of the workspace.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().map_or_else(PathBuf::new, Path::to_path_buf)
}

/// Where cargo builds, and where benches keep what they make.
fn target(root: &Path) -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from)
}
