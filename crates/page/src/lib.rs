//! Results, figures and sound → one HTML page that holds everything it needs. Pure: where the page goes is the caller's business.
//!
//! ```text
//! report     what the page is made of            view      the same as the words and cells of templates/report.html
//! sound      a recording, small enough to listen to         seal      what the page may load: nothing
//! ```
//!
//! `templates/report.css` and `templates/report.js` are put into the page as they stand.

mod report;
mod seal;
mod sound;
mod view;

pub use report::{PageError, Report, TrialReport, experiment_tables, report_html};
pub use sound::{SOUND_S_MAX, SoundClip, clip_from_source};
