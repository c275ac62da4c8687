//! The cases of the exam: each recording of a truth file with each of its flags.

use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// Shaft speeds from the slowest to the fastest, rev/s.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub(super) struct SpeedRange {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl From<[f64; 2]> for SpeedRange {
    fn from([low, high]: [f64; 2]) -> Self {
        Self { low, high }
    }
}

impl From<SpeedRange> for [f64; 2] {
    fn from(range: SpeedRange) -> Self {
        [range.low, range.high]
    }
}

impl SpeedRange {
    /// Does a speed lie in the range, or within 3 standard uncertainties of it?
    pub(super) fn holds(self, speed_rev_s: f64, std_rev_s: f64) -> bool {
        (self.low - 3.0 * std_rev_s..=self.high + 3.0 * std_rev_s).contains(&speed_rev_s)
    }
}

/// A recording and what is known of it. `../shared/data/README.md` says how each field was found.
#[derive(Clone, Debug, Default, Deserialize)]
pub(super) struct Truth {
    pub(super) file: String,
    /// A table with the speed of each rotor at every instant.
    #[serde(default)]
    pub(super) truth_csv: Option<String>,
    #[serde(rename = "cls")]
    pub(super) class: String,
    pub(super) kind: String,
    pub(super) confidence: String,
    pub(super) flags: Vec<Vec<String>>,
    #[serde(default)]
    pub(super) blades: Option<u32>,
    #[serde(default)]
    pub(super) speeds_rev_s: Vec<f64>,
    /// The stretch for which the speeds are known.
    #[serde(default)]
    pub(super) span_s: Option<[f64; 2]>,
    /// How far a separated rotor may be from the speed of a true one.
    #[serde(default)]
    pub(super) tolerance_rev_s: Option<f64>,
    /// How far the mean may be from the mean of the table.
    #[serde(default)]
    pub(super) mean_tolerance_rev_s: Option<f64>,
    /// For the stretch of `--from` and `--to`.
    #[serde(default)]
    pub(super) accept_rev_s: Option<SpeedRange>,
    /// For the whole file, where it differs.
    #[serde(default)]
    pub(super) accept_whole_rev_s: Option<SpeedRange>,
    /// For the mean of all rotors.
    #[serde(default)]
    pub(super) accept_rotors_rev_s: Option<SpeedRange>,
    #[serde(default)]
    pub(super) also_accept_rev_s: Vec<SpeedRange>,
    #[serde(default)]
    pub(super) declining_is_right: bool,
}

impl Truth {
    pub(super) fn is_low_confidence(&self) -> bool {
        self.confidence == "low"
    }

    /// The mean of the known speeds; else the middle of the accepted range.
    pub(super) fn mean_rev_s(&self) -> Option<f64> {
        let middle = self.accept_rev_s.map(|range| f64::midpoint(range.low, range.high));
        let count = self.speeds_rev_s.len();
        if count > 0 { Some(self.speeds_rev_s.iter().sum::<f64>() / count as f64) } else { middle }
    }

    /// The range for the whole file.
    pub(super) fn whole_range(&self) -> Option<SpeedRange> {
        self.accept_whole_rev_s.or(self.accept_rev_s)
    }
}

/// What the flags tell the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Told {
    /// The blades, the order or the vehicle.
    Blades,
    /// Nothing.
    Blind,
    /// Blades, rotors, diameter and mass.
    Known,
    /// Blades and several rotors.
    Rotors,
}

/// What the flags tell, and whether they choose the stretch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Mode {
    pub(super) told: Told,
    pub(super) is_spanned: bool,
}

impl Mode {
    pub(super) fn of(flags: &[String]) -> Self {
        let has = |name: &str| flags.iter().any(|flag| flag == name);
        let told = if has("--diameter-m") {
            Told::Known
        } else if has("--rotors") {
            Told::Rotors
        } else if has("--blades") || has("--order") || has("--vehicle") {
            Told::Blades
        } else {
            Told::Blind
        };
        Self { told, is_spanned: has("--from") }
    }

    /// "blades+span".
    pub(super) fn name(self) -> String {
        let told = match self.told {
            Told::Blind => "blind",
            Told::Blades => "blades",
            Told::Known => "known",
            Told::Rotors => "rotors4",
        };
        format!("{told}{}", if self.is_spanned { "+span" } else { "" })
    }
}

/// A truth file with its folder.
pub(super) struct TruthSet {
    /// "real" or "semi-real".
    pub(super) name: &'static str,
    folder: PathBuf,
    pub(super) truths: Vec<Truth>,
}

/// One run of the program.
pub(super) struct Case<'a> {
    pub(super) truth: &'a Truth,
    pub(super) flags: &'a [String],
}

impl TruthSet {
    /// Reads `truth.json` of a folder.
    pub(super) fn read(name: &'static str, folder: &Path) -> Result<Self, String> {
        let path = folder.join("truth.json");
        let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let truths: Vec<Truth> = serde_json::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))?;
        if truths.is_empty() {
            return Err(format!("{}: it lists no recording", path.display()));
        }
        Ok(Self { name, folder: folder.to_owned(), truths })
    }

    /// A file beside the truth, or beside its folder.
    pub(super) fn path(&self, file: &str) -> PathBuf {
        let beside = self.folder.join(file);
        if beside.exists() { beside } else { self.folder.join("..").join(file) }
    }

    pub(super) fn cases(&self) -> Vec<Case<'_>> {
        let cases = self.truths.iter();
        cases.flat_map(|truth| truth.flags.iter().map(move |flags| Case { truth, flags })).collect()
    }

    /// Keeps the recordings of which `is_kept` says so.
    pub(super) fn keep(&mut self, is_kept: impl Fn(&Truth) -> bool) {
        self.truths.retain(is_kept);
    }
}

#[cfg(test)]
mod tests {
    use super::{Mode, Truth};

    #[test]
    fn the_mode_is_what_the_flags_tell() {
        let name = |flags: &str| Mode::of(&flags.split_whitespace().map(str::to_owned).collect::<Vec<_>>()).name();
        assert_eq!(name(""), "blind");
        assert_eq!(name("--channel 1"), "blind");
        assert_eq!(name("--blades 2 --from 3 --to 9"), "blades+span");
        assert_eq!((name("--order 1"), name("--vehicle crazyflie")), ("blades".to_owned(), "blades".to_owned()));
        assert_eq!(name("--blades 2 --rotors 4"), "rotors4");
        assert_eq!(name("--blades 2 --rotors 4 --diameter-m 0.24 --mass-kg 1.3"), "known");
    }

    #[test]
    fn fields_that_are_missing_or_null_are_none() {
        let text = r#"{"file":"a.wav","cls":"c","kind":"multi","confidence":"low","flags":[[],["--blades","2"]],
                       "accept_rev_s":[1,2],"accept_whole_rev_s":null,"tone_hz":[1,2],"notes":""}"#;
        let truth: Truth = serde_json::from_str(text).unwrap();
        assert!(truth.is_low_confidence() && truth.accept_rotors_rev_s.is_none() && !truth.declining_is_right);
        assert_eq!(truth.whole_range().map(|range| range.high), Some(2.0));
    }
}
