//! Live speeds as lines: JSON for programs, and text for people without a screen.

use crate::failure::Failure;
use crate::listen::summary::LiveSummary;
use hovertone::live::{Listener, LiveSpeed};
use hovertone_report::fixed;
use hovertone_workflow::{LiveLine, live_status_in_words, live_words};

/// Live speeds of one second, of which a line of text tells the last.
const SPEEDS_PER_LINE: usize = 10;
/// Names of the columns, above the first line.
const HEAD: &str = "      time       level  mean speed of the rotors (± covers 95 % of cases; 0 dB is the maximum)\n";

/// One line of JSON.
pub(crate) fn json_line(speed: &LiveSpeed, listener: &Listener) -> Result<String, Failure> {
    Ok(serde_json::to_string(&LiveLine::new(speed, listener)).map_err(Failure::internal)? + "\n")
}

/// Lines of text: the names of the columns, one line for each second, and a summary.
pub(crate) struct PlainLines {
    /// What to do where several speeds are possible.
    advice: String,
    count: usize,
    last_status: String,
    summary: LiveSummary,
}

impl PlainLines {
    pub(crate) fn new(advice: String) -> Self {
        Self { advice, count: 0, last_status: String::new(), summary: LiveSummary::default() }
    }

    /// The line of a speed; `None` for those between. A remark is written where it changes.
    pub(crate) fn line(&mut self, speed: &LiveSpeed, remark: &str) -> Option<String> {
        self.summary.add(speed);
        self.count += 1;
        if !self.count.is_multiple_of(SPEEDS_PER_LINE) {
            return None;
        }
        let status = live_status_in_words(speed.status, remark);
        let is_new = status != self.last_status;
        let in_words =
            live_words(speed).map(|words| format!("{} ± {} rev/s", words.speed_rev_s, words.plus_minus_rev_s));
        let words = match in_words {
            Some(words) => {
                let now = if is_new { status.clone() } else { live_status_in_words(speed.status, "") };
                if now.is_empty() { words } else { format!("{words}, {now}") }
            }
            None if is_new => status.clone(),
            None => live_status_in_words(speed.status, ""),
        };
        self.last_status = status;
        let clipping = if speed.clipped_share > 0.0 { ", clipped" } else { "" };
        let head = if self.count == SPEEDS_PER_LINE { HEAD } else { "" };
        let level_db = fixed(speed.level_db, 1);
        let line = format!("{:8.1} s  {level_db:>7} dB{clipping}  {words}\n", speed.time_s);
        Some(format!("{head}{line}"))
    }

    /// The closing line; `None` if nothing was heard.
    pub(crate) fn closing_line(&self) -> Option<String> {
        self.summary.in_words(&self.advice)
    }
}
