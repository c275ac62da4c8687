//! Progress of a long run on stderr.

use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Without a terminal, a line each time that this many steps are done.
const STEPS_PER_LINE: usize = 50;

/// Steps that several threads do.
pub(super) struct Progress {
    name: String,
    count: usize,
    done: AtomicUsize,
    started: Instant,
}

impl Progress {
    pub(super) fn new(name: &str, count: usize) -> Self {
        Self { name: name.to_owned(), count, done: AtomicUsize::new(0), started: Instant::now() }
    }

    /// One more step is done.
    pub(super) fn step(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        let is_terminal = std::io::stderr().is_terminal();
        if !is_terminal && !done.is_multiple_of(STEPS_PER_LINE) && done != self.count {
            return;
        }
        let passed_s = self.started.elapsed().as_secs_f64();
        let left_s = passed_s / done as f64 * (self.count - done) as f64;
        let text = format!("{}: {done} of {}, {passed_s:.0} s, {left_s:.0} s left", self.name, self.count);
        if is_terminal {
            eprint!("\r{text}   ");
            if done == self.count {
                eprintln!();
            }
            // without it, the line stays in the buffer
            let _ = std::io::stderr().flush();
        } else {
            eprintln!("{text}");
        }
    }
}
