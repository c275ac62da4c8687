//! Plays a recording no faster than wanted.

use std::time::{Duration, Instant};

/// The beginning of the play and its speed.
pub(crate) struct Pace {
    begun: Instant,
    /// Seconds of sound in a second.
    speed: f64,
}

impl Pace {
    pub(crate) fn new(speed: f64) -> Self {
        Self { begun: Instant::now(), speed }
    }

    /// Time until the sound up to this time has been played.
    pub(crate) fn time_left(&self, heard_s: f64) -> Duration {
        let due = Duration::try_from_secs_f64(heard_s / self.speed).unwrap_or(Duration::ZERO);
        due.saturating_sub(self.begun.elapsed())
    }
}
