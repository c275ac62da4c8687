//! Output: data to stdout, all messages for people to stderr, colours only to a terminal.

use crate::failure::Failure;
use anstream::{AutoStream, StripStream};
use hovertone_report::{
    Notice, SpeedRecord, counted, folded, folded_cuts, folded_warnings, own_cuts, own_notices, own_reason, printable,
    weaknesses_in_words, wrapped,
};
use std::io::{self, BufWriter, ErrorKind, IsTerminal, Write};

const RED: &str = "\x1b[1;31m";
const YELLOW: &str = "\x1b[1;33m";
const CYAN: &str = "\x1b[36m";
const BOLD: &str = "\x1b[1m";
const PLAIN: &str = "";
const RESET: &str = "\x1b[0m";
const ERROR: Label = Label { words: "error:", colour: RED };
const TIP: Label = Label { words: "tip:", colour: CYAN };
const WARNING: Label = Label { words: "warning:", colour: YELLOW };

/// Words before a message, and their colour.
#[derive(Clone, Copy)]
struct Label {
    words: &'static str,
    colour: &'static str,
}

/// Width of the output without a terminal.
const WIDTH_WITHOUT_TERMINAL: usize = 100;

/// Where data and messages go: the two output streams of the process, or memory for a program that calls.
pub(crate) struct Terminal<'a> {
    out: Box<dyn Write + 'a>,
    err: Box<dyn Write + 'a>,
    /// Whether this is the output of the process, which may be a terminal.
    is_of_process: bool,
    /// Columns of the terminal behind stderr; absent without a terminal, when lines stay whole for programs.
    err_width: Option<usize>,
}

impl<'a> Terminal<'a> {
    /// The output streams of the process. stderr drops colours where they are unwanted: no terminal, `NO_COLOR`, `TERM=dumb`.
    pub(crate) fn of_process() -> Self {
        Self {
            out: Box::new(BufWriter::new(io::stdout())),
            err: Box::new(AutoStream::auto(io::stderr())),
            is_of_process: true,
            err_width: width_of(&io::stderr()),
        }
    }

    /// Memory, as a file without a terminal would get it.
    pub(crate) fn kept(data: &'a mut Vec<u8>, messages: &'a mut Vec<u8>) -> Self {
        let err = Box::new(StripStream::new(messages));
        Self { out: Box::new(data), err, is_of_process: false, err_width: None }
    }

    /// Columns that tables fold to; `None` where the output is no terminal, and lines stay whole for programs.
    pub(crate) fn fold_width(&self) -> Option<usize> {
        if self.is_of_process { width_of(&io::stdout()) } else { None }
    }

    /// Width of the output in columns.
    pub(crate) fn width(&self) -> usize {
        self.fold_width().unwrap_or(WIDTH_WITHOUT_TERMINAL)
    }

    /// Writes data to stdout.
    pub(crate) fn data(&mut self, text: &str) -> Result<(), Failure> {
        self.out.write_all(text.as_bytes()).map_err(stdout_failure)
    }

    /// Writes text for people to stdout. On a terminal, lines that are too long are wrapped.
    pub(crate) fn text(&mut self, text: &str) -> Result<(), Failure> {
        self.data(&folded(text, self.fold_width()))
    }

    /// Flushes the data before any message about it.
    pub(crate) fn flush(&mut self) -> Result<(), Failure> {
        self.out.flush().map_err(stdout_failure)
    }

    /// Writes a line for people. A failure to write it is ignored, since nobody could read the message about it.
    pub(crate) fn say(&mut self, line: &str) {
        self.line(&folded(line, self.err_width));
    }

    fn line(&mut self, line: &str) {
        let _ = writeln!(self.err, "{line}");
    }

    /// Text after a label, wrapped on a terminal with an indentation. Of text with line breaks the first line is wrapped: the others are a part
    /// of a file, with a mark below its fault.
    fn labelled(&mut self, indent: &str, label: &str, colour: &str, words: &str) {
        let hanging = " ".repeat(indent.len() + label.len() + 1);
        let (first, others) = words.split_once('\n').map_or((words, None), |(first, others)| (first, Some(others)));
        let mut lines = match self.err_width {
            Some(width) => wrapped(first, width.saturating_sub(hanging.len())),
            None => vec![first.to_owned()],
        };
        lines.extend(others.map(str::to_owned));
        let text = lines.join(&format!("\n{hanging}"));
        self.line(&format!("{indent}{colour}{label}{RESET} {text}"));
    }

    /// A message with its hint: on a terminal the hint stands below, elsewhere all of it is one line for programs.
    fn with_hint(&mut self, indent: &str, label: Label, words: &str, hint: &str) {
        if hint.is_empty() {
            self.labelled(indent, label.words, label.colour, words);
        } else if self.err_width.is_some() || words.contains('\n') {
            self.labelled(indent, label.words, label.colour, words);
            self.labelled(&format!("{indent}  "), "hint:", CYAN, hint);
        } else {
            self.labelled(indent, label.words, label.colour, &format!("{words} (hint: {hint})"));
        }
    }

    /// Writes the reason of a failure, with the name of the file first.
    pub(crate) fn failure(&mut self, failure: &Failure) {
        let (Failure::Usage { what, hint, path } | Failure::Failed { what, hint, path }) = failure else { return };
        let place = path.as_ref().map_or(String::new(), |path| format!("{}: ", printable(&path.display().to_string())));
        // a part of a file may be shown below its error, on lines of its own
        let what: Vec<String> = what.split('\n').map(printable).collect();
        self.with_hint("", ERROR, &format!("{place}{}", what.join("\n")), hint);
    }

