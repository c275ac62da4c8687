//! `cargo xtask python`: the Python package, built, installed and examined as a user has it.

use crate::ci::build_program;
use crate::target;
use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What the tests need beside the package.
const NEEDED: &str = "maturin, mypy, pytest, pytest-xdist, numpy, pandas, pyarrow, matplotlib, tqdm, nbclient, ipykernel, ray[data], \
     dask[dataframe], moto[server]";
/// The number of tests in the last line of pytest: "82 passed in 60.1s".
const PASSED: &str = " passed";

/// Builds the package with the profile and the target folder of the other tests, so that no dependency is built twice; installs it with pip;
/// then runs tests, examples, documents and the notebook, and checks all types.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let package = root.join("crates").join("python");
    let python = interpreter(root)?;
    let program = build_program(root)?;
    install(&python, &package)?;
    let module = |words: &[&str]| run_in(&package, python.command().arg("-m").args(words));
    module(&["mypy", "--config-file", "pyproject.toml", "-p", "hovertone"])?;
    module(&["mypy.stubtest", "--mypy-config-file", "pyproject.toml", "hovertone._native"])?;
    tested(&python, &program, &package)
}

/// The wheel of a release, in a folder. It reads object stores: what is installed from it needs no compiler.
pub(crate) fn wheel(root: &Path, folder: &Path) -> Result<(), String> {
    let package = root.join("crates").join("python");
    let python = interpreter(root)?;
    let words = ["-m", "maturin", "build", "--release", "--locked", "--strip", "--features", "stores", "--out"];
    run_in(&package, python.command().args(words).arg(folder))
}

/// Whether there is a Python that can build a wheel.
pub(crate) fn can_build(root: &Path) -> bool {
    interpreter(root).is_ok_and(|python| {
        python.command().args(["-m", "maturin", "--version"]).output().is_ok_and(|output| output.status.success())
    })
}

/// A Python in an environment of its own.
struct Interpreter {
    program: PathBuf,
}

impl Interpreter {
    /// A command of it, which finds the programs of its environment.
    fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        let own = self.program.parent().map(Path::to_owned).into_iter();
        let all = own.chain(env::var_os("PATH").iter().flat_map(env::split_paths).collect::<Vec<_>>());
        command.env("PATH", env::join_paths(all).unwrap_or_else(|_| OsString::new()));
        command
    }
}

/// That of `HOVERTONE_PYTHON`, or the one in `target/python`.
fn interpreter(root: &Path) -> Result<Interpreter, String> {
    let named = env::var_os("HOVERTONE_PYTHON").map(PathBuf::from);
    let program = named.unwrap_or_else(|| target(root).join("python").join("bin").join("python3"));
    if program.exists() {
        return Ok(Interpreter { program });
    }
    Err(format!(
        "there is no {}: make it with `python3 -m venv`, and install {NEEDED}; or set HOVERTONE_PYTHON",
        program.display()
    ))
}

fn install(python: &Interpreter, package: &Path) -> Result<(), String> {
    // the package is built here, by maturin of this environment: pip would build it in a new one, from the network
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--no-build-isolation"];
    let profile = "build-args=--profile dev --locked --features stores";
    run_in(package, python.command().args(pip).args(["--force-reinstall", "--config-settings", profile, "."]))
}

/// Runs pytest, and refuses a run without tests.
fn tested(python: &Interpreter, program: &Path, package: &Path) -> Result<(), String> {
    let shown = ["-m", "pytest", "-q", "--no-header", "--color=no", "--durations=5"];
    // two files of tests at once, so that what one of them prepares is prepared once
    let shared = ["-n", "2", "--dist", "loadfile"];
    let output = python
        .command()
        .args(shown)
        .args(shared)
        .args(["--pyargs", "hovertone", "tests"])
        .env("HOVERTONE_PROGRAM", program)
        .current_dir(package)
        .output()
        .map_err(|error| format!("pytest could not start: {error}"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    println!("{text}{}", String::from_utf8_lossy(&output.stderr));
    if !output.status.success() {
        return Err("tests of the Python package failed".to_owned());
    }
    match passed(&text) {
        0 => Err("no test of the Python package ran".to_owned()),
        _ => Ok(()),
    }
}

/// The number of passed tests that pytest prints last.
fn passed(text: &str) -> usize {
    let last = text.lines().rev().find(|line| line.contains(PASSED)).unwrap_or_default();
    let number = last.split_once(PASSED).and_then(|(before, _)| before.rsplit([' ', '=']).next());
    number.and_then(|number| number.parse().ok()).unwrap_or(0)
}

fn run_in(folder: &Path, command: &mut Command) -> Result<(), String> {
    let words: Vec<String> = command.get_args().map(|word| word.to_string_lossy().into_owned()).collect();
    println!("== python {}", words.join(" "));
    let status = command.current_dir(folder).status().map_err(|error| format!("python: {error}"))?;
    if status.success() { Ok(()) } else { Err(format!("python {} failed", words.join(" "))) }
}

#[cfg(test)]
mod tests {
    use super::passed;

    #[test]
    fn the_number_of_tests_is_read() {
        assert_eq!(passed("....\n82 passed in 60.12s\n"), 82);
        assert_eq!(passed("== 1 failed, 81 passed, 5 warnings in 9s =="), 81);
        assert_eq!(passed("no tests ran in 0.01s"), 0);
        assert_eq!(passed(""), 0);
    }
}
