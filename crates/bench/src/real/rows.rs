//! The judged cases as rows: kept as JSON, and compared with those of another run.

use super::answer::Status;
use super::cases::SpeedRange;
use super::judgement::Verdict;
use super::rotors_told::{ExactRotors, RotorCount};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// One judged case.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub(super) struct Row {
    /// "real" or "semi-real".
    pub(super) set: String,
    pub(super) class: String,
    pub(super) mode: String,
    pub(super) is_low_confidence: bool,
    /// Is there no rotor to be heard?
    pub(super) is_negative: bool,
    /// Path of the recording, as the truth names it.
    pub(super) file: String,
    pub(super) flags: String,
    pub(super) verdict: Verdict,
    pub(super) status: Status,
    pub(super) speed_rev_s: Option<f64>,
    pub(super) combined_std_uncertainty_rev_s: Option<f64>,
    pub(super) accepted_rev_s: Option<SpeedRange>,
    pub(super) note: String,
    pub(super) reason: Option<String>,
    /// Length of a recording without a rotor.
    pub(super) heard_s: Option<f64>,
    pub(super) beliefs: Vec<Belief>,
    pub(super) rotor_count: Option<RotorCount>,
    pub(super) exact_rotors: Option<ExactRotors>,
}

/// How much the program believed in a speed, and whether it was right.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub(super) struct Belief {
    pub(super) belief: f64,
    pub(super) is_right: bool,
}

impl Row {
    /// The name of the recording without its folder.
    pub(super) fn file_name(&self) -> &str {
        self.file.rsplit('/').next().unwrap_or(&self.file)
    }

    /// The class, marked where the truth is not trusted.
    pub(super) fn trusted_class(&self) -> String {
        let mark = if self.is_low_confidence { " (low confidence)" } else { "" };
        format!("{}{mark}", self.class)
    }

    /// "84.13 ± 0.25 rev/s", or the status.
    pub(super) fn answer(&self) -> String {
        match (self.speed_rev_s, self.combined_std_uncertainty_rev_s) {
            (Some(speed), Some(std)) => format!("{speed:.2} ± {std:.2}"),
            (Some(speed), None) => format!("{speed:.2} without ±"),
            (None, _) if self.note.is_empty() => self.status.name().replace('_', " "),
            (None, _) => format!("{}: {}", self.status.name(), self.note),
        }
    }

    /// "76–89", or a dash.
    pub(super) fn accepted(&self) -> String {
        let shown = |speed: f64| format!("{speed:.2}").trim_end_matches('0').trim_end_matches('.').to_owned();
        self.accepted_rev_s.map_or("–".to_owned(), |range| format!("{}–{}", shown(range.low), shown(range.high)))
    }

    fn is_same_case(&self, other: &Self) -> bool {
        self.set == other.set && self.file == other.file && self.flags == other.flags
    }
}

/// Writes the rows as JSON.
pub(super) fn write_rows(path: &Path, rows: &[Row]) -> Result<(), String> {
    let text = serde_json::to_string_pretty(rows).map_err(|error| error.to_string())?;
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    fs::write(path, text + "\n").map_err(|error| format!("{}: {error}", path.display()))
}

/// Reads rows that another run wrote.
pub(super) fn read_rows(path: &Path) -> Result<Vec<Row>, String> {
    let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    serde_json::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))
}

