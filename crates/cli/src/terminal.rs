//! Where words go: data to stdout, everything for people to stderr, colours only to a terminal.

use crate::failure::Failure;
use anstream::AutoStream;
use hovertone_report::{Notice, SpeedRecord, cuts_in_words, wrapped};
use std::io::{self, BufWriter, ErrorKind, IsTerminal, Stderr, Stdout, Write};

const RED: &str = "\x1b[1;31m";
const YELLOW: &str = "\x1b[1;33m";
const CYAN: &str = "\x1b[36m";
const BOLD: &str = "\x1b[1m";
const PLAIN: &str = "";
const RESET: &str = "\x1b[0m";

/// Width that is written for where nobody looks.
const WIDTH_WITHOUT_TERMINAL: usize = 100;

/// The two streams of the process.
pub(crate) struct Terminal {
    out: BufWriter<Stdout>,
    /// Drops colours where they are not wanted: no terminal, `NO_COLOR`, `TERM=dumb`.
    err: AutoStream<Stderr>,
    /// Columns of the terminal that stderr is; absent where it is none, and lines are left whole for programs.
    err_width: Option<usize>,
}

impl Terminal {
    pub(crate) fn new() -> Self {
        Self {
            out: BufWriter::new(io::stdout()),
            err: AutoStream::auto(io::stderr()),
            err_width: width_of(&io::stderr()),
        }
    }

    /// Columns to write for.
    pub(crate) fn width(&self) -> usize {
        width_of(&io::stdout()).unwrap_or(WIDTH_WITHOUT_TERMINAL)
    }

    /// Data.
    pub(crate) fn data(&mut self, text: &str) -> Result<(), Failure> {
        self.out.write_all(text.as_bytes()).map_err(stdout_failure)
    }

    /// Brings the data out before anything is said about it.
    pub(crate) fn flush(&mut self) -> Result<(), Failure> {
        self.out.flush().map_err(stdout_failure)
    }

    /// A line for people. If nobody can be told, there is nobody to tell that.
    pub(crate) fn say(&mut self, line: &str) {
        let _ = writeln!(self.err, "{line}");
    }

    /// Words after a label, wrapped on a terminal to stand under each other. What has lines of its own keeps them.
    fn labelled(&mut self, indent: &str, label: &str, colour: &str, words: &str) {
        let hanging = " ".repeat(indent.len() + label.len() + 1);
        let width = self.err_width.filter(|_| !words.contains('\n'));
        let lines = match width {
            Some(width) => wrapped(words, width.saturating_sub(hanging.len())),
            None => vec![words.to_owned()],
        };
        let text = lines.join(&format!("\n{hanging}"));
        self.say(&format!("{indent}{colour}{label}{RESET} {text}"));
    }

    /// Why the run failed.
    pub(crate) fn failure(&mut self, failure: &Failure) {
        let (Failure::Usage { what, hint, path } | Failure::Failed { what, hint, path }) = failure else { return };
        self.labelled("", "error:", RED, what);
        self.hint(hint, "");
        if let Some(path) = path {
            self.say(&format!("  {}", path.display()));
        }
    }

    /// A file that could not be heard. The reason holds what to do about it.
    fn file_error(&mut self, reason: &str, file: &str) {
        self.labelled("", "error:", RED, reason);
        self.say(&format!("  {file}"));
    }

    /// What weakens a result.
    pub(crate) fn warning(&mut self, notice: &Notice, indent: &str) {
        self.labelled(indent, "warning:", YELLOW, &notice.text);
        self.hint(&notice.hint, indent);
    }

    fn hint(&mut self, hint: &str, indent: &str) {
        if !hint.is_empty() {
            self.labelled(&format!("{indent}  "), "hint:", CYAN, hint);
        }
    }

    /// What is to be said of recordings beside their speeds: what was cut away, warnings, why there is no speed. What holds of all of
    /// several is said once.
    pub(crate) fn notes(&mut self, records: &[&SpeedRecord]) {
        let of_all: Vec<&Notice> = match records {
            [first, _, _, ..] => {
                let is_of_all = |notice: &&Notice| records.iter().all(|record| record.notices.contains(notice));
                first.notices.iter().filter(is_of_all).collect()
            }
            _ => Vec::new(),
        };
        let mut is_first = true;
        for record in records {
            let notices: Vec<&Notice> = record.notices.iter().filter(|notice| !of_all.contains(notice)).collect();
            let reason = record.reason();
            let cuts = record.analysis().and_then(|analysis| cuts_in_words(&analysis.hover.cuts));
            let cuts = cuts.filter(|_| reason.is_none());
            if reason.is_none() && cuts.is_none() && notices.is_empty() {
                continue;
            }
            if std::mem::take(&mut is_first) && self.err_width.is_some() {
                self.say("");
            }
            match (reason, record.has_failed()) {
                (Some(reason), true) => {
                    self.file_error(&reason, &record.file);
                    continue;
                }
                (Some(reason), false) => {
                    self.say(&format!("{BOLD}{}{RESET}", record.file));
                    let label = if record.is_ambiguous() { "ambiguous:" } else { "no rotor tone:" };
                    self.labelled("  ", label, PLAIN, &reason);
                }
                (None, _) => self.say(&format!("{BOLD}{}{RESET}", record.file)),
            }
            if let Some(cuts) = cuts {
                self.labelled("  ", "cut", PLAIN, &cuts);
            }
            for notice in notices {
                self.warning(notice, "  ");
            }
        }
        for notice in of_all {
            let text = format!("{} (in all {} recordings)", notice.text, records.len());
            self.warning(&Notice::new(text, notice.hint.as_str()), "");
        }
    }
}

fn width_of(stream: &impl IsTerminal) -> Option<usize> {
    let size = stream.is_terminal().then(terminal_size::terminal_size).flatten();
    size.map(|(width, _)| usize::from(width.0))
}

fn stdout_failure(error: io::Error) -> Failure {
    match error.kind() {
        ErrorKind::BrokenPipe => Failure::StdoutClosed,
        _ => Failure::Failed {
            what: format!("cannot write to stdout: {error}"),
            hint: "check where the output is redirected to".to_owned(),
            path: None,
        },
    }
}
