//! `cargo xtask dist`: what a release page holds.

mod elf;
mod licences;
mod publication;
mod spdx;

use crate::ci::cargo;
use crate::python;
use crate::target;
use sha2::{Digest, Sha256};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const PACKAGE: &str = "hovertone-cli";
/// Shells and the names that their completions have by convention.
const COMPLETIONS: [(&str, &str); 5] = [
    ("bash", "hovertone.bash"),
    ("zsh", "_hovertone"),
    ("fish", "hovertone.fish"),
    ("elvish", "hovertone.elv"),
    ("powershell", "_hovertone.ps1"),
];
/// Files of the repository that a release has too.
const COPIED: [&str; 4] = ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"];
const LICENCES: &str = "THIRD-PARTY-LICENSES.md";
const SUMS: &str = "SHA256SUMS";

/// Builds everything into `target/dist` and says what is there.
pub(crate) fn run(root: &Path) -> Result<(), String> {
    publication::check(root)?;
    let triple = host_triple()?;
    let version = publication::version(root)?;
    let name = format!("hovertone-{version}-{triple}");
    let dist = target(root).join("dist");
    let program = build(root, &triple)?;
    let is_static = elf::is_static(&read(&program)?);
    let Release { folder, archive, program } = release(root, &triple, &program, &dist, &name)?;
    let mut released = vec![archive.clone(), program];
    released.extend(wheels(root, &dist)?);
    write_sums(&dist, &released)?;
    publication::rehearse(root)?;
    println!("\n{}", listing(&folder)?);
    println!("the program {}", in_words(is_static));
    println!("written: {} and {}", archive.display(), dist.join(SUMS).display());
    Ok(())
}

/// What is made of a program.
struct Release {
    folder: PathBuf,
    archive: PathBuf,
    /// The program in the folder.
    program: PathBuf,
}

/// Makes the folder of a program, with all that stands beside it, and packs it.
fn release(root: &Path, triple: &str, program: &Path, dist: &Path, name: &str) -> Result<Release, String> {
    let folder = dist.join(name);
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    make_folder(&folder)?;
    let copy = folder.join(program.file_name().map(PathBuf::from).unwrap_or_default());
    fs::copy(program, &copy).map_err(|error| format!("{}: {error}", program.display()))?;
    describe(&copy, &folder)?;
    for name in COPIED {
        fs::copy(root.join(name), folder.join(name)).map_err(|error| format!("{name}: {error}"))?;
    }
    write(&folder.join(LICENCES), &licences::text(root, triple, PACKAGE)?)?;
    Ok(Release { archive: pack(dist, name)?, folder, program: copy })
}

/// The wheel of the Python package; none without a Python that has maturin.
fn wheels(root: &Path, dist: &Path) -> Result<Vec<PathBuf>, String> {
    if !python::can_build(root) {
        println!("no wheel: there is no Python with maturin (set HOVERTONE_PYTHON)");
        return Ok(Vec::new());
    }
    let folder = dist.join("wheels");
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    python::wheel(root, &folder)?;
    let entries = fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    Ok(entries.filter_map(Result::ok).map(|entry| entry.path()).collect())
}

fn in_words(is_static: Option<bool>) -> &'static str {
    match is_static {
        Some(true) => "needs no library of the system",
        Some(false) => "needs libraries of the system",
        None => "is of a system whose programs this task cannot look into",
    }
}

/// The triple of this machine.
fn host_triple() -> Result<String, String> {
    let output = Command::new("rustc").arg("-vV").output().map_err(|error| format!("rustc: {error}"))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let triple = text.lines().find_map(|line| line.strip_prefix("host: "));
    triple.map(str::to_owned).ok_or_else(|| "rustc -vV names no host".to_owned())
}

/// A stripped program. The triple is named, so that the flag holds for the program alone, and not for the macros that build it.
fn build(root: &Path, triple: &str) -> Result<PathBuf, String> {
    println!("== build");
    let variables = [("RUSTFLAGS", "-C target-feature=+crt-static"), ("CARGO_PROFILE_RELEASE_STRIP", "symbols")];
    cargo(root, &["build", "--release", "--locked", "--target", triple, "-p", PACKAGE], &variables)?;
    let ending = if triple.contains("windows") { ".exe" } else { "" };
    Ok(target(root).join(triple).join("release").join(format!("hovertone{ending}")))
}

/// Completions and man pages, by the program itself.
fn describe(program: &Path, folder: &Path) -> Result<(), String> {
    let completions = folder.join("completions");
    make_folder(&completions)?;
    for (shell, name) in COMPLETIONS {
        // without the vehicles of the person who builds
        write(
            &completions.join(name),
            &output_of(Command::new(program).args(["completions", shell]).env("XDG_CONFIG_HOME", folder))?,
        )?;
    }
    let pages = folder.join("man");
    output_of(Command::new(program).args(["man", "-o"]).arg(&pages))?;
    // this list is for a later run of `man` into the same folder; in a release the checksum of the archive covers the pages
    let list = pages.join("files.sha256");
    std::fs::remove_file(&list).map_err(|error| format!("{}: {error}", list.display()))
}

