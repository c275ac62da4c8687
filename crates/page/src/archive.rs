//! The page of an archive: a table of its recordings that can be sorted, with small spectrograms.

use crate::report::{PageError, STYLE};
use crate::seal::policy;
use askama::Template;
use hovertone_report::{VERSION, counted, printable, with_uncertainty};

const STYLE_OF_ROWS: &str = include_str!("../templates/style/archive.css");
const SCRIPT: &str = concat!(
    "(() => {\n\"use strict\";\n",
    include_str!("../templates/script/values.js"),
    include_str!("../templates/script/tables.js"),
    "})();\n",
);
/// Most rows of the table: a browser sorts them within a second.
const ROWS_MAX: usize = 10_000;
/// Most pictures. One has about 4 kB.
const PICTURES_MAX: usize = 2_000;

/// A speed with its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeardSpeed {
    /// Mean shaft speed.
    pub speed_rev_s: f64,
    /// Its standard uncertainty, where it is known.
    pub std_rev_s: Option<f64>,
}

impl HeardSpeed {
    fn in_words(self) -> String {
        with_uncertainty(self.speed_rev_s, self.std_rev_s)
    }
}

/// A recording of an archive.
#[derive(Clone, Debug, PartialEq)]
pub struct ArchiveRecording {
    /// Its name.
    pub file: String,
    /// `ok`, `ambiguous`, `no_rotor_tone` or `error`.
    pub status: String,
    /// Why there is no speed.
    pub reason: Option<String>,
    /// Frequency of the tone.
    pub tone_hz: Option<f64>,
    /// The mean speed.
    pub speed: Option<HeardSpeed>,
    /// The separated rotors, fastest first.
    pub rotors: Vec<HeardSpeed>,
    /// From the start to the end of the used hover.
    pub used_s: Option<(f64, f64)>,
    /// What weakens the answer.
    pub warnings: Vec<String>,
    /// Whether the speed must not be used.
    pub is_doubtful: bool,
    /// A small spectrogram as the URI of a PNG.
    pub picture: Option<String>,
}

impl ArchiveRecording {
    /// Class, sign and meaning of the status.
    fn mark(&self) -> (&'static str, &'static str, &'static str) {
        match self.status.as_str() {
            "ok" if self.is_doubtful => ("fails", "!", "do not use"),
            "ok" if self.warnings.is_empty() => ("holds", "✓", "done"),
            "ok" => ("doubt", "!", "done, with warnings"),
            "ambiguous" => ("doubt", "?", "ambiguous"),
            "error" => ("fails", "✗", "could not be read"),
            _ => ("fails", "–", "no speed"),
        }
    }

    fn name(&self) -> String {
        printable(&self.file)
    }

    /// Why there is no speed, or none to use.
    fn why(&self) -> String {
        let warnings = || if self.is_doubtful { self.warnings.join("; ") } else { String::new() };
        self.reason.clone().unwrap_or_else(warnings)
    }

    fn tone(&self) -> String {
        self.tone_hz.map_or_else(no_number, |tone_hz| format!("{tone_hz:.1}"))
    }

    fn speed_in_words(&self) -> String {
        self.speed.map_or_else(no_number, HeardSpeed::in_words)
    }

    fn rotors_in_words(&self) -> Vec<String> {
        self.rotors.iter().map(|rotor| rotor.in_words()).collect()
    }

    fn used(&self) -> String {
        self.used_s.map_or_else(no_number, |(from_s, to_s)| format!("{from_s:.1}–{to_s:.1}"))
    }
}

fn no_number() -> String {
    "–".to_owned()
}

/// The recordings that a page shows: as many as a browser can hold, in the order in which they come.
#[derive(Clone, Debug, Default)]
pub struct ArchiveRecordings {
    shown: Vec<ArchiveRecording>,
    count: usize,
}

impl ArchiveRecordings {
    /// Adds a recording. What the page does not show is not kept.
    pub fn push(&mut self, recording: ArchiveRecording) {
        if self.count < ROWS_MAX {
            let picture = recording.picture.filter(|_| self.count < PICTURES_MAX);
            self.shown.push(ArchiveRecording { picture, ..recording });
        }
        self.count += 1;
    }

