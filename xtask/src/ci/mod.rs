//! Everything that continuous integration checks, in the order in which a mistake is cheapest.

mod ignored;
mod test_log;

use crate::target;
use crate::tidy;
use crate::tree::Tree;
use crate::words;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;
use test_log::TestLog;

/// Test programs that the end of the run lists.
const SLOWEST_SHOWN: usize = 10;

/// Which tests run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Extent {
    /// All but the ignored ones.
    Quick,
    /// Those marked `#[ignore = "exam: …"]` as well.
    All,
}

pub(crate) fn run(root: &Path, extent: Extent) -> Result<(), String> {
    let mut steps = Steps::default();
    let mut log = TestLog::shown();
    steps.run("tidy", || tidy::run(root))?;
    steps.run("words", || words::run(root))?;
    steps.run("format", || cargo(root, &["fmt", "--all", "--check"], &[]))?;
    let clippy = ["clippy", "--workspace", "--all-targets", "--locked", "--", "--deny", "warnings"];
    steps.run("clippy", || cargo(root, &clippy, &[]))?;
    steps.run("build of the tests", || cargo(root, &[&TESTS[..], &["--tests", "--no-run"]].concat(), &[]))?;
    steps.run("tests", || tests(root, extent, &mut log))?;
    // An example marked `ignore` in a comment is not made to run: the exams are tests.
    steps.run("tests of the documentation", || cargo_test(root, &["--doc"], &["--show-output"], &mut log))?;
    let doc = ["doc", "--workspace", "--no-deps", "--locked"];
    steps.run("documentation", || cargo(root, &doc, &[("RUSTDOCFLAGS", "--deny warnings")]))?;
    if log.passed == 0 {
        return Err("no test ran".to_owned());
    }
    steps.print();
    print_log(&log, extent);
    println!("{} passed, 0 failed, {} skipped", log.passed, log.skipped.len());
    Ok(())
}

const TESTS: [&str; 3] = ["test", "--workspace", "--locked"];

fn tests(root: &Path, extent: Extent, log: &mut TestLog) -> Result<(), String> {
    let tests = ignored::test_functions(&Tree::read(root)?);
    let mut options = vec!["--show-output"];
    if extent == Extent::All {
        options.push("--include-ignored");
        for name in ignored::never_run(&tests)? {
            log.add(&format!("left out: {name}, ignored for another reason than \"exam: …\""));
            options.extend(["--skip", name]);
        }
    }
    cargo_test(root, &["--tests"], &options, log)
}

/// Runs tests and adds their output to the log.
fn cargo_test(root: &Path, which: &[&str], options: &[&str], log: &mut TestLog) -> Result<(), String> {
    // Cargo names the program on one stream, the program reports on the other: read as one, they are in order.
    let (reader, writer) = std::io::pipe().map_err(|error| format!("no pipe for the output of cargo test: {error}"))?;
    let errors = writer.try_clone().map_err(|error| format!("no pipe for the output of cargo test: {error}"))?;
    let mut child = Command::new("cargo")
        .args(TESTS)
        .args(which)
        .arg("--")
        .args(options)
        .env("CARGO_TERM_COLOR", "never")
        .current_dir(root)
        .stdout(writer)
        .stderr(errors)
        .spawn()
        .map_err(|error| format!("cargo test could not start: {error}"))?;
    for line in BufReader::new(reader).lines() {
        let line = line.map_err(|error| format!("cargo test's output could not be read: {error}"))?;
        log.add(&line);
    }
    let status = child.wait().map_err(|error| format!("cargo test did not end: {error}"))?;
    if status.success() { Ok(()) } else { Err("tests failed".to_owned()) }
}

fn print_log(log: &TestLog, extent: Extent) {
    println!("\nslowest test programs");
    for program in log.slowest(SLOWEST_SHOWN) {
        println!("{:>8.1} s  {}", program.seconds, program.name);
    }
    if log.ignored > 0 && extent == Extent::Quick {
        println!("\n{} tests did not run; `cargo xtask ci --all` runs the exams among them", log.ignored);
    }
    if !log.skipped.is_empty() {
        println!("\n{} tests had nothing to test:", log.skipped.len());
        log.skipped.iter().for_each(|reason| println!("  {reason}"));
    }
    println!();
}

/// The steps that were run, with their times.
#[derive(Default)]
struct Steps {
    done: Vec<Step>,
}

struct Step {
    name: &'static str,
    seconds: f64,
}