    /// A file that could not be analysed. The reason contains the advice.
    fn file_error(&mut self, reason: &str, file: &str) {
        self.with_hint("", ERROR, &format!("{}: {reason}", printable(file)), "");
    }

    /// An error beside others, with its hint.
    pub(crate) fn error(&mut self, notice: &Notice) {
        self.with_hint("", ERROR, &printable(&notice.text), &notice.hint);
    }

    /// A line above messages.
    pub(crate) fn heading(&mut self, words: &str) {
        self.line(&format!("{BOLD}{}{RESET}", folded(words, self.err_width)));
    }

    /// A warning with its hint.
    pub(crate) fn warning(&mut self, notice: &Notice, indent: &str) {
        self.with_hint(indent, WARNING, &printable(&notice.text), &notice.hint);
    }

    /// What would make an answer better, with its hint.
    pub(crate) fn tip(&mut self, notice: &Notice) {
        self.with_hint("", TIP, &printable(&notice.text), &notice.hint);
    }

    /// The number of warnings, where there is one. They stand above the answer that they weaken.
    pub(crate) fn warning_count(&mut self, count: usize) {
        self.warning_count_of(count, None);
    }

    /// The same for one of several answers, by its name.
    pub(crate) fn warning_count_of(&mut self, count: usize, of: Option<&str>) {
        if count > 0 {
            let about = of.map_or(String::new(), |of| format!(" about {}", printable(of)));
            self.heading(&(counted(count, "warning") + &about));
        }
    }

    /// The number of recordings without a speed and of warnings, and all messages about them, above their speeds.
    pub(crate) fn counted_notes(&mut self, records: &[&SpeedRecord]) {
        self.counted_notes_and(&[], records);
    }

    /// The same, with warnings about something else before them.
    pub(crate) fn counted_notes_and(&mut self, others: &[Notice], records: &[&SpeedRecord]) {
        if let Some(words) = weaknesses_in_words(records, others.len()) {
            self.heading(&words);
        }
        others.iter().for_each(|notice| self.warning(notice, ""));
        self.notes(records);
    }

    /// Messages about recordings beside their speeds: cuts, warnings, reasons for missing speeds. A message that holds for several
    /// recordings is written once.
    pub(crate) fn notes(&mut self, records: &[&SpeedRecord]) {
        let (folded, folded_cuts) = (folded_warnings(records), folded_cuts(records));
        let mut is_first = true;
        for record in records {
            let notices = own_notices(record, &folded);
            let reason = own_reason(record, &folded);
            let cuts = own_cuts(record, &folded_cuts);
            if reason.is_none() && cuts.is_none() && notices.is_empty() {
                continue;
            }
            if std::mem::take(&mut is_first) && self.err_width.is_some() {
                self.say("");
            }
            match reason {
                Some(reason) if record.has_failed() => {
                    self.file_error(&reason, &record.file);
                    continue;
                }
                Some(reason) => {
                    self.heading(&printable(&record.file));
                    self.labelled("  ", &format!("{}:", record.missing_speed_label()), PLAIN, &reason);
                }
                None => self.heading(&printable(&record.file)),
            }
            if let Some(cuts) = cuts {
                self.labelled("  ", "cut", PLAIN, &cuts);
            }
            for notice in notices {
                self.warning(notice, "  ");
            }
        }
        for kind in &folded_cuts {
            self.labelled("", "cut:", PLAIN, &printable(&kind.notice.text));
        }
        for kind in &folded {
            match kind.notice.text.split_once(": ").filter(|_| kind.is_missing_speed) {
                Some((label, reason)) => self.labelled("", &format!("{label}:"), PLAIN, &printable(reason)),
                None => self.warning(&kind.notice, ""),
            }
        }
    }
}

/// Columns of a terminal; `None` where the stream is none.
pub(crate) fn width_of(stream: &impl IsTerminal) -> Option<usize> {
    let size = stream.is_terminal().then(terminal_size::terminal_size).flatten();
    size.map(|(width, _)| usize::from(width.0))
}

fn stdout_failure(error: io::Error) -> Failure {
    match error.kind() {
        ErrorKind::BrokenPipe => Failure::StdoutClosed,
        _ => Failure::Failed {
            what: format!("cannot write to stdout: {error}"),
            hint: "check the file or program that gets the output (after > or |)".to_owned(),
            path: None,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The message is wrapped at words; the lines of the file below it keep their columns.
    #[test]
    fn a_message_with_a_part_of_a_file_is_wrapped_and_the_part_is_not() {
        let mut messages = Vec::new();
        let part = "3 | name = \"a long text without an end\n  |        ^^^^^^^^^^^^^^^^^^^^^^^^^^^";
        let mut terminal = Terminal {
            out: Box::new(Vec::new()),
            err: Box::new(StripStream::new(&mut messages)),
            is_of_process: false,
            err_width: Some(40),
        };
        let what = format!("a.toml: the experiment file has a fault: unclosed table\n{part}");
        terminal.failure(&Failure::usage(what, "] is needed here"));
        drop(terminal);
        let said = String::from_utf8(messages).unwrap();
        let (message, below) = said.split_once("3 | ").unwrap();
        assert!(message.lines().all(|line| line.chars().count() <= 40) && message.contains("unclosed"), "{said}");
        assert!(below.contains("without an end\n"), "{said}");
    }
}
