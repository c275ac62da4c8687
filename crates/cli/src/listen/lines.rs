//! Live speeds as lines: JSON for programs, and text for people without a screen.

use super::view::{speed_in_words, status_in_words};
use crate::failure::Failure;
use hovertone::live::{Listener, LiveSpeed};
use serde::Serialize;

/// Live speeds of one second, of which a line of text tells the last.
const SPEEDS_PER_LINE: usize = 10;

/// One line of JSON.
#[derive(Serialize)]
struct JsonLine<'a> {
    #[serde(flatten)]
    speed: &'a LiveSpeed,
    rotors_rev_s: &'a [f64],
    possible_rev_s: Vec<f64>,
}

pub(crate) fn json_line(speed: &LiveSpeed, listener: &Listener) -> Result<String, Failure> {
    let possible_rev_s = listener.possible().iter().map(|possible| possible.speed_rev_s).collect();
    let line = JsonLine { speed, rotors_rev_s: listener.rotors_rev_s(), possible_rev_s };
    Ok(serde_json::to_string(&line).map_err(Failure::internal)? + "\n")
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
        let status = status_in_words(speed, reason);
        let is_new = status != self.last_status;
        let words = match speed_in_words(speed) {
            Some(words) if status.is_empty() || !is_new => words,
            Some(words) => format!("{words}, {status}"),
            None if is_new => status.clone(),
            None => "–".to_owned(),
        };
        self.last_status = status;
        let clipping = if speed.clipped_share > 0.0 { ", clipped" } else { "" };
        Some(format!("{:8.1} s  {:5.1} dB{clipping}  {words}\n", speed.time_s, speed.level_db).replace('-', "−"))
    }
}