/// What changed since another run: first what became right, then what is right no more, then other changes.
pub(super) fn changes(before: &[Row], now: &[Row]) -> String {
    let (mut better, mut worse, mut other, mut unmatched) = (Vec::new(), Vec::new(), Vec::new(), 0);
    for row in now {
        let Some(old) = before.iter().find(|old| old.is_same_case(row)) else {
            unmatched += 1;
            continue;
        };
        if old.verdict == row.verdict {
            continue;
        }
        let line = format!(
            "  {} {} {} [{}]: {} ({}) → {} ({}), accepted {}",
            row.trusted_class(),
            row.mode,
            row.file_name(),
            row.flags,
            old.verdict.name(),
            old.answer(),
            row.verdict.name(),
            row.answer(),
            row.accepted()
        );
        match (old.verdict, row.verdict) {
            (_, Verdict::Right) => better.push(line),
            (Verdict::Right, _) => worse.push(line),
            _ => other.push(line),
        }
    }
    let gone = before.iter().filter(|old| !now.iter().any(|row| old.is_same_case(row))).count();
    let mut text = String::new();
    for (name, lines) in [("became right", better), ("right no more", worse), ("changed otherwise", other)] {
        text += &format!("{name}: {}\n", lines.len());
        lines.iter().for_each(|line| text += &format!("{line}\n"));
    }
    if unmatched + gone > 0 {
        text += &format!("only in this run: {unmatched}; only in the other: {gone}\n");
    }
    text
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A row of a real recording that was judged so.
    pub(in crate::real) fn row(class: &str, mode: &str, verdict: Verdict) -> Row {
        Row {
            set: "real".to_owned(),
            class: class.to_owned(),
            mode: mode.to_owned(),
            is_low_confidence: false,
            is_negative: false,
            file: "real/a.wav".to_owned(),
            flags: "--blades 2".to_owned(),
            verdict,
            status: Status::Ok,
            speed_rev_s: Some(80.0),
            combined_std_uncertainty_rev_s: Some(0.5),
            accepted_rev_s: Some(SpeedRange { low: 79.0, high: 81.25 }),
            note: String::new(),
            reason: None,
            heard_s: None,
            beliefs: Vec::new(),
            rotor_count: None,
            exact_rotors: None,
        }
    }

    #[test]
    fn changes_are_told_by_case() {
        let case = |file: &str, verdict| Row { file: file.to_owned(), ..row("c", "blades", verdict) };
        let before = [
            case("a", Verdict::Right),
            case("b", Verdict::Octave),
            case("c", Verdict::Wrong),
            case("d", Verdict::Right),
            case("e", Verdict::Right),
        ];
        let now = [
            case("a", Verdict::Silent),
            case("b", Verdict::Right),
            case("c", Verdict::Octave),
            case("d", Verdict::Right),
            case("f", Verdict::Right),
        ];
        let text = changes(&before, &now);
        assert!(text.contains("became right: 1\n  c blades b [--blades 2]: octave (80.00 ± 0.50) → right"), "{text}");
        assert!(text.contains("right no more: 1\n  c blades a"), "{text}");
        assert!(text.contains("changed otherwise: 1\n  c blades c"), "{text}");
        assert!(text.ends_with("only in this run: 1; only in the other: 1\n"), "{text}");
        assert!(changes(&now, &now).ends_with("changed otherwise: 0\n"));
    }

    #[test]
    fn rows_come_back_from_their_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("below/rows.json");
        let beliefs = vec![Belief { belief: 0.5, is_right: true }];
        let rows = vec![Row { beliefs, ..row("c", "blades", Verdict::MeanOff) }];
        write_rows(&path, &rows).unwrap();
        assert_eq!(read_rows(&path).unwrap(), rows);
    }

    #[test]
    fn answers_and_ranges_are_words() {
        let ok = row("c", "blades", Verdict::Right);
        assert_eq!((ok.answer().as_str(), ok.accepted().as_str()), ("80.00 ± 0.50", "79–81.25"));
        let silent = Row { speed_rev_s: None, status: Status::NoRotorTone, accepted_rev_s: None, ..ok };
        assert_eq!((silent.answer().as_str(), silent.accepted().as_str()), ("no rotor tone", "–"));
        let open = Row { note: "truth is reading 2 of 3".to_owned(), status: Status::Ambiguous, ..silent };
        assert_eq!(open.answer(), "ambiguous: truth is reading 2 of 3");
    }
}
