//! From results, figures and sound to one HTML page with everything inside. Pure functions; the caller decides where the page goes.
//!
//! ```text
//! input      input of the page                            report    the page
//! view       the input as words and cells of templates/report.html
//! sound      a recording, small enough for the page       seal      content security policy: the page loads nothing
//! ```
//!
//! `templates/report.css` and `templates/report.js` are copied into the page unchanged.

mod input;
mod report;
mod seal;
mod sound;
mod view;

pub use input::{Report, TrialReport};
pub use report::{PageError, experiment_tables, report_html};
pub use sound::{SOUND_S_MAX, SoundClip, clip_from_source};
