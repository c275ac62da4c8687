//! Progress of the analysis on stderr, if it is a terminal.

use crate::caller::{OnProgress, on_progress};
use crate::temporary_file::begin_work;
use crate::terminal::width_of;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::io::{self, IsTerminal};
use std::time::Duration;

/// Steps of the bar for each recording.
const STEPS: u64 = 1000;
const TICK: Duration = Duration::from_millis(120);
const BAR: &str = "{msg} {wide_bar:.cyan/dim} {percent:>3} %  {left}";
/// From this finished part on, the time that is left is shown.
const TIMED_FRACTION_MIN: f32 = 0.01;
/// On a narrow terminal the words are cut, and the bar is left out.
const NARROW_BAR: &str = "{wide_msg} {percent:>3} %";
/// Columns that the words, the numbers and a bar of some length need.
const BAR_WIDTH_MIN: usize = 72;

/// The time that is left, which nobody knows before something is done.
fn write_time_left(state: &ProgressState, to: &mut dyn Write) {
    if state.fraction() >= TIMED_FRACTION_MIN {
        // words that cannot be written are left out
        let _ = write!(to, "{:#} left", HumanDuration(state.eta()));
    }
}

/// One bar for all recordings.
pub(crate) struct Progress {
    bar: ProgressBar,
    message: String,
    is_single: bool,
    /// A program that called, and that wants to know.
    listener: Option<OnProgress>,
}

impl Progress {
    /// A bar for the given number of recordings. It is hidden unless it is wanted and stderr is a terminal.
    pub(crate) fn new(verb: &str, recording_count: usize, is_wanted: bool) -> Self {
        begin_work();
        let is_narrow = width_of(&io::stderr()).is_some_and(|width| width < BAR_WIDTH_MIN);
        let is_seen = is_wanted && io::stderr().is_terminal();
        let target = if is_seen { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(STEPS * recording_count as u64), target);
        if let Ok(style) = ProgressStyle::with_template(if is_narrow { NARROW_BAR } else { BAR }) {
            bar.set_style(style.with_key("left", write_time_left));
        }
        let things = if recording_count == 1 { "recording" } else { "recordings" };
        let message = format!("{verb} {recording_count} {things}");
        bar.set_message(message.clone());
        if is_seen {
            bar.enable_steady_tick(TICK);
        }
        Self { bar, message, is_single: recording_count == 1, listener: on_progress() }
    }

    /// The part of the bar for one recording, or for another part of the work.
    pub(crate) fn recording(&self) -> Share<'_> {
        Share { progress: self, steps_done: 0, shown: None }
    }

    /// The next part of the work: the bar begins again, with other words.
    pub(crate) fn next(&self, words: &'static str) -> Share<'_> {
        self.bar.reset();
        self.bar.set_length(STEPS);
        self.bar.set_message(words);
        self.recording()
    }

    /// Replaces the words beside the bar.
    #[cfg(feature = "archive")]
    pub(crate) fn say(&self, words: String) {
        self.bar.set_message(words);
    }

    /// Tells the finished share of all recordings.
    fn tell(&self) {
        if let Some(listener) = &self.listener {
            listener(self.bar.position() as f64 / self.bar.length().unwrap_or(1).max(1) as f64);
        }
    }

    /// Removes the bar before other output.
    pub(crate) fn finish(self) {
        self.bar.finish_and_clear();
    }
}

/// The part of the bar for one recording. It becomes full when the recording is finished.
pub(crate) struct Share<'a> {
    progress: &'a Progress,
    steps_done: u64,
    /// The pass that the message names, and the number of passes.
    shown: Option<(u32, u32)>,
}

impl Share<'_> {
    /// Shows what is done of a recording.
    pub(crate) fn show(&mut self, share: hovertone_workflow::Share) {
        self.name_pass(share.pass, share.pass_count);
        self.set(share.done);
    }

    /// Names the pass over the sound beside the bar of a single recording.
    fn name_pass(&mut self, pass: u32, pass_count: u32) {
        if self.progress.is_single && self.shown != Some((pass, pass_count)) {
            self.shown = Some((pass, pass_count));
            self.progress.bar.set_message(format!("{}, pass {pass} of {pass_count}", self.progress.message));
        }
    }

    /// Sets the finished share of the recording; it never decreases.
    pub(crate) fn set(&mut self, share: f64) {
        let steps = (share.clamp(0.0, 1.0) * STEPS as f64) as u64;
        if steps > self.steps_done {
            self.progress.bar.inc(steps - self.steps_done);
            self.steps_done = steps;
            self.progress.tell();
        }
    }
}

impl Drop for Share<'_> {
    fn drop(&mut self) {
        self.set(1.0);
    }
}
