//! From open recordings to records, an identified experiment and its report. The command line and the page in the browser are two edges of
//! the same workflow: they know paths, threads and screens, and this crate does not.
//!
//! ```text
//! said         facts about vehicle and tone → settings of the analysis
//! hearing      an open recording → its record           identified   records of an experiment → tables, results
//! drawing      the same recording → pictures and sound  report       all of it → the report
//! live         what is heard now, in words              copies       two records of one recording
//! ```

mod copies;
mod drawing;
mod hearing;
mod identified;
mod live;
mod report;
mod said;

pub use copies::{same_recording_text, same_sound};
pub use drawing::{Drawing, drawing_of, trial_of};
pub use hearing::{Heard, NotHeard, Requests, Share, Task, facts_of, failed_record, hear, notices_of, progress_of};
pub use identified::{Identified, TipsTooFast, Titles};
pub use live::{LiveLine, live_remark, live_status_in_words, live_words, possible_in_words, possible_speeds_in_words};
pub use report::{Drawn, ReportExtras, ReportFigures, simulators_of};
pub use said::{NoSettings, Said, set_rotors};