    fn has_status(&self, status: &str) -> usize {
        self.shown.iter().filter(|recording| recording.status == status).count()
    }
}

/// Input of the page.
#[derive(Clone, Copy, Debug)]
pub struct ArchivePage<'a> {
    /// What was heard, as typed.
    pub inputs: &'a [String],
    /// How it was heard, as JSON.
    pub settings: &'a str,
    /// The recordings.
    pub recordings: &'a ArchiveRecordings,
    /// Highest frequency of the pictures.
    pub picture_hz_high: f64,
}

#[derive(Template)]
#[template(path = "archive.html")]
struct Page<'a> {
    policy: String,
    style: String,
    script: &'static str,
    version: &'static str,
    inputs: String,
    counts: String,
    left_out: Option<String>,
    page: &'a ArchivePage<'a>,
}

/// The page. It loads nothing: style, script and pictures are inside. Equal input gives equal bytes.
///
/// # Errors
/// None is known, since the template is compiled in.
pub fn archive_html(page: &ArchivePage<'_>) -> Result<String, PageError> {
    let style = [STYLE, STYLE_OF_ROWS].concat();
    let recordings = page.recordings;
    let counts = [("ok", "done"), ("ambiguous", "ambiguous"), ("no_rotor_tone", "no speed"), ("error", "failed")]
        .map(|(status, words)| format!("{} {words}", recordings.has_status(status)))
        .join(", ");
    let left_out = (recordings.count > recordings.shown.len()).then(|| {
        format!(
            "These are the first {} of {} recordings, by name; recordings.parquet has all.",
            ROWS_MAX, recordings.count
        )
    });
    let page = Page {
        policy: policy(&style, SCRIPT),
        style,
        script: SCRIPT,
        version: VERSION,
        inputs: page.inputs.iter().map(|input| printable(input)).collect::<Vec<_>>().join(", "),
        counts: format!("{}: {counts}", counted(recordings.shown.len(), "recording")),
        left_out,
        page,
    };
    Ok(page.render()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recording(file: &str) -> ArchiveRecording {
        ArchiveRecording {
            file: file.to_owned(),
            status: "ok".to_owned(),
            reason: None,
            tone_hz: Some(120.0),
            speed: Some(HeardSpeed { speed_rev_s: 60.0, std_rev_s: Some(0.01) }),
            rotors: Vec::new(),
            used_s: Some((0.0, 2.0)),
            warnings: Vec::new(),
            is_doubtful: false,
            picture: Some("data:image/png;base64,AAAA".to_owned()),
        }
    }

    fn page_of(recordings: &ArchiveRecordings) -> String {
        let inputs = ["<archive>".to_owned()];
        archive_html(&ArchivePage { inputs: &inputs, settings: "{}", recordings, picture_hz_high: 5000.0 }).unwrap()
    }

    #[test]
    fn names_are_no_markup_and_a_failure_has_its_reason() {
        let mut recordings = ArchiveRecordings::default();
        recordings.push(recording("<script>alert(1)</script>.wav"));
        let reason = Some("the file is empty".to_owned());
        let failed =
            ArchiveRecording { status: "error".to_owned(), reason, speed: None, tone_hz: None, ..recording("b") };
        recordings.push(failed);
        let html = page_of(&recordings);
        assert!(!html.contains("<script>alert") && !html.contains("<archive>"));
        for words in ["60.000 ± 0.020", "the file is empty", "2 recordings: 1 done, 0 ambiguous, 0 no speed, 1 failed"]
        {
            assert!(html.contains(words), "{words}");
        }
        assert_eq!(html, page_of(&recordings));
    }

    #[test]
    fn a_page_is_bounded_and_says_what_is_left_out() {
        let mut recordings = ArchiveRecordings::default();
        (0..ROWS_MAX + 1).for_each(|number| recordings.push(recording(&format!("{number}.wav"))));
        let html = page_of(&recordings);
        assert_eq!(html.matches("<img ").count(), PICTURES_MAX);
        assert_eq!(html.matches("<tr").count(), ROWS_MAX + 1, "rows and their head");
        assert!(html.contains("the first 10000 of 10001 recordings"));
    }
}