/// A packed folder. The same files give the same bytes.
fn pack(dist: &Path, name: &str) -> Result<PathBuf, String> {
    let archive = dist.join(format!("{name}.tar.gz"));
    let mut tar = Command::new("tar");
    tar.args(["--sort=name", "--owner=0", "--group=0", "--numeric-owner", "--mtime=@0", "-czf"]);
    output_of(tar.arg(&archive).arg("-C").arg(dist).arg(name))?;
    Ok(archive)
}

/// The file of checksums, as `sha256sum --check` reads it.
fn write_sums(dist: &Path, files: &[PathBuf]) -> Result<(), String> {
    let mut text = String::new();
    for file in files {
        let name = file.strip_prefix(dist).unwrap_or(file);
        let hash = Sha256::digest(read(file)?);
        let hexadecimal: String = hash.iter().map(|byte| format!("{byte:02x}")).collect();
        // writing to a string does not fail
        let _ = writeln!(text, "{hexadecimal}  {}", name.display());
    }
    write(&dist.join(SUMS), &text)
}

/// The files of a folder with their sizes.
fn listing(folder: &Path) -> Result<String, String> {
    let mut lines = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        let entries = fs::read_dir(&next).map_err(|error| format!("{}: {error}", next.display()))?;
        for path in entries.filter_map(Result::ok).map(|entry| entry.path()) {
            if path.is_dir() {
                open.push(path);
            } else {
                let size = fs::metadata(&path).map_or(0, |facts| facts.len());
                let name = path.strip_prefix(folder).unwrap_or(&path).display().to_string();
                lines.push(format!("{name:44} {size:>10}"));
            }
        }
    }
    lines.sort();
    Ok(lines.join("\n"))
}

fn output_of(command: &mut Command) -> Result<String, String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.output().map_err(|error| format!("{name}: {error}"))?;
    if !output.status.success() {
        return Err(format!("{name} failed: {}", String::from_utf8_lossy(&output.stderr).trim()));
    }
    String::from_utf8(output.stdout).map_err(|error| format!("{name}: {error}"))
}

fn make_folder(folder: &Path) -> Result<(), String> {
    fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    fs::read(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_are_as_sha256sum_reads_them() {
        let dist = tempfile::tempdir().unwrap();
        let file = dist.path().join("abc");
        fs::write(&file, "abc").unwrap();
        write_sums(dist.path(), std::slice::from_ref(&file)).unwrap();
        let sums = fs::read_to_string(dist.path().join(SUMS)).unwrap();
        // FIPS 180-2, appendix B.1
        assert_eq!(sums, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad  abc\n");
    }

    /// All but the build for a release: with the program that the tests of the command line run.
    #[test]
    fn a_release_holds_program_completions_man_pages_licences_and_checksums() {
        let root = crate::root();
        let program = target(&root).join("debug").join(format!("hovertone{}", std::env::consts::EXE_SUFFIX));
        if !program.is_file() {
            println!("skipped: no {}; the tests of the whole workspace build it", program.display());
            return;
        }
        let dist = tempfile::tempdir().unwrap();
        let made = release(&root, &host_triple().unwrap(), &program, dist.path(), "hovertone-test").unwrap();
        let files = listing(&made.folder).unwrap();
        let has = |name: &str| files.lines().any(|line| line.split_whitespace().next() == Some(name));
        for name in COPIED.into_iter().chain([LICENCES, "man/hovertone.1", "man/hovertone-identify.1"]) {
            assert!(has(name), "{name} in\n{files}");
        }
        for (shell, name) in COMPLETIONS {
            let text = fs::read_to_string(made.folder.join("completions").join(name)).unwrap();
            assert!(text.contains("identify") && text.contains("--vehicle"), "{shell}");
        }
        let pages: Vec<_> = fs::read_dir(made.folder.join("man")).unwrap().map(|entry| entry.unwrap().path()).collect();
        assert!(pages.len() > 15, "{pages:?}");
        for page in &pages {
            assert!(fs::read_to_string(page).unwrap().contains(".TH"), "{}", page.display());
        }
        // the archive has the same files, and its bytes do not depend on the time
        let listed = output_of(Command::new("tar").arg("-tzf").arg(&made.archive)).unwrap();
        assert_eq!(listed.lines().filter(|line| !line.ends_with('/')).count(), files.lines().count(), "{listed}");
        let bytes = fs::read(&made.archive).unwrap();
        assert_eq!(bytes, fs::read(pack(dist.path(), "hovertone-test").unwrap()).unwrap());
        write_sums(dist.path(), &[made.archive.clone(), made.program.clone()]).unwrap();
        let check = |is_right: bool| {
            let run = Command::new("sha256sum").args(["--check", SUMS]).current_dir(dist.path()).output().unwrap();
            assert_eq!(run.status.success(), is_right, "{}", String::from_utf8_lossy(&run.stdout));
        };
        check(true);
        fs::write(&made.archive, "changed").unwrap();
        check(false);
    }

    #[test]
    fn the_host_has_a_triple() {
        assert!(host_triple().unwrap().matches('-').count() >= 2);
    }
}
