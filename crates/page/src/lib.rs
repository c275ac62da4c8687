//! From results, figures and sound to one HTML page with everything inside. Pure functions; the caller decides where the page goes.
//!
//! ```text
//! input      input of the page                            report    the page
//! filters    filters of the templates
//! view       the results as words and cells of templates      recordings   the same for the recordings
//! warnings   all warnings, linked to their places        head         their lines of one width
//! low_level  the page of the low-level model          archive      the page of an archive
//! sound      a recording, small enough for the page       seal      content security policy: the page loads nothing
//! ```
//!
//! `templates/style` and `templates/script` are copied into the page unchanged.

mod archive;
mod filters;
mod head;
mod input;
mod low_level;
mod recordings;
mod report;
mod seal;
mod sound;
mod view;
mod warnings;

pub use archive::{ArchivePage, ArchiveRecording, ArchiveRecordings, HeardSpeed, archive_html};
pub use input::{Report, SimulatorLines, TrialReport};
pub use low_level::{LowLevelPage, low_level_html};
pub use recordings::names_of;
pub use report::{PageError, experiment_tables, report_html};
pub use sound::{SOUND_S_MAX, SoundClip, clip_from_source};
