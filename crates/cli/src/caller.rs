//! Who runs a command: the process, whose words are its arguments, or a program that calls, with words of its own.

use std::cell::RefCell;
use std::ffi::OsString;
use std::sync::Arc;

/// Told the finished share of a call, from 0 to 1, from any thread.
pub type OnProgress = Arc<dyn Fn(f64) + Send + Sync>;

/// A program that calls a command.
#[derive(Clone, Default)]
pub(crate) struct Caller {
    /// The command line that means the same.
    pub(crate) words: Vec<OsString>,
    pub(crate) on_progress: Option<OnProgress>,
}

thread_local! {
    static CALLER: RefCell<Option<Caller>> = const { RefCell::new(None) };
}

impl Caller {
    /// Does the work of a call.
    pub(crate) fn during<T>(self, work: impl FnOnce() -> T) -> T {
        /// Ends the call, also where the work panics.
        struct Ended(Option<Caller>);
        impl Drop for Ended {
            fn drop(&mut self) {
                CALLER.set(self.0.take());
            }
        }
        let _ended = Ended(CALLER.replace(Some(self)));
        work()
    }
}

/// The command line as typed, or as a program would have typed it.
pub(crate) fn typed_words() -> Vec<OsString> {
    CALLER
        .with_borrow(|caller| caller.as_ref().map(|caller| caller.words.clone()))
        .unwrap_or_else(|| std::env::args_os().collect())
}

/// The command of the command line, such as "weigh"; empty without one.
pub(crate) fn command_word() -> String {
    typed_words().get(1).and_then(|word| word.to_str().map(str::to_owned)).unwrap_or_default()
}

/// Who wants to be told the progress of the call on this thread.
pub(crate) fn on_progress() -> Option<OnProgress> {
    CALLER.with_borrow(|caller| caller.as_ref()?.on_progress.clone())
}
