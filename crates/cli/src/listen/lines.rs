//! Live speeds as lines: JSON for programs, and text for people without a screen.

use crate::failure::Failure;
use crate::listen::advice::Advice;
use crate::listen::level::level_in_words;
use hovertone::live::{Listener, LiveSpeed, LiveStatus, PossibleSpeed};
use hovertone_workflow::{LiveLine, live_remark, live_status_in_words, live_words, possible_speeds_in_words};

/// Live speeds of one second, of which a line of text tells the last.
pub(super) const SPEEDS_PER_SECOND: usize = 10;
/// Names of the columns, above the first line.
const HEAD: &str = "      time       level  mean speed of the rotors (±: k = 2; level 0 dB: full scale)\n";

/// One line of JSON.
pub(crate) fn json_line(speed: &LiveSpeed, listener: &Listener) -> Result<String, Failure> {
    Ok(serde_json::to_string(&LiveLine::new(speed, listener)).map_err(Failure::internal)? + "\n")
}

/// Lines of text: the names of the columns, and one line for each second.
pub(crate) struct PlainLines {
    advice: Advice,
    count: usize,
    last_status: String,
    /// The possible speeds that were told last: the rotors may be lost since.
    last_possible: Vec<PossibleSpeed>,
}

impl PlainLines {
    pub(crate) fn new(advice: Advice) -> Self {
        Self { advice, count: 0, last_status: String::new(), last_possible: Vec::new() }
    }

    /// The line of a speed; `None` for those between. A remark is written where it changes.
    pub(crate) fn line(&mut self, speed: &LiveSpeed, listener: &Listener) -> Option<String> {
        self.count += 1;
        if !listener.possible().is_empty() {
            self.last_possible = listener.possible().to_vec();
        }
        if !self.count.is_multiple_of(SPEEDS_PER_SECOND) {
            return None;
        }
        let status = live_status_in_words(speed.status, &self.advice.naming(&live_remark(listener)));
        let is_new = status != self.last_status;
        let now = if is_new { status.clone() } else { live_status_in_words(speed.status, "") };
        self.last_status = status;
        // a ± is that of one speed
        let (speeds, separator) = match speed.status {
            LiveStatus::Ambiguous => (possible_speeds_in_words(&self.last_possible, speed.speed_rev_s), ": "),
            _ => (live_words(speed).map(|one| format!("{} ± {} rev/s", one.speed_rev_s, one.plus_minus_rev_s)), ", "),
        };
        let words = [speeds.unwrap_or_default(), now];
        let words =
            words.iter().filter(|words| !words.is_empty()).map(String::as_str).collect::<Vec<_>>().join(separator);
        let clipping = if speed.clipped_share > 0.0 { ", too loud" } else { "" };
        let head = if self.count == SPEEDS_PER_SECOND { HEAD } else { "" };
        let level = level_in_words(speed.level_db, 1);
        let line = format!("{:8.1} s  {level:>10}{clipping}  {words}\n", speed.time_s);
        Some(format!("{head}{line}"))
    }
}
