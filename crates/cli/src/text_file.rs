//! Files of text, and names that promise another kind of file.

use crate::failure::Failure;
use crate::recording_files::has_ending_of_recording;
use std::path::Path;

/// Endings of files that hold something else than a table or settings.
const OF_OTHERS: [&str; 15] =
    ["bbl", "bin", "gif", "html", "jpeg", "jpg", "json", "md", "ods", "parquet", "pdf", "png", "svg", "ulg", "xlsx"];

/// A kind of text that a command writes.
#[derive(Clone, Copy)]
pub(crate) struct TextKind {
    /// What is written, at the beginning of "… is written as CSV".
    pub(crate) content: &'static str,
    pub(crate) format: TextFormat,
    /// A flag with a good name.
    pub(crate) example: &'static str,
}

/// Formats of text.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum TextFormat {
    Csv,
    Toml,
}

impl TextFormat {
    /// Its name and the ending of its files.
    fn words(self) -> [&'static str; 2] {
        match self {
            Self::Csv => ["CSV", "csv"],
            Self::Toml => ["TOML", "toml"],
        }
    }
}

impl TextKind {
    /// Refuses a name that promises another kind of file, such as a picture or a recording. Other names, and names without an ending, may be.
    pub(crate) fn check(self, place: &Path) -> Result<(), Failure> {
        let Some(ending) = place.extension().and_then(|ending| ending.to_str()) else { return Ok(()) };
        let lower = ending.to_lowercase();
        let is_other_text = [TextFormat::Csv, TextFormat::Toml]
            .iter()
            .any(|format| *format != self.format && format.words()[1] == lower);
        if !(is_other_text || OF_OTHERS.contains(&lower.as_str()) || has_ending_of_recording(place)) {
            return Ok(());
        }
        let [format, own] = self.format.words();
        Err(Failure::Usage {
            what: format!(
                "{} is written as {format}, but the name ends with .{ending}: nothing was written",
                self.content
            ),
            hint: format!("choose a name that ends with .{own}, as in {}", self.example),
            path: Some(place.to_owned()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_of_another_kind_of_file_is_refused() {
        let kind = |format| TextKind { content: "the track", format, example: "--track track.csv" };
        let csv = |name: &str| kind(TextFormat::Csv).check(Path::new(name));
        for name in ["track.csv", "track.CSV", "track.txt", "track", "flight.2", "/dev/null"] {
            assert!(csv(name).is_ok(), "{name}");
        }
        for name in ["track.wav", "track.MP4", "track.png", "track.toml", "a/track.json"] {
            assert!(csv(name).is_err(), "{name}");
        }
        let toml = |name: &str| kind(TextFormat::Toml).check(Path::new(name));
        assert!(toml("scenario.toml").is_ok() && toml("scenario.csv").is_err());
    }
}
