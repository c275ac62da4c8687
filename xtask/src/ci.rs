//! Everything that continuous integration checks, in the order in which a mistake is cheapest.

use crate::tidy;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

pub(crate) fn run(root: &Path) -> Result<(), String> {
    let started = Instant::now();
    let step = |name: &str| println!("\n== {name} ({:.0} s)", started.elapsed().as_secs_f64());
    step("tidy");
    tidy::run(root)?;
    step("format");
    cargo(root, &["fmt", "--all", "--check"], &[])?;
    step("clippy");
    cargo(root, &["clippy", "--workspace", "--all-targets", "--locked", "--", "--deny", "warnings"], &[])?;
    step("tests");
    let counts = tests(root)?;
    step("documentation");
    cargo(root, &["doc", "--workspace", "--no-deps", "--locked"], &[("RUSTDOCFLAGS", "--deny warnings")])?;
    step("done");
    println!("{} passed, 0 failed, {} skipped", counts.passed, counts.skipped);
    Ok(())
}

struct Counts {
    passed: u32,
    skipped: u32,
}

/// Runs all tests and counts what ran: a run without tests is a failure, and what was skipped for want of recordings is
/// said.
fn tests(root: &Path) -> Result<Counts, String> {
    let mut child = Command::new("cargo")
        .args(["test", "--workspace", "--locked", "--", "--show-output"])
        .current_dir(root)
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|error| format!("cargo test could not start: {error}"))?;
    let mut counts = Counts { passed: 0, skipped: 0 };
    let mut reasons: Vec<String> = Vec::new();
    for line in child.stdout.take().map(BufReader::new).into_iter().flat_map(BufRead::lines) {
        let line = line.map_err(|error| format!("cargo test's output could not be read: {error}"))?;
        println!("{line}");
        if let Some(result) = line.strip_prefix("test result: ") {
            counts.passed += passed(result);
        } else if line.starts_with("skipped:") {
            counts.skipped += 1;
            reasons.push(line);
        }
    }
    let status = child.wait().map_err(|error| format!("cargo test did not end: {error}"))?;
    if !status.success() {
        return Err("tests failed".to_owned());
    }
    if counts.passed == 0 {
        return Err("no test ran".to_owned());
    }
    if !reasons.is_empty() {
        println!("\n{} tests had nothing to test:", reasons.len());
        reasons.iter().for_each(|reason| println!("  {reason}"));
    }
    Ok(counts)
}

/// The number before "passed" in the closing line of a test program.
fn passed(result: &str) -> u32 {
    let words: Vec<&str> = result.split_whitespace().collect();
    words.windows(2).find(|pair| pair[1].starts_with("passed")).and_then(|pair| pair[0].parse().ok()).unwrap_or(0)
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
    use super::passed;

    #[test]
    fn the_closing_line_is_understood() {
        assert_eq!(passed("ok. 33 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.06s"), 33);
        assert_eq!(passed("nonsense"), 0);
    }
}
