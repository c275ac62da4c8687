//! Questions and answers, line by line.

use crate::failure::Failure;
use hovertone_report::folded;
use std::io::{BufRead, Write};

/// A person who answers questions.
pub(super) struct Dialog<R, W> {
    answers: R,
    questions: W,
    /// Columns of the terminal, where the questions stand on one.
    width: Option<usize>,
}

impl<R: BufRead, W: Write> Dialog<R, W> {
    pub(super) fn new(answers: R, questions: W, width: Option<usize>) -> Self {
        Self { answers, questions, width }
    }

    /// A line that needs no answer. A failure to write it is ignored: the question after it would fail too.
    pub(super) fn say(&mut self, line: &str) {
        let _ = writeln!(self.questions, "{}", folded(line, self.width));
    }

    /// Asks until the answer has a meaning. An empty answer is `None`, which `meaning` may take too.
    pub(super) fn ask<T>(
        &mut self,
        question: &str,
        mut meaning: impl FnMut(Option<&str>) -> Result<T, String>,
    ) -> Result<T, Failure> {
        loop {
            let _ = write!(self.questions, "{} ", folded(question, self.width));
            let _ = self.questions.flush();
            let mut line = String::new();
            let count = self.answers.read_line(&mut line);
            if !matches!(count, Ok(1..)) {
                self.say("");
                return Err(Failure::usage(
                    "the input ended before the last answer: nothing was written",
                    "start `hovertone init` again",
                ));
            }
            match meaning(Some(line.trim()).filter(|answer| !answer.is_empty())) {
                Ok(meant) => return Ok(meant),
                Err(fault) => self.say(&format!("  {fault}")),
            }
        }
    }
}
