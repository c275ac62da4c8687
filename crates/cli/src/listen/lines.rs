//! Live speeds as lines: JSON for programs, and text for people without a screen.

use crate::failure::Failure;
use hovertone::live::{Listener, LiveSpeed};
use hovertone_workflow::{LiveLine, live_status_in_words, live_words};

/// Live speeds of one second, of which a line of text tells the last.
const SPEEDS_PER_LINE: usize = 10;

/// One line of JSON.
pub(crate) fn json_line(speed: &LiveSpeed, listener: &Listener) -> Result<String, Failure> {
    Ok(serde_json::to_string(&LiveLine::new(speed, listener)).map_err(Failure::internal)? + "\n")
}

/// Lines of text, one for each second.
#[derive(Default)]
pub(crate) struct PlainLines {
    count: usize,
    last_status: String,
}

impl PlainLines {
    /// The line of a speed; `None` for those between. A status is written where it changes.
    pub(crate) fn line(&mut self, speed: &LiveSpeed, reason: &str) -> Option<String> {
        self.count += 1;
        if !self.count.is_multiple_of(SPEEDS_PER_LINE) {
            return None;
        }
        let status = live_status_in_words(speed.status, reason);
        let is_new = status != self.last_status;
        let in_words = live_words(speed);
        let in_words =
            in_words.map(|words| format!("{} ± {} rev/s (k = 2)", words.speed_rev_s, words.plus_minus_rev_s));
        let words = match in_words {
            Some(words) if status.is_empty() || !is_new => words,
            Some(words) => format!("{words}, {status}"),
            None if is_new => status.clone(),
            None => "no speed".to_owned(),
        };
        self.last_status = status;
        let clipping = if speed.clipped_share > 0.0 { ", clipped" } else { "" };
        Some(format!("{:8.1} s  {:5.1} dB{clipping}  {words}\n", speed.time_s, speed.level_db).replace('-', "−"))
    }
}
