//! What can be typed after `real`.

use super::{REAL, semi_real};

/// What the exam is asked for.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Options {
    /// Folder of the recordings, which holds `real/truth.json`.
    pub(super) data: Option<String>,
    /// Folder of the semi-real recordings, made before.
    pub(super) semi_real: Option<String>,
    /// The program to examine.
    pub(super) hovertone: Option<String>,
    /// One class alone: printed, and nothing is written into `docs`.
    pub(super) only: Option<String>,
    /// Print the cases that are right, too.
    pub(super) all: bool,
    /// The subset of continuous integration, with its floors.
    pub(super) ci: bool,
    /// The sets that the other programs hear, too.
    pub(super) peers: Vec<String>,
    /// Where the rows go.
    pub(super) out: Option<String>,
    /// Rows of another run.
    pub(super) compare: Option<String>,
}

pub(super) const USAGE: &str = "cargo run --release -p hovertone-bench -- real [--data DIR] [--semi-real DIR] [--hovertone PATH] [--only CLASS] \
                                [--all] [--ci] [--peers] [--peers-of real|semi-real] \
                                [--out ROWS.json] [--compare ROWS.json]";

impl Options {
    pub(super) fn from_words(words: &[&str]) -> Result<Self, String> {
        let mut options = Self::default();
        let mut words = words.iter();
        while let Some(name) = words.next() {
            let mut value = || words.next().map(|value| Some((*value).to_owned())).ok_or_else(|| USAGE.to_owned());
            match *name {
                "--all" => options.all = true,
                "--ci" => options.ci = true,
                "--peers" => options.peers = [REAL, semi_real::NAME].map(str::to_owned).to_vec(),
                "--peers-of" => options.peers.extend(value()?),
                "--data" => options.data = value()?,
                "--semi-real" => options.semi_real = value()?,
                "--hovertone" => options.hovertone = value()?,
                "--only" => options.only = value()?,
                "--out" => options.out = value()?,
                "--compare" => options.compare = value()?,
                _ => return Err(format!("{name} is unknown: {USAGE}")),
            }
        }
        Ok(options)
    }

    /// The file of the rows, unless `--out` says another.
    pub(super) fn rows_name(&self) -> &'static str {
        if self.is_whole() {
            "rows.json"
        } else if self.ci {
            "rows-of-ci.json"
        } else {
            "rows-of-a-class.json"
        }
    }

    /// Is the whole exam run, so that its report can be written?
    pub(super) fn is_whole(&self) -> bool {
        self.only.is_none() && !self.ci
    }
}

#[cfg(test)]
mod tests {
    use super::Options;

    #[test]
    fn options_are_read_and_unknown_ones_refused() {
        let options = Options::from_words(&["--all", "--only", "m300", "--out", "rows.json"]).unwrap();
        assert!(options.all && !options.is_whole() && options.only.as_deref() == Some("m300"));
        assert!(Options::from_words(&[]).unwrap().is_whole());
        assert!(Options::from_words(&["--only"]).is_err());
        assert_eq!(Options::from_words(&["--peers"]).unwrap().peers, ["real", "semi-real"]);
        assert_eq!(Options::from_words(&["--peers-of", "real"]).unwrap().peers, ["real"]);
        assert!(Options::from_words(&["--al"]).unwrap_err().starts_with("--al is unknown"));
    }
}
