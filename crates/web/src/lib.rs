//! hovertone in the browser: what a worker of the page calls. Bindings that translate; all arithmetic is in the crates that the command
//! uses too.
//!
//! ```text
//! slices       a file of the page, read slice by slice      answer      a record as JSON for the page
//! coded        packets for the decoder of the browser
//! heard_files  the files and their records                 campaign    an experiment and its results as JSON
//! desk         all that the page can ask
//! picture      a spectrogram as levels                     experiment  experiment files ⇄ JSON, vehicles
//! ear          the microphone                          said        what the page says of the vehicle
//! example      simulated hovers to try
//! ```

mod answer;
mod campaign;
mod coded;
mod desk;
mod ear;
mod example;
mod experiment;
mod heard_files;
mod picture;
mod said;
mod slices;

pub use coded::{Coded, Packet};
pub use desk::Desk;
pub use ear::Ear;
pub use example::{example_plan, example_recording};
pub use experiment::{experiment_entries, experiment_text, level_colours, simulator_lines, vehicles, version};
pub use picture::Levels;
