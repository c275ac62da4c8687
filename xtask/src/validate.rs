//! `cargo xtask validate`: what is exported, in the hands of programs that are not ours.

use crate::ci::build_program;
use crate::target;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What pip is asked for; the scripts were written for these.
const PACKAGES: [&str; 4] = ["rotorpy==3.0.0", "pyyaml", "xacro==2.1.1", "pybullet==3.2.7"];
/// The preset has no diameter: any will do, for what is written and read with the same one.
const AIRSIM_NEEDS: [&str; 4] = ["--diameter-m", "0.2", "--air-density-kg-m3", "1.17"];

/// Runs the demo, exports it to all formats, lets rotorpy hover with it, and writes `validation/rotorpy/hover.json`. Then the exports, and
/// models that were changed in place, go to the programs that they are for: `validation/models/checked.json`.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    let folder = target(root).join("validate");
    let exports = folder.join("exports");
    fs::create_dir_all(&exports).map_err(|error| format!("{}: {error}", exports.display()))?;
    let hovertone = build_program(root)?;
    let demo = folder.join("demo");
    run_quietly(Command::new(&hovertone).arg("demo").arg("--no-progress").arg("-o").arg(&demo))?;
    let results = demo.join("results.json");
    for format in formats(&hovertone)? {
        let more: &[&str] = if format == "airsim" { &AIRSIM_NEEDS } else { &[] };
        let out = exports.join(&format);
        run_quietly(
            Command::new(&hovertone)
                .arg("export")
                .arg(&results)
                .args(["--to", &format])
                .args(more)
                .arg("--force")
                .arg("-o")
                .arg(out),
        )?;
    }
    let python = python_with_rotorpy(&folder)?;
    let scripts = root.join("validation").join("rotorpy");
    let out = scripts.join("hover.json");
    run_script(Command::new(&python).arg(scripts.join("hover.py")).args([&results, &exports, &out]))?;
    println!("written: {}", out.display());
    let scripts = root.join("validation").join("models");
    let out = scripts.join("checked.json");
    let files = [&hovertone, &results, &exports, &out];
    run_script(Command::new(&python).arg(scripts.join("check.py")).args(files))?;
    println!("written: {}", out.display());
    Ok(())
}

/// All names that `hovertone export --to` takes.
fn formats(hovertone: &Path) -> Result<Vec<String>, String> {
    let output = Command::new(hovertone).args(["export", "-h"]).output();
    let output = output.map_err(|error| format!("{}: {error}", hovertone.display()))?;
    formats_in(&String::from_utf8_lossy(&output.stdout))
}

/// The names in a short help text: "[possible values: gazebo, rotors]".
fn formats_in(help: &str) -> Result<Vec<String>, String> {
    let names = help.split_once("[possible values:").and_then(|(_, rest)| rest.split_once(']'));
    let (names, _) = names.ok_or("hovertone export -h lists no formats")?;
    Ok(names.split(',').map(|name| name.trim().to_owned()).collect())
}

/// Runs a script that asserts.
fn run_script(command: &mut Command) -> Result<(), String> {
    let status = command.status().map_err(|error| format!("python: {error}"))?;
    if status.success() { Ok(()) } else { Err("another program does not agree: see the assertion above".to_owned()) }
}

/// A Python of its own with rotorpy, kept between runs.
fn python_with_rotorpy(folder: &Path) -> Result<PathBuf, String> {
    let venv = folder.join("venv");
    let python = venv.join("bin").join("python");
    if !python.exists() {
        run_quietly(Command::new("python3").args(["-m", "venv"]).arg(&venv))?;
    }
    run_quietly(
        Command::new(&python).args(["-m", "pip", "install", "-q", "--disable-pip-version-check"]).args(PACKAGES),
    )?;
    Ok(python)
}

/// Runs a command and shows what it said only when it failed.
fn run_quietly(command: &mut Command) -> Result<(), String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.output().map_err(|error| format!("{name}: {error}"))?;
    if output.status.success() {
        return Ok(());
    }
    Err(format!("{name} failed: {}", String::from_utf8_lossy(&output.stderr).trim()))
}

#[cfg(test)]
mod tests {
    use super::formats_in;

    #[test]
    fn every_format_of_the_help_is_exported() {
        let help =
            "--to <FORMAT>  Which program [possible values: gazebo,\n       airsim, px4]\n --diameter-m [default: 1]";
        assert_eq!(formats_in(help).unwrap(), ["gazebo", "airsim", "px4"]);
        assert!(formats_in("no formats").is_err());
    }
}
