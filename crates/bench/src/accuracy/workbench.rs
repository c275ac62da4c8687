//! Where the peers' scripts are and what runs them. The scripts are not part of the project: they are run where they
//! lie, beside the repository.

use crate::workspace::{output_of, target};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What `--install-peers` asks pip for: what the scripts need, then the peers.
const PIP_PACKAGES: [&str; 9] =
    ["numpy", "scipy", "soundfile", "librosa", "rota-order", "praat-parselmouth", "ssqueezepy", "swift-f0", "essentia"];
const NPM_PACKAGE: &str = "pitchy";

pub(crate) struct Workbench {
    /// The peers' scripts.
    scripts: PathBuf,
    /// What is made on the way.
    folder: PathBuf,
}

impl Workbench {
    /// `None` where the scripts are not beside the repository.
    pub(crate) fn beside(root: &Path) -> Option<Self> {
        let scripts = fs::canonicalize(root.join("../shared/peers")).ok()?;
        Some(Self { scripts, folder: target(root).join("accuracy") })
    }

    /// A folder for what is made, there when it returns.
    pub(crate) fn folder(&self, name: &str) -> Result<PathBuf, String> {
        let folder = self.folder.join(name);
        fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        fs::canonicalize(&folder).map_err(|error| format!("{}: {error}", folder.display()))
    }

    pub(crate) fn script(&self, name: &str) -> PathBuf {
        self.scripts.join(name)
    }

    /// The Python of the bench's own environment, else the one on the path.
    pub(crate) fn python(&self) -> Command {
        let own = self.folder.join("venv/bin/python");
        Command::new(if own.exists() { own } else { PathBuf::from("python3") })
    }

    /// Node, where it finds the installed packages.
    pub(crate) fn node(&self) -> Result<Command, String> {
        let mut node = Command::new("node");
        node.current_dir(self.folder("js")?);
        Ok(node)
    }

    /// Installs the peers that come from pip and npm; says what could not be installed.
    pub(crate) fn install(&self) -> Result<(), String> {
        let venv = self.folder("")?.join("venv");
        output_of(Command::new("python3").args(["-m", "venv"]).arg(&venv))?;
        for package in PIP_PACKAGES {
            eprintln!("installing {package}");
            let arguments = ["-m", "pip", "install", "-q", "--disable-pip-version-check", package];
            if let Err(error) = output_of(self.python().args(arguments)) {
                eprintln!("{package} is left out: {error}");
            }
        }
        eprintln!("installing {NPM_PACKAGE}");
        let arguments = ["install", "--silent", "--no-fund", "--no-audit", NPM_PACKAGE];
        if let Err(error) = output_of(Command::new("npm").args(arguments).current_dir(self.folder("js")?)) {
            eprintln!("{NPM_PACKAGE} is left out: {error}");
        }
        Ok(())
    }

    /// Names and versions of what is installed, as `pip` and the system's package manager tell them.
    pub(crate) fn versions(&self) -> String {
        let listed = output_of(self.python().args(["-m", "pip", "list", "--format=freeze"])).unwrap_or_default();
        let mut versions: Vec<String> = listed
            .lines()
            .filter_map(|line| line.split_once("=="))
            .filter(|(name, _)| PIP_PACKAGES.iter().any(|package| package.eq_ignore_ascii_case(name)))
            .map(|(name, version)| format!("{name} {version}"))
            .collect();
        let package = self.folder.join("js/node_modules").join(NPM_PACKAGE).join("package.json");
        let described = fs::read_to_string(package).ok();
        let described = described.and_then(|text| serde_json::from_str::<serde_json::Value>(&text).ok());
        if let Some(version) = described.as_ref().and_then(|described| described["version"].as_str()) {
            versions.push(format!("{NPM_PACKAGE} {version}"));
        }
        let query = ["-W", "-f", "${Version}", "aubio-tools"];
        if let Ok(version) = output_of(Command::new("dpkg-query").args(query)) {
            versions.push(format!("aubio-tools {version}"));
        }
        versions.join(", ")
    }
}
