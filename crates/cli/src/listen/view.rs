//! What the screen shows: the speed now, the last minute, and what the last review found.

use crate::listen::advice::Advice;
use hovertone::live::{Listener, LiveSpeed};
use hovertone_workflow::{live_remark, possible_in_words};
use std::collections::VecDeque;

/// Length of the strip chart, s.
pub(crate) const STRIP_S: f64 = 60.0;

/// The state of the screen.
pub(crate) struct View {
    /// What is heard, in words.
    pub(crate) source: String,
    /// The newest speed; of a frozen screen the one at which it froze.
    pub(crate) now: Option<LiveSpeed>,
    /// Speed over time in the last minute.
    pub(crate) strip: VecDeque<(f64, f64)>,
    /// Speeds of the separated rotors, fastest first.
    pub(crate) rotors_rev_s: Vec<f64>,
    /// The possible speeds in words, most probable first; empty where one is decided.
    pub(crate) choices: Vec<String>,
    /// Why no rotor is heard, or why the speed is doubtful.
    pub(crate) remark: String,
    pub(crate) is_frozen: bool,
    pub(crate) advice: Advice,
}

impl View {
    pub(crate) fn new(source: String, advice: Advice) -> Self {
        Self {
            source,
            now: None,
            strip: VecDeque::new(),
            rotors_rev_s: Vec::new(),
            choices: Vec::new(),
            remark: String::new(),
            is_frozen: false,
            advice,
        }
    }

    /// Takes in a speed. A frozen screen keeps its own.
    pub(crate) fn take(&mut self, speed: LiveSpeed) {
        if self.is_frozen {
            return;
        }
        self.now = Some(speed);
        self.strip.extend(speed.speed_rev_s.map(|speed_rev_s| (speed.time_s, speed_rev_s)));
        while self.strip.front().is_some_and(|&(time_s, _)| time_s < speed.time_s - STRIP_S) {
            self.strip.pop_front();
        }
    }

    /// Takes in what the last review found.
    pub(crate) fn take_review(&mut self, listener: &Listener) {
        if self.is_frozen {
            return;
        }
        self.rotors_rev_s = listener.rotors_rev_s().to_vec();
        self.choices = listener.possible().iter().map(possible_in_words).collect();
        self.remark = self.advice.naming(&live_remark(listener));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone::live::LiveStatus;

    pub(crate) fn speed(time_s: f64, speed_rev_s: Option<f64>) -> LiveSpeed {
        LiveSpeed {
            time_s,
            status: if speed_rev_s.is_some() { LiveStatus::Ok } else { LiveStatus::NoRotorTone },
            speed_rev_s,
            std_uncertainty_rev_s: speed_rev_s.map(|_| 0.07),
            level_db: -18.0,
            clipped_share: 0.0,
        }
    }

    #[test]
    fn the_strip_holds_a_minute_and_a_frozen_screen_stays() {
        let mut view = View::new("x.wav".to_owned(), Advice::default());
        (0..900).for_each(|n| view.take(speed(0.1 * f64::from(n), (n % 2 == 0).then_some(100.0))));
        assert!(view.strip.len() == 300 || view.strip.len() == 301, "{}", view.strip.len());
        view.is_frozen = true;
        view.take(speed(1000.0, None));
        assert!(view.now.is_some_and(|now| now.time_s < 90.0) && !view.strip.is_empty());
    }
}