impl Steps {
    fn run(&mut self, name: &'static str, work: impl FnOnce() -> Result<(), String>) -> Result<(), String> {
        println!("\n== {name}");
        let started = Instant::now();
        let outcome = work();
        let seconds = started.elapsed().as_secs_f64();
        self.done.push(Step { name, seconds });
        println!("== {name}: {seconds:.1} s");
        outcome
    }

    fn print(&self) {
        println!("\n== done");
        for step in &self.done {
            println!("{:>8.1} s  {}", step.seconds, step.name);
        }
        println!("{:>8.1} s  in all", self.done.iter().map(|step| step.seconds).sum::<f64>());
    }
}

/// Builds the program for tasks that run it, together with the module for Python: with the same features, so that nothing is built twice.
pub(crate) fn build_program(root: &Path) -> Result<PathBuf, String> {
    let features = "hovertone-cli/stores,hovertone-python/stores";
    cargo(root, &["build", "--locked", "-p", "hovertone-cli", "-p", "hovertone-python", "--features", features], &[])?;
    Ok(target(root).join("debug").join("hovertone"))
}

pub(crate) fn cargo(root: &Path, arguments: &[&str], variables: &[(&str, &str)]) -> Result<(), String> {
    let status = Command::new("cargo")
        .args(arguments)
        .envs(variables.iter().copied())
        .current_dir(root)
        .status()
        .map_err(|error| format!("cargo could not start: {error}"))?;
    if status.success() { Ok(()) } else { Err(format!("cargo {} failed", arguments.join(" "))) }
}

#[cfg(test)]
mod tests {
    use super::{Extent, cargo_test, tests};
    use crate::ci::test_log::TestLog;
    use std::fs;
    use std::path::Path;

    /// A library with three tests that run, one of which has nothing to test, one of the documentation, an exam and a measurement; and a
    /// program with a test.
    const FILES: [(&str, &str); 9] = [
        ("Cargo.toml", "[workspace]\nmembers = [\"crates/*\"]\nresolver = \"3\""),
        (
            "Cargo.lock",
            "version = 4\n\n[[package]]\nname = \"program\"\nversion = \"0.1.0\"\n\n\
             [[package]]\nname = \"tested\"\nversion = \"0.1.0\"\n",
        ),
        ("ARCHITECTURE.md", ""),
        ("xtask/src/main.rs", ""),
        ("crates/tested/Cargo.toml", "[package]\nname = \"tested\"\nversion = \"0.1.0\"\nedition = \"2024\""),
        ("crates/program/Cargo.toml", "[package]\nname = \"program\"\nversion = \"0.1.0\"\nedition = \"2024\""),
        ("crates/program/src/main.rs", "fn main() {}\n#[test]\nfn inside() {}"),
        ("crates/tested/src/lib.rs", "//! ```\n//! assert!(true);\n//! ```\n#[test]\nfn inside() {}"),
        (
            "crates/tested/tests/outside.rs",
            "#[test] fn plain() {}\n#[test] fn without_data() { println!(\"skipped: no data\"); }\n\
             #[test] #[ignore = \"exam: minutes\"] fn long() {}\n\
             #[test] #[ignore = \"a measurement\"] fn speed() { panic!() }",
        ),
    ];

    fn log(root: &Path, extent: Extent) -> TestLog {
        // Not shown: the run that runs this test counts the lines that it shows.
        let mut log = TestLog::default();
        tests(root, extent, &mut log).unwrap();
        cargo_test(root, &["--doc"], &["--show-output"], &mut log).unwrap();
        log
    }

    #[test]
    #[ignore = "exam: builds a small workspace"]
    fn exams_run_with_all_and_measurements_never() {
        let root = tempfile::tempdir().unwrap();
        for (path, text) in FILES {
            let path = root.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let quick = log(root.path(), Extent::Quick);
        assert_eq!((quick.passed, quick.ignored, quick.skipped.len()), (5, 2, 1));
        let all = log(root.path(), Extent::All);
        assert_eq!((all.passed, all.ignored, all.skipped.len()), (6, 0, 1));
        let programs: Vec<&str> = all.slowest(9).iter().map(|program| program.name.as_str()).collect();
        for name in [
            "program (unittests src/main.rs)",
            "tested (unittests src/lib.rs)",
            "outside (tests/outside.rs)",
            "documentation of tested",
        ] {
            assert!(programs.contains(&name), "{programs:?}");
        }
    }
}
